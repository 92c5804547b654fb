// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/traversal/behind_plane.h>

#include <pcl_bsh/hierarchy/record_corners.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

/// The range of points below a child, counted over all voxels.
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

/// The greater one; NaN where one of them is.
double greater(double x, double y)
{
  return std::isnan(x) || y <= x ? x : y;
}

/// The greater number, if both are known.
std::optional<LongNumber> greater(const std::optional<LongNumber>& x, const std::optional<LongNumber>& y)
{
  if (!x || !y) return std::nullopt;
  bool sure = true;
  const int sign = (*x - *y).sign(sure);
  if (sure) return sign < 0 ? y : x;
  const LongNumber& less_known = x->error() < y->error() ? *y : *x; // they differ by less than their errors
  const double error = 2 * (x->error() + y->error()) + std::abs((*x - *y).value()) * (1.0 + kDoubleMargin);
  return LongNumber(less_known.value(), less_known.tail(), less_known.error() + error);
}

} // namespace

BehindPlane::Known& BehindPlane::known(const NodeChild& child)
{
  const Range below = pointsBelow(cloud_, child);
  return found_[std::uint64_t{below.begin} << 32 | below.end];
}

template <class Visit>
void BehindPlane::forEachRecord(const NodeChild& child, const Visit& visit) const
{
  const std::uint32_t begin = child.node.begin[child.lane], end = child.node.begin[child.lane + 1];
  if (child.space == kAboveVoxels) {
    for (std::uint32_t voxel = begin; voxel < end; ++voxel) cloud_.forEachRecord(voxel, visit);
    return;
  }
  const Voxel& voxel = cloud_.voxels[child.space];
  for (std::uint32_t i = begin; i < end; ++i) visit(voxel.records()[i]);
}

double BehindPlane::heightAtMost(std::uint32_t record) const
{
  double most = -std::numeric_limits<double>::infinity();
  const Corners corners = cornersOf(cloud_.view, record);
  for (std::uint32_t i = 0; i < corners.count; ++i) most = greater(most, plane_.heightAtMost(corners.at[i]));
  return most;
}

std::optional<LongNumber> BehindPlane::height(std::uint32_t record) const
{
  std::optional<LongNumber> most = LongNumber(-std::numeric_limits<double>::max());
  const Corners corners = cornersOf(cloud_.view, record);
  for (std::uint32_t i = 0; i < corners.count; ++i) most = greater(most, plane_.height(corners.at[i]));
  return most;
}

std::optional<double> BehindPlane::heightAtMost(const NodeChild& child, std::uint64_t& looks)
{
  std::optional<double>& most = known(child).height;
  if (most) return most;
  const Range below = pointsBelow(cloud_, child);
  if (below.end - below.begin > looks) return std::nullopt;
  looks -= below.end - below.begin;
  most = -std::numeric_limits<double>::infinity();
  forEachRecord(child, [&](std::uint32_t record) { most = greater(*most, heightAtMost(record)); });
  return most;
}

std::optional<LongNumber> BehindPlane::height(const NodeChild& child)
{
  std::optional<std::optional<LongNumber>>& most = known(child).longer;
  if (most) return *most;
  most = LongNumber(-std::numeric_limits<double>::max());
  forEachRecord(child, [&](std::uint32_t record) { *most = greater(*most, height(record)); });
  return *most;
}

std::optional<BehindPlane::Touching> BehindPlane::touching(const NodeChild& child)
{
  std::optional<std::optional<Touching>>& found = known(child).touching;
  if (!found) found = look(child);
  return *found;
}

int BehindPlane::sideOf(std::uint32_t record) const
{
  int side = -1;
  const Corners corners = cornersOf(cloud_.view, record);
  for (std::uint32_t i = 0; i < corners.count; ++i) side = std::max(side, plane_.side(corners.at[i]));
  return side;
}

/// Whether the record touches the plane with a corner that `known_` does not have. A triangle that is not beyond the
/// plane touches it with corners, and between them.
/// @pre no part of the record is beyond the plane
bool BehindPlane::touchesElsewhere(std::uint32_t record) const
{
  if (known_ == kNoRecord || !cloud_.view.triangles) return true;
  const auto known = cloud_.view.triangles->triangle(known_);
  const auto corners = cloud_.view.triangles->triangle(record);
  return std::any_of(corners.begin(), corners.end(), [&](const Point3& corner) {
    return std::find(known.begin(), known.end(), corner) == known.end() && plane_.side(corner) == 0;
  });
}

std::optional<BehindPlane::Touching> BehindPlane::look(const NodeChild& child) const
{
  Touching touching;
  bool is_behind = true;
  forEachRecord(child, [&](std::uint32_t record) {
    if (!is_behind) return;
    const int side = sideOf(record);
    is_behind = side <= 0;
    if (side != 0) return;
    touching.lowest = std::min(touching.lowest, record);
    if (record < touching.elsewhere && touchesElsewhere(record)) touching.elsewhere = record;
  });
  return is_behind ? std::optional(touching) : std::nullopt;
}

} // namespace pcl_bsh
