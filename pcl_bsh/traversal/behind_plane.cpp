// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/traversal/behind_plane.h>

#include <pcl_bsh/hierarchy/triangles_view.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

/// Of what a child spans, counted over all voxels.
struct Range {
  std::uint32_t begin, end;
};

Range pointsBelow(const SphereHierarchy::Storage& cloud, const NodeChild& child)
{
  const std::uint32_t begin = child.node.begin[child.lane], end = child.node.begin[child.lane + 1];
  if (child.space != kAboveVoxels) {
    const std::uint32_t from = cloud.voxels[child.space].begin;
    return {from + begin, from + end};
  }
  const Voxel& last = cloud.voxels[end - 1];
  return {cloud.voxels[begin].begin, last.begin + last.count};
}

} // namespace

std::optional<BehindPlane::Touching> BehindPlane::touching(const NodeChild& child, std::uint64_t& looks)
{
  const Range below = pointsBelow(cloud_, child);
  const std::uint64_t key = std::uint64_t{below.begin} << 32 | below.end;
  auto found = found_.find(key);
  if (found == found_.end()) {
    if (below.end - below.begin > looks) return std::nullopt;
    found = found_.emplace(key, look(child, looks)).first;
  }
  return found->second;
}

int BehindPlane::sideOf(std::uint32_t record) const
{
  if (!cloud_.view.triangles) return sideOf(cloud_.view.point(record));
  int side = -1;
  for (const Point3& corner : cloud_.view.triangles->triangle(record)) side = std::max(side, sideOf(corner));
  return side;
}

/// @pre none of it is beyond the plane. What touches it are corners, and what is between them.
bool BehindPlane::touchesElsewhere(std::uint32_t record) const
{
  if (known_ == kNoRecord || !cloud_.view.triangles) return true;
  const auto known = cloud_.view.triangles->triangle(known_);
  const auto corners = cloud_.view.triangles->triangle(record);
  return std::any_of(corners.begin(), corners.end(), [&](const Point3& corner) {
    return std::find(known.begin(), known.end(), corner) == known.end() && sideOf(corner) == 0;
  });
}

std::optional<BehindPlane::Touching> BehindPlane::look(const NodeChild& child, std::uint64_t& looks) const
{
  const std::uint32_t begin = child.node.begin[child.lane], end = child.node.begin[child.lane + 1];
  Touching touching;
  bool is_behind = true;
  const auto visit = [&](std::uint32_t record) {
    if (!is_behind) return;
    --looks;
    const int side = sideOf(record);
    is_behind = side <= 0;
    if (side != 0) return;
    touching.lowest = std::min(touching.lowest, record);
    if (record < touching.elsewhere && touchesElsewhere(record)) touching.elsewhere = record;
  };
  if (child.space == kAboveVoxels) {
    for (std::uint32_t voxel = begin; voxel < end && is_behind; ++voxel) cloud_.forEachRecord(voxel, visit);
  }
  else {
    const Voxel& voxel = cloud_.voxels[child.space];
    for (std::uint32_t i = begin; i < end; ++i) visit(voxel.records()[i]);
  }
  return is_behind ? std::optional(touching) : std::nullopt;
}

} // namespace pcl_bsh
