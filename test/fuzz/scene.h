// SPDX-License-Identifier: BSD-3-Clause
// Clouds, poses and clearances from bytes: of every layout, and with all the numbers that make trouble.
#pragma once

#include "bytes.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/question/uncertainty.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::fuzz {

/// Up to 24 points, repeated along a line: enough for several leaves and a place too many points share.
class FuzzedCloud {
public:
  /// @param most_repeats keeps one of two clouds small enough for brute force
  FuzzedCloud(Bytes& bytes, unsigned most_repeats);

  /// None when the cloud is refused; refusing a good one or accepting a bad one is a Finding.
  std::optional<SphereHierarchy> hierarchy() const;

  /// The hierarchy of points that may be elsewhere; nothing where they are refused.
  std::optional<SphereHierarchy> hierarchy(const Uncertainty& uncertainty) const;

private:
  PointsView view() const;
  bool sensible() const;

  PointsView layout_;
  std::vector<std::uint8_t> records_;
  std::vector<std::int32_t> indices_;
  std::vector<float> radii_;
  bool subset_ = false;
  HierarchyOptions options_;
};

/// Up to 24 triangles of up to 16 vertices, or tetrahedra, which close.
class FuzzedMesh {
public:
  explicit FuzzedMesh(Bytes& bytes);

  TrianglesView triangles() const;
  /// None when the mesh is refused; refusing a good one or accepting a bad one is a Finding.
  std::optional<SphereHierarchy> hierarchy() const;

private:
  std::vector<double> doubles_;
  std::vector<float> floats_;
  std::vector<std::uint32_t> corners_;
  HierarchyOptions options_;
  bool of_floats_ = false;
};

/// Mostly rigid, sometimes nearly, sometimes not at all.
Eigen::Isometry3d anyPose(Bytes& bytes);

/// Uncertainties of each point, and of a pose: near 0, about as long as the clearance, or any.
Uncertainty anyUncertainty(Bytes& bytes, double clearance);

/// Half of them the distance of a pair of points, give or take the last bit.
double anyClearance(Bytes& bytes, const Placed& a, const Placed& b);

} // namespace pcl_bsh::fuzz
