// SPDX-License-Identifier: BSD-3-Clause
// Boxes around a cloud's points: axis-aligned in the cloud's own frame, for queries that carry the other cloud there.
// Made voxel by voxel, as a walk enters them.
#pragma once

#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/trajectory/boxes/boxed_part.h>

#include <array>
#include <memory>
#include <mutex>
#include <vector>

namespace pcl_bsh {

/// The boxes of a node's children, in the clouds' unit and relative to the tree's origin, rounded outward. They hold
/// points with their radii, and triangles.
struct alignas(32) BoxNode {
  static constexpr std::uint32_t kLeaf = 0x80000000u;

  float low[3][kNodeChildren];
  float high[3][kNodeChildren];
  /// A node of the same voxel, or kLeaf + the number of a leaf. Above the voxels a node there, or kLeaf + a voxel.
  std::uint32_t child[kNodeChildren];
  std::uint32_t count = 0; ///< children in use, 1..8

  bool isLeaf(std::size_t lane) const noexcept { return (child[lane] & kLeaf) != 0; }
  /// A leaf of the voxel, counted from 0; above the voxels the voxel.
  std::uint32_t leaf(std::size_t lane) const noexcept { return child[lane] & ~kLeaf; }
};

/// Points of a voxel that share a box, sixteen at most. Readable for whole vectors. In a cloud of balls or triangles a
/// leaf has one ball, or one part of a triangle, without coordinates.
struct BoxLeaf {
  const float *at_x, *at_y, *at_z; ///< as the voxel stores them
  const std::uint32_t* records;
  const float* lengths; ///< their own uncertainties; null where they have none
  std::uint32_t count;
  bool is_part = false; ///< whether other leaves may hold parts of its record

  const float* x() const { return at_x; }
  const float* y() const { return at_y; }
  const float* z() const { return at_z; }
  std::uint32_t record(std::uint32_t i) const { return records[i]; }
};

/// The boxes of a voxel, and its points in the order of their leaves. Points that coincide are one.
class BoxedVoxel {
public:
  BoxedVoxel() = default;

  /// Makes boxes of points.
  /// @param offset from the tree's origin to the voxel's. @param stretch see BoxTree. @param uncertainties of the
  ///   cloud's records; may be null
  BoxedVoxel(const Voxel& voxel, const Point3& offset, const float* stretch, const float* uncertainties);

  /// Makes boxes of balls, or of triangles. Triangles that fill little of their boxes are divided into parts.
  BoxedVoxel(const Voxel& voxel, const PointsView& view, const Point3& origin, const float* stretch,
             const Division& division);

  const std::vector<BoxNode>& boxes() const { return boxes_; }

  BoxLeaf leaf(std::uint32_t number) const
  {
    const std::uint32_t begin = begins_[number];
    if (coordinates_.empty()) return {nullptr, nullptr, nullptr, records_.data() + begin, nullptr, 1, is_divided_};
    const float* x = coordinates_.data() + begin;
    return {x,
            x + records_.size(),
            x + 2 * records_.size(),
            records_.data() + begin,
            lengths_.empty() ? nullptr : lengths_.data() + begin,
            begins_[number + 1] - begin,
            false};
  }

private:
  std::vector<BoxNode> boxes_;
  std::vector<float> coordinates_;     // x, y, z of each point
  std::vector<std::uint32_t> records_; // per point
  std::vector<float> lengths_;         // per point, of uncertain ones; else empty
  std::vector<std::uint32_t> begins_;  // per leaf: its first point; then their number
  bool is_divided_ = false;            // whether triangles are in parts
};

/// How the model moves along a path: how far its middle travels along each of its own axes, and how far it turns in
/// all.
struct Travel {
  Point3 way = {0, 0, 0};
  double turned = 0.0;
};

/// Whether records are points alone: no balls, no triangles.
inline bool arePoints(const PointsView& view)
{
  return !view.radii && !view.triangles;
}

/// A cloud's points in boxes that are longer along the way that the cloud travels. A point that passes beside a long
/// body is tested against metres of its side at once. Beside a rough or noisy side it is tested only against points
/// that stand out. A box is divided where it is widest, and its length along an axis counts divided by `stretch`. The
/// stretch is the ratio of the way along that axis to the way of points along the others, kMostStretch at most.
class BoxTree {
public:
  BoxTree(const SphereHierarchy::Storage& storage, const Travel& travel, const Division& division = {});

  const SphereHierarchy::Storage& storage;
  const Point3 origin;      ///< of the boxes, in the cloud's frame
  float low[3], high[3];    ///< around all points, with their radii
  float stretch[3];         ///< at least 1: a box may be so many times as long along this axis
  double radius = 0.0;      ///< no point, with its radius, is farther from the origin than this
  double voxel_slack = 0.0; ///< of all voxels: how far a stored point may be from the given one
  double voxel_reach = 0.0; ///< of all voxels: the largest coordinate of a stored point, in the clouds' unit

  const std::vector<BoxNode>& top() const { return top_; }

  /// The boxes of a voxel's nodes; makes them, and the voxel, on the first call; safe in several threads.
  const BoxedVoxel& voxel(std::uint32_t index, Work& work) const;

  /// A leaf of a voxel whose boxes were made.
  BoxLeaf leaf(std::uint32_t voxel, std::uint32_t number) const { return voxels_[voxel].boxed.leaf(number); }

  /// Returns the unit of the coordinates that a voxel stores.
  double unit(std::uint32_t voxel) const { return storage.voxels[voxel].frame.unit; }

  /// Returns the vector from the tree's origin to the voxel's.
  Point3 offset(std::uint32_t index) const;

  /// Returns offset(), rounded to floats.
  std::array<float, 3> shift(std::uint32_t index) const
  {
    const Point3 at = offset(index);
    return {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
  }

private:
  struct Entry {
    std::once_flag once;
    BoxedVoxel boxed;
  };

  static constexpr double kMostStretch = 32; ///< more gained nothing: boxes are as long as their voxels by then

  void fitTop();
  void placeVoxel(BoxNode& node, std::uint32_t lane, std::uint32_t voxel) const;
  void setStretch(const Travel& travel);

  std::vector<BoxNode> top_;
  Division division_;
  std::unique_ptr<Entry[]> voxels_;
};

} // namespace pcl_bsh
