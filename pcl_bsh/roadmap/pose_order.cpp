// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/roadmap/pose_order.h>

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/geometry/given_sphere.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr std::size_t kDimensions = 6;
using PosePlace = std::array<double, kDimensions>;

/// Six lengths that change about as much as points of the body move: where its middle is, and how it is turned.
PosePlace placeOf(const Eigen::Isometry3d& pose, const BodyBall& body)
{
  const Eigen::Vector3d center = pose * body.center;
  Eigen::Quaterniond turn(pose.linear());
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const double lever = 2.0 * body.radius; // half of the angle's sine, there and back
  return {center.x(), center.y(), center.z(), lever * turn.x(), lever * turn.y(), lever * turn.z()};
}

/// Spreads 10 bits so that five zeros follow each.
std::uint64_t spreadBySix(std::uint64_t bits)
{
  std::uint64_t spread = 0;
  for (unsigned i = 0; i < 10; ++i) spread |= (bits >> i & 1u) << (kDimensions * i);
  return spread;
}

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
  bool operator<(const Keyed& other) const { return key != other.key ? key < other.key : index < other.index; }
};

constexpr std::size_t kBlock = 4096; // poses of one task

} // namespace

BodyBall::BodyBall(const SphereHierarchy& body)
{
  const SphereHierarchy::Storage& storage = body.storage();
  const LocalFrame& frame = storage.frame;
  const Node& root = storage.top[0];
  center = Eigen::Vector3d(frame.origin[0], frame.origin[1], frame.origin[2]);
  double reach = 0.0;
  for (std::uint32_t i = 0; i < root.count; ++i) {
    const Eigen::Vector3d at(root.x[i], root.y[i], root.z[i]);
    reach = std::max(reach, at.norm() + static_cast<double>(root.r[i]));
  }
  radius = reach * frame.unit * (1.0 + 8 * kFewDoubleRoundings);
}

/// |T p - S p| <= |T c - S c| + |R - Q| |p - c|, with the spectral norm: 1 / sqrt(2) of Frobenius' for rotations R, Q.
/// Poses are within 0.51e-6 of rotations each, which 2e-6 covers twice over. Rounding: a few v of all that is added.
/// Squares must not underflow: poses that differ would be one.
double motionBound(const BodyBall& body, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to)
{
  const double turned = (from.linear() - to.linear()).norm();
  if (turned == 0.0 && from.translation() == to.translation()) return 0.0;
  const Eigen::Vector3d there = from * body.center, here = to * body.center;
  const double bound = (there - here).stableNorm() + body.radius * (turned * std::sqrt(0.5) + 2e-6);
  const double added = from.linear().cwiseAbs().sum() * body.center.cwiseAbs().maxCoeff() +
                       from.translation().cwiseAbs().maxCoeff() + to.translation().cwiseAbs().maxCoeff();
  const double safe = bound * (1.0 + 0x1p-40) + added * 0x1p-46 + kVanishingLength;
  return std::isfinite(safe) ? safe : std::numeric_limits<double>::infinity();
}

std::vector<std::uint32_t> orderOf(const PoseList& poses, const BodyBall& body, unsigned threads)
{
  const std::size_t count = poses.size(), blocks = (count + kBlock - 1) / kBlock;
  const auto forEachIn = [&](std::size_t block, const auto& visit) {
    for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) visit(i);
  };
  struct Range {
    PosePlace low, high;
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Range none;
  none.low.fill(infinity);
  none.high.fill(-infinity);
  std::vector<Range> ranges(blocks, none);
  parallelFor(blocks, threads, [&](std::size_t block) {
    forEachIn(block, [&](std::size_t i) {
      const PosePlace place = placeOf(poses[i], body);
      for (std::size_t k = 0; k < kDimensions; ++k) {
        ranges[block].low[k] = std::min(ranges[block].low[k], place[k]);
        ranges[block].high[k] = std::max(ranges[block].high[k], place[k]);
      }
    });
  });
  Range all = none;
  for (const Range& range : ranges) {
    for (std::size_t k = 0; k < kDimensions; ++k) {
      all.low[k] = std::min(all.low[k], range.low[k]);
      all.high[k] = std::max(all.high[k], range.high[k]);
    }
  }
  double extent = 0.0; // one for all: cells are cubes
  for (std::size_t k = 0; k < kDimensions; ++k) extent = std::max(extent, all.high[k] - all.low[k]);
  const double cells = std::isfinite(1023.0 / extent) ? 1023.0 / extent : 0.0;

  std::vector<Keyed> keyed(count);
  parallelFor(blocks, threads, [&](std::size_t block) {
    forEachIn(block, [&](std::size_t i) {
      const PosePlace place = placeOf(poses[i], body);
      std::uint64_t key = 0;
      for (std::size_t k = 0; k < kDimensions; ++k) {
        const double cell = (place[k] - all.low[k]) * cells;
        key |= spreadBySix(cell > 0.0 ? static_cast<std::uint64_t>(std::min(cell, 1023.0)) : 0) << k;
      }
      keyed[i] = {key, static_cast<std::uint32_t>(i)};
    });
  });
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = keyed[i].index;
  return order;
}

} // namespace pcl_bsh
