// SPDX-License-Identifier: BSD-3-Clause
// Boxes around a hierarchy's leaves: axis-aligned in the cloud's own frame, for queries that carry the other cloud
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
  static constexpr std::uint32_t kLeaf = 0x80000000u;

  float low[3][kNodeChildren];
  float high[3][kNodeChildren];
  std::uint32_t child[kNodeChildren]; ///< a node of the same voxel; or kLeaf + its leaf, above the voxels + its voxel
  std::uint32_t count = 0;            ///< children in use, 1..8

  bool isLeaf(std::size_t lane) const noexcept { return (child[lane] & kLeaf) != 0; }
  /// Node of the hierarchy times kNodeChildren, plus lane; above the voxels the voxel.
  std::uint32_t leaf(std::size_t lane) const noexcept { return child[lane] & ~kLeaf; }
};

/// How the model moves along a path, by itself: what its middle travels along each of its own axes, and how far it
/// turns in all.
struct Travel {
  Point3 way = {0, 0, 0};
  double turned = 0.0;
};

/// The hierarchy's leaves in boxes that are longer along the way that the cloud travels: what passes a long body beside
/// it is tested against metres of its side at once. A box is divided where it is widest, and its length along the way
/// counts for less, by `stretch`: as often as the cloud travels farther along that axis than its points move along
/// others, kMostStretch at most.
class BoxTree {
public:
  BoxTree(const SphereHierarchy::Storage& storage, const Travel& travel);

  const SphereHierarchy::Storage& storage;
  const Point3 origin;      ///< of the boxes, in the cloud's frame
  float low[3], high[3];    ///< around all points
  float stretch[3];         ///< at least 1: a box may be so many times as long along this axis
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

  static constexpr double kMostStretch = 32; ///< more gained nothing: boxes are as long as their voxels by then

  void fitTop();
  void setStretch(const Travel& travel);
  std::vector<BoxNode> fitVoxel(const Voxel& voxel, std::uint32_t index) const;

  std::vector<BoxNode> top_;
  std::unique_ptr<Entry[]> voxels_;
};

} // namespace pcl_bsh
