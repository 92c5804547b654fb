// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/pairs/behind_plane.h>

#include <pcl_bsh/hierarchy/triangles_view.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

/// Of what a child spans, counted over all voxels.
struct Range {
  std::uint32_t begin, end;
};

Range pointsBelow(const SphereHierarchy::Storage& cloud, std::uint32_t space, const Node& node, std::uint32_t lane)
{
  if (space != kAboveVoxels) {
    const std::uint32_t from = cloud.voxels[space].begin;
    return {from + node.begin[lane], from + node.begin[lane + 1]};
  }
  const Voxel& last = cloud.voxels[node.begin[lane + 1] - 1];
  return {cloud.voxels[node.begin[lane]].begin, last.begin + last.count};
}

} // namespace

std::optional<std::uint32_t> BehindPlane::lowestTouching(std::uint32_t space, const Node& node, std::uint32_t lane,
                                                         std::uint64_t& looks)
{
  const Range below = pointsBelow(cloud_, space, node, lane);
  const std::uint64_t key = std::uint64_t{below.begin} << 32 | below.end;
  auto found = found_.find(key);
  if (found == found_.end()) {
    if (below.end - below.begin > looks) return std::nullopt;
    found = found_.emplace(key, look(space, node, lane, looks)).first;
  }
  if (found->second == kBeyond) return std::nullopt;
  return found->second;
}

int BehindPlane::sideOf(std::uint32_t record) const
{
  if (!cloud_.view.triangles) return plane_.side(cloud_.view.point(record));
  int side = -1;
  for (const Point3& corner : cloud_.view.triangles->triangle(record)) side = std::max(side, plane_.side(corner));
  return side;
}

std::uint32_t BehindPlane::look(std::uint32_t space, const Node& node, std::uint32_t lane, std::uint64_t& looks) const
{
  std::uint32_t lowest = kNoRecord;
  const auto visit = [&](std::uint32_t record) {
    if (lowest == kBeyond) return;
    --looks;
    const int side = sideOf(record);
    if (side >= 0) lowest = side > 0 ? kBeyond : std::min(lowest, record);
  };
  if (space == kAboveVoxels) {
    for (std::uint32_t voxel = node.begin[lane]; voxel < node.begin[lane + 1] && lowest != kBeyond; ++voxel)
      cloud_.forEachRecord(voxel, visit);
    return lowest;
  }
  const Voxel& voxel = cloud_.voxels[space];
  for (std::uint32_t i = node.begin[lane]; i < node.begin[lane + 1]; ++i) visit(voxel.records()[i]);
  return lowest;
}

} // namespace pcl_bsh
