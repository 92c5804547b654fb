// SPDX-License-Identifier: BSD-3-Clause
#include "path_peers.h"

#include "../harness.h"
#include "../workload/points_adaptor.h"
#include "peer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::bench {
namespace {

struct Box {
  std::array<double, 3> low, high;
};

Box boxOf(const Points& points)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (const Point& point : points) {
    const std::array<double, 3> p = {point.x, point.y, point.z};
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], p[k]);
      box.high[k] = std::max(box.high[k], p[k]);
    }
  }
  return box;
}

/// Points counting-sorted by cubes of 1 m.
class Cells {
public:
  explicit Cells(const Points& points) : low_(boxOf(points).low)
  {
    const Box box = boxOf(points);
    for (std::size_t k = 0; k < 3; ++k) size_[k] = static_cast<std::size_t>(box.high[k] - box.low[k]) + 1;
    begin_.assign(size_[0] * size_[1] * size_[2] + 1, 0);
    std::vector<std::uint32_t> cell(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      cell[i] = static_cast<std::uint32_t>(cellOf(points[i]));
      ++begin_[cell[i] + 1];
    }
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    sorted_.resize(points.size());
    record_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint32_t place = next[cell[i]]++;
      sorted_[place] = points[i];
      record_[place] = static_cast<std::uint32_t>(i);
    }
  }

  /// Calls take(point, record) for the points of the cells whose surrounding sphere meets the posed box.
  template <typename Take>
  void eachNear(const Box& box, const RigidPose& pose, const Take& take) const
  {
    const Box around = posedBounds(box, pose);
    std::array<std::size_t, 3> first, last;
    for (std::size_t k = 0; k < 3; ++k) {
      const double from = std::floor(around.low[k] - low_[k]), to = std::floor(around.high[k] - low_[k]);
      if (to < 0 || from >= static_cast<double>(size_[k])) return;
      first[k] = static_cast<std::size_t>(std::max(0.0, from));
      last[k] = std::min(static_cast<std::size_t>(to), size_[k] - 1);
    }
    const RigidPose back = pose.inverse();
    for (std::size_t z = first[2]; z <= last[2]; ++z) {
      for (std::size_t y = first[1]; y <= last[1]; ++y) {
        for (std::size_t x = first[0]; x <= last[0]; ++x) {
          const std::size_t cell = (z * size_[1] + y) * size_[0] + x;
          if (begin_[cell] == begin_[cell + 1]) continue;
          const std::array<double, 3> middle = {low_[0] + static_cast<double>(x) + 0.5,
                                                low_[1] + static_cast<double>(y) + 0.5,
                                                low_[2] + static_cast<double>(z) + 0.5};
          if (squaredDistanceTo(box, back.apply(middle)) > 0.76) continue; // (sqrt(3) / 2)^2, rounded up
          for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) take(sorted_[i], record_[i]);
        }
      }
    }
  }

private:
  std::size_t cellOf(const Point& p) const
  {
    const auto x = static_cast<std::size_t>(static_cast<double>(p.x) - low_[0]);
    const auto y = static_cast<std::size_t>(static_cast<double>(p.y) - low_[1]);
    const auto z = static_cast<std::size_t>(static_cast<double>(p.z) - low_[2]);
    return (z * size_[1] + y) * size_[0] + x;
  }

  static Box posedBounds(const Box& box, const RigidPose& pose)
  {
    Points corners;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const auto of = [&](std::size_t k) { return (corner >> k) & 1u ? box.high[k] : box.low[k]; };
      const auto p = pose.apply(std::array<double, 3>{of(0), of(1), of(2)});
      corners.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    }
    Box bounds = boxOf(corners);
    for (std::size_t k = 0; k < 3; ++k) {
      bounds.low[k] -= 0.01; // what the corners may have lost by rounding
      bounds.high[k] += 0.01;
    }
    return bounds;
  }

  static double squaredDistanceTo(const Box& box, const std::array<double, 3>& p)
  {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double beyond = std::max({0.0, box.low[k] - p[k], p[k] - box.high[k]});
      sum += beyond * beyond;
    }
    return sum;
  }

  std::array<double, 3> low_;
  std::array<std::size_t, 3> size_;
  std::vector<std::uint32_t> begin_;
  Points sorted_;
  std::vector<std::uint32_t> record_;
};

/// Takes every point within the bound; nanoflann compares with <.
class FlagAll {
public:
  using DistanceType = float; // as nanoflann 1.5 and later asks
  void sort() {}

  FlagAll(float d, std::vector<std::uint8_t>& flags)
  : bound_(std::nextafter(d * d, std::numeric_limits<float>::infinity())),
    flags_(flags)
  {
  }

  bool addPoint(float, std::uint32_t record)
  {
    flags_[record] = 1;
    return true;
  }
  float worstDist() const { return bound_; }
  bool full() const { return true; }

private:
  float bound_;
  std::vector<std::uint8_t>& flags_;
};

} // namespace

PathFlags flagsByBoxes(const Points& scan, const Points& model, const std::vector<RigidPose>& poses, double d)
{
  PathFlags result;
  const Stopwatch build;
  const Cells cells(scan);
  const auto tree = makeNanoflannTree();
  const auto reach = static_cast<float>(d);
  tree->build(model, reach);
  Box box = boxOf(model);
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] -= d;
    box.high[k] += d;
  }
  result.build_seconds = build.seconds();

  const Stopwatch query;
  result.flags.assign(scan.size(), 0);
  for (const RigidPose& pose : poses) {
    const RigidPose back = pose.inverse();
    cells.eachNear(box, pose, [&](const Point& point, std::uint32_t record) {
      if (result.flags[record] != 0) return;
      const auto p = back.apply(std::array<double, 3>{point.x, point.y, point.z});
      for (std::size_t k = 0; k < 3; ++k)
        if (p[k] < box.low[k] || p[k] > box.high[k]) return;
      const Point seen{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
      result.flags[record] = tree->any(&seen, 1, reach);
    });
  }
  result.query_seconds = query.seconds();
  return result;
}

PathFlags flagsByModelPoints(const Points& scan, const Points& model, const std::vector<RigidPose>& poses, double d,
                             std::size_t stride)
{
  PathFlags result;
  const Stopwatch build;
  const PointsAdaptor adaptor{scan};
  const NanoflannIndex<float> tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  result.build_seconds = build.seconds();

  const Stopwatch query;
  result.flags.assign(scan.size(), 0);
  FlagAll within(static_cast<float>(d), result.flags);
  for (std::size_t k = 0; k < poses.size(); k += stride) {
    for (const Point& point : model) {
      const Point posed = poses[k].apply(point);
      tree.findNeighbors(within, &posed.x, {});
    }
  }
  result.query_seconds = query.seconds();
  return result;
}

} // namespace pcl_bsh::bench
