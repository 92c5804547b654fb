// SPDX-License-Identifier: BSD-3-Clause
#include "uniform_grid.h"

#include "../harness.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::bench {
namespace {

std::array<float, 3> coordinates(const Point& p, const std::array<int, 3>& axis)
{
  const float xyz[3] = {p.x, p.y, p.z};
  return {xyz[axis[0]], xyz[axis[1]], xyz[axis[2]]};
}

int cellsAlong(double extent, double edge)
{
  return static_cast<int>(std::floor(extent / edge)) + 1;
}

} // namespace

void UniformGrid::release()
{
  start_ = std::vector<std::uint32_t>(1, 0);
  sorted_ = Points();
}

void UniformGrid::build(const Points& points, float d)
{
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  release();
  axis_ = {2, 1, 0};
  if (points.empty()) return;

  float low[3] = {kInfinity, kInfinity, kInfinity}, high[3] = {-kInfinity, -kInfinity, -kInfinity};
  for (const Point& p : points) {
    low[0] = std::min(low[0], p.x), high[0] = std::max(high[0], p.x);
    low[1] = std::min(low[1], p.y), high[1] = std::max(high[1], p.y);
    low[2] = std::min(low[2], p.z), high[2] = std::max(high[2], p.z);
  }
  const auto extent = [&](int k) { return double{high[k]} - low[k]; };
  if (tuning_.craft == GridCraft::crafted)
    std::stable_sort(axis_.begin(), axis_.end(), [&](int i, int j) { return extent(i) > extent(j); });

  const double most_cells = std::max(64.0, tuning_.cells_per_point * static_cast<double>(points.size()));
  edge_ = std::max(tuning_.edge_per_d * d, 1e-6 * std::max(extent(axis_[0]), 1e-30));
  const auto cellCount = [&](double edge) {
    double product = 1.0;
    for (int k = 0; k < 3; ++k) product *= std::floor(extent(k) / edge) + 1.0;
    return product;
  };
  while (cellCount(edge_) > most_cells) edge_ *= 1.05;
  inverse_edge_ = static_cast<float>(1.0 / edge_);
  for (std::size_t k = 0; k < 3; ++k) {
    origin_[k] = low[axis_[k]];
    size_[k] = cellsAlong(extent(axis_[k]), edge_) + 1; // one spare: the float product may round up
  }

  const auto n = static_cast<std::uint32_t>(points.size());
  const auto cells =
      static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(size_[2]);
  std::vector<std::uint32_t> cell_of(n);
  start_.assign(cells + 1, 0);
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto p = coordinates(points[i], axis_);
    const auto s = static_cast<std::uint32_t>((p[0] - origin_[0]) * inverse_edge_);
    const auto m = static_cast<std::uint32_t>((p[1] - origin_[1]) * inverse_edge_);
    const auto f = static_cast<std::uint32_t>((p[2] - origin_[2]) * inverse_edge_);
    cell_of[i] = (s * static_cast<std::uint32_t>(size_[1]) + m) * static_cast<std::uint32_t>(size_[2]) + f;
    ++start_[cell_of[i]];
  }
  std::uint32_t sum = 0;
  for (auto& entry : start_) sum += entry, entry = sum; // ends; the scatter counts them down to starts
  sorted_.resize(n);
  for (std::uint32_t i = n; i-- > 0;) sorted_[--start_[cell_of[i]]] = points[i];
}

bool UniformGrid::columnHasNear(std::size_t column, const std::array<int, 2>& fast_range, const Point& query,
                                float squared_d) const
{
  const std::uint32_t* start = start_.data() + column * static_cast<std::size_t>(size_[2]);
  const Point* const end = sorted_.data() + start[fast_range[1] + 1];
  for (const Point* p = sorted_.data() + start[fast_range[0]]; p != end; ++p)
    if (squaredDistance(*p, query) <= squared_d) return true;
  return false;
}

UniformGrid::Reach UniformGrid::reachOf(const Point& point, float d) const
{
  Reach reach;
  reach.empty = sorted_.empty();
  const auto query = coordinates(point, axis_);
  for (std::size_t k = 0; k < 3 && !reach.empty; ++k) {
    const float position = (query[k] - origin_[k]) * inverse_edge_;
    const float slack = d * inverse_edge_ * 1.00001f + 1e-5f;
    const auto last = static_cast<float>(size_[k] - 1);
    reach.empty = position + slack < 0.0f || position - slack > last + 1.0f;
    reach.cell[k][0] = static_cast<int>(std::max(position - slack, 0.0f));
    reach.cell[k][1] = static_cast<int>(std::min(position + slack, last));
    reach.home[k] = static_cast<int>(std::min(std::max(position, 0.0f), last));
  }
  return reach;
}

bool UniformGrid::near(const Point& point, float d, float squared_d) const
{
  const Reach reach = reachOf(point, d);
  if (reach.empty) return false;
  const auto column = [&](int s, int m) {
    return static_cast<std::size_t>(s) * static_cast<std::size_t>(size_[1]) + static_cast<std::size_t>(m);
  };
  const bool home_first = tuning_.craft == GridCraft::crafted;
  const auto& [slow, middle, fast] = reach.cell;
  if (home_first && columnHasNear(column(reach.home[0], reach.home[1]), fast, point, squared_d)) return true;
  for (int s = slow[0]; s <= slow[1]; ++s) {
    for (int m = middle[0]; m <= middle[1]; ++m) {
      if (home_first && s == reach.home[0] && m == reach.home[1]) continue;
      if (columnHasNear(column(s, m), fast, point, squared_d)) return true;
    }
  }
  return false;
}

void UniformGrid::flag(const Points& queries, std::size_t begin, std::size_t end, float d, std::uint8_t* out) const
{
  for (std::size_t i = begin; i < end; ++i) out[i] = near(queries[i], d, d * d);
}

bool UniformGrid::any(const Point* queries, std::size_t count, float d) const
{
  for (std::size_t i = 0; i < count; ++i)
    if (near(queries[i], d, d * d)) return true;
  return false;
}

GridTuning tuneGrid(GridCraft craft, const Points& indexed, const Points& queries, float d)
{
  // Short runs of neighbouring queries stand for all of them: an eighth of the work, in the same order in memory.
  constexpr std::size_t kRuns = 64, kShare = 8;
  std::vector<std::uint8_t> flags(queries.size());
  const auto secondsWith = [&](const GridTuning& tuning) {
    UniformGrid grid(tuning);
    const Stopwatch build;
    grid.build(indexed, d);
    const double build_seconds = build.seconds();
    const Stopwatch query;
    for (std::size_t run = 0; run < kRuns; ++run) {
      const std::size_t begin = queries.size() * run / kRuns;
      grid.flag(queries, begin, begin + queries.size() / kRuns / kShare, d, flags.data());
    }
    return build_seconds + query.seconds() * kShare;
  };
  GridTuning best;
  double least = std::numeric_limits<double>::infinity();
  for (const double cells_per_point : {1.0, 4.0, 16.0, 64.0}) {
    for (const double edge_per_d : {0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 4.0}) {
      const GridTuning tuning{craft, edge_per_d, cells_per_point};
      const double seconds = std::min(secondsWith(tuning), secondsWith(tuning)); // a busy moment must not reject it
      if (seconds < least) least = seconds, best = tuning;
    }
  }
  return best;
}

} // namespace pcl_bsh::bench
