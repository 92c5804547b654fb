// SPDX-License-Identifier: BSD-3-Clause
// Compares two nodes far from each other for their size, where spheres prune too little. The sphere of an arc, or of a
// patch of a sheet, reaches towards the other node by half of its length. Its points reach there only by the order of
// that length's square.
#pragma once

#include <pcl_bsh/geometry/given_sphere.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/traversal/space.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pcl_bsh {

/// Nodes are far from each other when the distance of their centres exceeds this many times the sum of their radii.
inline constexpr float kFarNodes = 8.0f;

/// Whether a node can be far from one of this radius and still be within reach.
inline bool mayBeFar(float reach, float radius)
{
  return reach > (kFarNodes - 1.0f) * radius;
}

/// Error of a support, relative to it and to the node's radius. The direction errs by 4 v of its length, and by 6 v
/// when it is turned into the cloud's frame. Its parts along both normals err by 3 v each, the rest by 11 v, and the
/// sum of their products by 3 v: less than 32 v together.
inline constexpr double kSupportError = 32 * kDoubleUnit;

/// Error of the vector between two centres, relative to the sum of all terms: a product, the sum of three, the
/// translation and the difference, 5 roundings.
inline constexpr double kCenterDifferenceError = kFewDoubleRoundings;

/// The support of a node: an upper bound of how far its points are from its sphere's centre along a direction. Two
/// slabs bound the directions along which points vary least; the sphere bounds the rest.
class NodeSupport {
public:
  /// @param slabs, cross_slabs of the node
  NodeSupport(const LocalFrame& frame, const Node& node, std::uint32_t child, const Slabs& slabs,
              const Slabs& cross_slabs)
  : sphere_(storedSphere(frame, node, child)),
    radius_(static_cast<double>(node.r[child]) * frame.unit)
  {
    const auto take = [&](const Slabs& from, Eigen::Vector3d& normal, double& h) {
      normal = {from.x[child], from.y[child], from.z[child]};
      h = static_cast<double>(from.h[child]) * frame.unit;
    };
    take(slabs, normal_, h_);
    take(cross_slabs, cross_, cross_h_);
  }

  /// A point's support is 0 along each direction.
  explicit NodeSupport(const Point3& point)
  : sphere_{point, 0.0},
    radius_(0.0),
    normal_(Eigen::Vector3d::Zero()),
    cross_(Eigen::Vector3d::Zero()),
    h_(0.0),
    cross_h_(0.0)
  {
  }

  /// Centre of the sphere, in the cloud's own frame.
  const Point3& center() const { return sphere_.center; }

  /// Returns the support in the clouds' unit. A direction is the sum of its parts along both normals, whichever these
  /// are, and of a rest. Slabs bound points along the normals, the sphere along the rest.
  /// @param direction in the cloud's own frame, of length 1 within 1e-6
  double along(const Eigen::Vector3d& direction) const
  {
    const double on_normal = direction.dot(normal_), on_cross = direction.dot(cross_);
    const double rest = (direction - on_normal * normal_ - on_cross * cross_).norm();
    const double support = std::abs(on_normal) * h_ + std::abs(on_cross) * cross_h_ + rest * radius_;
    return support * (1.0 + kSupportError) + kSupportError * radius_ + (sphere_.radius - radius_);
  }

private:
  GivenSphere sphere_;
  double radius_;
  Eigen::Vector3d normal_, cross_;
  double h_, cross_h_;
};

/// @param voxel built, its points without radii
/// @param work counts slabs that are fitted
inline NodeSupport nodeSupport(Voxel& voxel, const PointsView& view, const Node& node, std::uint32_t child,
                               BuildWork& work)
{
  const auto index = &node - voxel.nodes.data();
  return {voxel.frame, node, child, voxel.slabs.of(voxel, view, work)[index],
          voxel.cross_slabs.of(voxel, view, work)[index]};
}

/// The vector from the centre of a to that of b, both posed, and a bound of its rounding error.
struct CenterDifference {
  CenterDifference(const Eigen::Isometry3d& pose_a, const Point3& a, const Eigen::Isometry3d& pose_b, const Point3& b)
  {
    const Eigen::Map<const Eigen::Vector3d> in_a(a.data()), in_b(b.data());
    vector = pose_b * in_b - pose_a * in_a;
    error = kCenterDifferenceError *
            (in_a.lpNorm<1>() + in_b.lpNorm<1>() + pose_a.translation().lpNorm<1>() + pose_b.translation().lpNorm<1>());
  }

  Eigen::Vector3d vector;
  double error;
};

/// Returns true where supports prove that no point of one node is within the clearance of a point of the other. The
/// centres are compared in exact arithmetic.
///
/// Let D be the vector from centre to centre, and u a vector of length 1. Then |D + q - p| >= dot(u, D + q - p) >=
/// dot(u, D) - support(u) - support(-u) for all p, q about their centres. Doubles compute d, which is off D by e at
/// most, and u = d / |d|. So dot(u, D) = (|d|^2 + |D|^2 - |d - D|^2) / (2 |d|) >= |D| - e^2 / (2 |d|). The code
/// subtracts four times that last term, for roundings. Where doubles find the centres too near to prove that, it
/// returns false without an exact comparison.
/// @param exact_decisions counts the comparison
inline bool areFarNodesApart(const ExactDistance& distance, const Eigen::Isometry3d& pose_a, const NodeSupport& a,
                             const Eigen::Isometry3d& pose_b, const NodeSupport& b, double clearance,
                             std::uint64_t& exact_decisions)
{
  const CenterDifference difference(pose_a, a.center(), pose_b, b.center());
  const double length = difference.vector.norm(), error = difference.error;
  if (!(length > 0x1p-400 && length < 0x1p400)) return false; // squares are in range
  const Eigen::Vector3d direction = difference.vector / length;
  const double off = error / length * error;
  const double support_a = a.along(pose_a.linear().transpose() * direction) + off;
  const double support_b = b.along(pose_b.linear().transpose() * direction) + off;
  if (length + error < support_a + support_b + clearance) return false;
  ++exact_decisions;
  return areApart(distance, {a.center(), support_a}, {b.center(), support_b}, clearance);
}

} // namespace pcl_bsh
