// SPDX-License-Identifier: BSD-3-Clause
// Boxes beside a hierarchy's spheres: axis-aligned in the cloud's own frame, for queries that carry the other cloud
// there. Made voxel by voxel, as a walk enters them.
#pragma once

#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/result.h>

#include <memory>
#include <mutex>
#include <vector>

namespace pcl_bsh {

/// The boxes of a node's children, in the clouds' unit and relative to the tree's origin, rounded outward. Points only,
/// without their radii.
struct alignas(32) BoxNode {
  float low[3][kNodeChildren];
  float high[3][kNodeChildren];
};

class BoxTree {
public:
  explicit BoxTree(const SphereHierarchy::Storage& storage);

  const SphereHierarchy::Storage& storage;
  const Point3 origin;      ///< of the boxes, in the cloud's frame
  float low[3], high[3];    ///< around all points
  double radius = 0.0;      ///< no point is farther from the origin than this
  double voxel_slack = 0.0; ///< of all voxels: how far a stored point may be from the given one
  double voxel_reach = 0.0; ///< of all voxels: the largest coordinate of a stored point, in the clouds' unit

  const std::vector<BoxNode>& top() const { return top_; }

  /// The boxes of a voxel's nodes; makes them, and the voxel, on the first call; safe in several threads.
  const std::vector<BoxNode>& voxel(std::uint32_t index, Work& work) const;

  /// From the tree's origin to the voxel's.
  Point3 offset(std::uint32_t index) const;

private:
  struct Entry {
    std::once_flag once;
    std::vector<BoxNode> boxes;
  };

  void fitTop();
  void fitVoxel(const Voxel& voxel, std::uint32_t index, std::vector<BoxNode>& boxes) const;

  std::vector<BoxNode> top_;
  std::unique_ptr<Entry[]> voxels_;
};

} // namespace pcl_bsh
