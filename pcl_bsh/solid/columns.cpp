// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/columns.h>

#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A triangle is put into columns and cubes that it misses by this share of their width, which is far above what double
/// arithmetic gets wrong.
constexpr double kPad = 0x1p-12;

/// Entries of the whole first grid, about; a finer one is made where a column has more than kCrowded.
std::size_t mostEntries(std::size_t triangles)
{
  return 6 * triangles + (1 << 14);
}
/// What is added where these make few columns: of long thin triangles, each of which meets many.
std::size_t moreEntries(std::size_t triangles)
{
  return std::min<std::size_t>(40 * triangles, 1 << 21);
}
constexpr double kFewColumns = 1.0 / 16; ///< for each triangle
/// Bytes of all grids. A finer one takes up to 128 for each of its triangles.
std::size_t mostBytes(std::size_t triangles)
{
  return 32 * triangles + (1 << 17);
}
constexpr std::size_t kFinerEntries = 16, kFinerCells = 8;
constexpr std::uint32_t kCrowded = 128;
constexpr std::uint32_t kMostColumns = 4096; ///< along an axis

double shareOf(double x, double of)
{
  return of > 0.0 ? x / of : 0.0;
}

/// The middle of most triangles, whatever lies far off: what is near it has the most precise boxes.
Point3 middleOf(const TrianglesView& view)
{
  constexpr std::size_t kSamples = 1023;
  std::array<std::vector<double>, 3> samples;
  const std::size_t step = std::max<std::size_t>(1, view.count / kSamples);
  for (std::size_t i = 0; i < view.count; i += step) {
    const Triangle3 t = view.triangle(static_cast<std::uint32_t>(i));
    if (!isFinite(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) samples[k].push_back(t[0][k]);
  }
  Point3 middle = {};
  for (std::size_t k = 0; k < 3; ++k) {
    if (samples[k].empty()) continue;
    const auto half = samples[k].begin() + static_cast<std::ptrdiff_t>(samples[k].size() / 2);
    std::nth_element(samples[k].begin(), half, samples[k].end());
    middle[k] = *half;
  }
  return middle;
}

/// Calls visit(p) for the corners of that part of a convex polygon which lies between two planes across an axis; some
/// twice.
template <class Visit>
void forEachCorner(const Point3* corners, std::size_t count, std::size_t axis, double low, double high,
                   const Visit& visit)
{
  for (std::size_t i = 0; i < count; ++i) {
    const Point3 &u = corners[i], &v = corners[i + 1 < count ? i + 1 : 0];
    if (u[axis] >= low && u[axis] <= high) visit(u);
    const bool upward = u[axis] < v[axis];
    for (const double at : {upward ? low : high, upward ? high : low}) {
      if ((u[axis] < at) == (v[axis] < at) || !(std::abs(at) < kInfinity)) continue;
      const double share = (at - u[axis]) / (v[axis] - u[axis]);
      Point3 p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = u[k] + (v[k] - u[k]) * share;
      visit(p);
    }
  }
}

} // namespace

/// How much of a grid triangles fill: columns of width w take count + extent / w + area / w^2 entries, about.
struct Columns::Shadows {
  std::size_t count = 0;
  double extent = 0.0, area = 0.0;

  void add(double width, double height, double own_area)
  {
    ++count;
    extent += width + height;
    area += std::min(width * height, own_area);
  }
  double entries(double per) const { return static_cast<double>(count) + per * (extent + per * area); }
};

Columns::Columns(const TrianglesView& triangles) : view_(triangles), origin_(middleOf(triangles))
{
  boxes_.resize(view_.count);
  Point3 low = {kInfinity, kInfinity, kInfinity}, high = {-kInfinity, -kInfinity, -kInfinity};
  Point3 shadows = {}; // along each axis
  for (std::size_t i = 0; i < view_.count; ++i) {
    const Triangle3 t = seenTriangle(static_cast<std::uint32_t>(i));
    Box& box = boxes_[i];
    if (!isFinite(view_.triangle(static_cast<std::uint32_t>(i)))) {
      std::fill(box.low, box.low + 3, std::numeric_limits<float>::infinity());
      std::fill(box.high, box.high + 3, -std::numeric_limits<float>::infinity());
      continue;
    }
    Point3 wide;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [least, most] = std::minmax({t[0][k], t[1][k], t[2][k]});
      box.low[k] = roundDown(least), box.high[k] = roundUp(most);
      low[k] = std::min(low[k], least), high[k] = std::max(high[k], most);
      wide[k] = most - least;
    }
    for (std::size_t k = 0; k < 3; ++k) shadows[k] += wide[(k + 1) % 3] * wide[(k + 2) % 3];
  }
  low_ = low, high_ = high;
  if (empty()) return;

  std::size_t axis = 0;
  double least = kInfinity;
  for (std::size_t k = 0; k < 3; ++k) {
    const double whole = (high[(k + 1) % 3] - low[(k + 1) % 3]) * (high[(k + 2) % 3] - low[(k + 2) % 3]);
    const double layers = whole > 0.0 ? shadows[k] / whole : kInfinity;
    if (layers < least) least = layers, axis = k;
    error_ = std::max({error_, kDoubleUnit * std::abs(low[k]), kDoubleUnit * std::abs(high[k])});
  }
  axes_ = {(axis + 1) % 3, (axis + 2) % 3, axis};
  for (std::size_t k = 0; k < 3; ++k) low_[k] = low[axes_[k]], high_[k] = high[axes_[k]];
  for (Box& box : boxes_) {
    const Box before = box;
    for (std::size_t k = 0; k < 3; ++k) box.low[k] = before.low[axes_[k]], box.high[k] = before.high[axes_[k]];
  }

  for (std::size_t k = 0; k < 3; ++k) cubes_per_[k] = shareOf(kCubes, high_[k] - low_[k]);
  cubes_.assign(kCubes * kCubes, 0);
  std::vector<std::uint32_t> all;
  all.reserve(view_.count);
  for (std::uint32_t i = 0; i < view_.count; ++i) {
    if (!(boxes_[i].low[0] <= boxes_[i].high[0])) continue;
    all.push_back(i);
    markCubes(seenTriangle(i));
  }
  makeGrid(low_, high_, all, false);
  refine();
  cells_.shrink_to_fit();
  entries_.shrink_to_fit();
}

bool Columns::makeGrid(const Point3& low, const Point3& high, const std::vector<std::uint32_t>& triangles, bool finer)
{
  Shadows shadows;
  for (const std::uint32_t i : triangles) {
    const Triangle3 t = seenTriangle(i);
    Point3 wide;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto [least, most] = std::minmax({t[0][k], t[1][k], t[2][k]});
      wide[k] = std::max(0.0, std::min(most, high[k]) - std::max(least, low[k]));
    }
    shadows.add(wide[0], wide[1],
                0.5 * std::abs((t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) - (t[1][1] - t[0][1]) * (t[2][0] - t[0][0])));
  }
  const double width = high[0] - low[0], height = high[1] - low[1], longest = std::max(width, height);
  const auto count = static_cast<double>(triangles.size());
  bool may_have_more = !finer;
  double most_entries =
      finer ? static_cast<double>(kFinerEntries) * count : static_cast<double>(mostEntries(triangles.size()));
  const double most_cells = finer ? static_cast<double>(kFinerCells) * count : count + 4096.0;
  const auto along = [](double length, double per) { return std::max(1.0, std::ceil(length * per)); };
  double per = shareOf(1.0, longest);
  if (!(per < kInfinity)) per = 0.0;
  for (int step = 0; per > 0.0 && step < 64; ++step) {
    const double next = per * 1.2;
    const double cells = along(width, next) * along(height, next);
    if (may_have_more && shadows.entries(next) > most_entries && cells < kFewColumns * count) {
      most_entries += static_cast<double>(moreEntries(triangles.size()));
      may_have_more = false;
    }
    if (cells > most_cells || shadows.entries(next) > most_entries || next * longest > kMostColumns) break;
    per = next;
  }
  Grid grid;
  std::vector<std::uint32_t> ends;
  for (;; per *= 0.8) { // needles meet more columns than their shadows fill
    const double columns = along(width, per), rows = along(height, per);
    if (finer && shadows.entries(per) > 0.6 * count * columns * rows) return false;
    grid = {low[0], low[1], shareOf(columns, width), shareOf(rows, height), 0.0, 0, 0, 0};
    if (!(grid.per_x < kInfinity)) grid.per_x = 0.0;
    if (!(grid.per_y < kInfinity)) grid.per_y = 0.0;
    grid.columns = static_cast<std::uint32_t>(columns), grid.rows = static_cast<std::uint32_t>(rows);
    grid.pad = kPad * std::max(width / columns, height / rows);
    ends.assign(std::size_t{grid.columns} * grid.rows + 1, 0);
    double entries = 0.0;
    for (const std::uint32_t i : triangles) forEachCell(grid, i, [&](std::size_t cell) { ++ends[cell], ++entries; });
    if (entries <= 1.25 * most_entries || ends.size() <= 2) break;
  }
  grid.first = static_cast<std::uint32_t>(cells_.size());
  std::uint32_t begin = static_cast<std::uint32_t>(entries_.size()), sum = begin;
  for (std::uint32_t& n : ends) sum += std::exchange(n, sum);
  entries_.resize(sum);
  for (const std::uint32_t i : triangles) forEachCell(grid, i, [&](std::size_t cell) { entries_[ends[cell]++] = i; });
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) cells_.push_back({std::exchange(begin, ends[i]), ends[i]});
  grids_.push_back(grid);
  return true;
}

/// Calls visit(i) for the columns of a grid that the triangle's shadow meets: of each row, those between its leftmost
/// and its rightmost place there.
template <class Visit>
void Columns::forEachCell(const Grid& grid, std::uint32_t triangle, const Visit& visit) const
{
  const Box& box = boxes_[triangle];
  const auto column = [&](double x) { return indexOf(x, grid.x, grid.per_x, grid.columns); };
  const auto row = [&](double y) { return indexOf(y, grid.y, grid.per_y, grid.rows); };
  const double low_x = static_cast<double>(box.low[0]) - grid.pad, high_x = static_cast<double>(box.high[0]) + grid.pad;
  const std::uint32_t first = column(low_x), last = column(high_x);
  const std::uint32_t bottom = row(static_cast<double>(box.low[1]) - grid.pad),
                      top = row(static_cast<double>(box.high[1]) + grid.pad);
  const bool narrow = first == last || bottom == top;
  Triangle3 t = {};
  if (!narrow) t = seenTriangle(triangle);
  for (std::uint32_t j = bottom; j <= top; ++j) {
    std::uint32_t from = first, to = last;
    if (!narrow) {
      // The first and the last row stand for what lies beyond, too.
      const double below = j == 0 ? -kInfinity : grid.y + j / grid.per_y - grid.pad;
      const double above = j + 1 == grid.rows ? kInfinity : grid.y + (j + 1) / grid.per_y + grid.pad;
      double left = kInfinity, right = -kInfinity;
      const auto reach = [&](double x) { left = std::min(left, x), right = std::max(right, x); };
      for (std::size_t i = 0; i < 3; ++i) {
        const Point3 &u = t[i], &v = t[(i + 1) % 3];
        if (u[1] >= below && u[1] <= above) reach(u[0]);
        for (const double y : {below, above})
          if ((u[1] < y) != (v[1] < y) && std::abs(y) < kInfinity)
            reach(u[0] + (v[0] - u[0]) * ((y - u[1]) / (v[1] - u[1])));
      }
      from = std::max(from, column(left - grid.pad)), to = std::min(to, column(right + grid.pad));
    }
    for (std::uint32_t i = from; i <= to; ++i) visit(std::size_t{j} * grid.columns + i);
  }
}

/// Gives crowded columns finer grids, the most crowded first, as far as memory goes.
void Columns::refine()
{
  const std::size_t most = mostBytes(view_.count);
  constexpr std::size_t finer_bytes = kFinerEntries * sizeof(std::uint32_t) + kFinerCells * sizeof(Cell);
  using Crowded = std::tuple<std::uint32_t, std::size_t, std::uint32_t>; // entries, cell, grid
  std::priority_queue<Crowded> crowded;
  const auto note = [&](std::uint32_t grid) {
    const std::size_t cells = std::size_t{grids_[grid].columns} * grids_[grid].rows;
    for (std::size_t i = grids_[grid].first; i < grids_[grid].first + cells; ++i)
      if (cells_[i].end - cells_[i].begin > kCrowded) crowded.emplace(cells_[i].end - cells_[i].begin, i, grid);
  };
  note(0);
  std::vector<std::uint32_t> some;
  while (!crowded.empty()) {
    const auto [count, cell, index] = crowded.top();
    crowded.pop();
    if (entries_.size() * sizeof(std::uint32_t) + cells_.size() * sizeof(Cell) + finer_bytes * count > most) continue;
    const Grid grid = grids_[index];
    const std::size_t place = cell - grid.first;
    const auto column = static_cast<double>(place % grid.columns), row = static_cast<double>(place / grid.columns);
    Point3 low = low_, high = high_;
    if (grid.per_x > 0.0) low[0] = grid.x + column / grid.per_x, high[0] = grid.x + (column + 1.0) / grid.per_x;
    if (grid.per_y > 0.0) low[1] = grid.y + row / grid.per_y, high[1] = grid.y + (row + 1.0) / grid.per_y;
    // Finer than what double arithmetic tells apart at the largest coordinate is of no use.
    if (!(std::max(high[0] - low[0], high[1] - low[1]) * kPad * kPad > error_)) continue;
    some.assign(entries_.begin() + cells_[cell].begin, entries_.begin() + cells_[cell].end);
    if (!makeGrid(low, high, some, true)) continue;
    const auto finer = static_cast<std::uint32_t>(grids_.size() - 1);
    cells_[cell] = {Cell::kGrid, finer};
    note(finer);
  }
}

void Columns::collect(std::uint32_t index, const Point3& at, double error, std::vector<std::uint32_t>& found) const
{
  const Grid& grid = grids_[index];
  const std::uint32_t left = indexOf(at[0] - error, grid.x, grid.per_x, grid.columns),
                      right = indexOf(at[0] + error, grid.x, grid.per_x, grid.columns);
  const std::uint32_t bottom = indexOf(at[1] - error, grid.y, grid.per_y, grid.rows),
                      top = indexOf(at[1] + error, grid.y, grid.per_y, grid.rows);
  for (std::uint32_t j = bottom; j <= top; ++j)
    for (std::uint32_t i = left; i <= right; ++i) {
      const Cell& cell = cells_[grid.first + std::size_t{j} * grid.columns + i];
      if (cell.begin == Cell::kGrid)
        collect(cell.end, at, error, found);
      else
        found.insert(found.end(), entries_.begin() + cell.begin, entries_.begin() + cell.end);
    }
}

Columns::Range Columns::above(const Point3& at, double error, std::vector<std::uint32_t>& several) const
{
  for (std::uint32_t index = 0;;) {
    const Grid& grid = grids_[index];
    if (!(error <= grid.pad)) break;
    const Cell& cell = cells_[grid.first + std::size_t{indexOf(at[1], grid.y, grid.per_y, grid.rows)} * grid.columns +
                              indexOf(at[0], grid.x, grid.per_x, grid.columns)];
    if (cell.begin != Cell::kGrid) return {entries_.data() + cell.begin, entries_.data() + cell.end};
    index = cell.end;
  }
  several.clear();
  collect(0, at, error, several);
  std::sort(several.begin(), several.end());
  several.erase(std::unique(several.begin(), several.end()), several.end());
  return {several.data(), several.data() + several.size()};
}

bool Columns::isClear(const Point3& at, double reach) const noexcept
{
  constexpr std::uint32_t kWidest = 32;
  std::array<std::uint32_t, 3> from, to;
  for (std::size_t k = 0; k < 3; ++k) {
    from[k] = indexOf(at[k] - reach, low_[k], cubes_per_[k], kCubes);
    to[k] = indexOf(at[k] + reach, low_[k], cubes_per_[k], kCubes);
    if (to[k] - from[k] >= kWidest) return false;
  }
  const std::uint64_t row = (~std::uint64_t{0} >> (kCubes - 1 - (to[2] - from[2]))) << from[2];
  for (std::uint32_t i = from[0]; i <= to[0]; ++i) {
    std::uint64_t met = 0;
    for (std::uint32_t j = from[1]; j <= to[1]; ++j) met |= cubes_[i * kCubes + j];
    if ((met & row) != 0) return false;
  }
  return true;
}

/// Marks the cubes that a triangle may meet: of each slab along the first axis and each row of it along the second,
/// those that the part of the triangle there reaches along the last.
void Columns::markCubes(const Triangle3& t)
{
  Point3 pad;
  std::array<std::uint32_t, 3> from, to;
  const auto cube = [&](double x, std::size_t axis) { return indexOf(x, low_[axis], cubes_per_[axis], kCubes); };
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [least, most] = std::minmax({t[0][k], t[1][k], t[2][k]});
    pad[k] = kPad * (high_[k] - low_[k]) / kCubes;
    from[k] = cube(least - pad[k], k), to[k] = cube(most + pad[k], k);
  }
  const auto mark = [&](std::uint32_t i, std::uint32_t j, std::uint32_t low, std::uint32_t high) {
    cubes_[i * kCubes + j] |= (~std::uint64_t{0} >> (kCubes - 1 - (high - low))) << low;
  };
  const auto isWide = [&](std::size_t axis) { return to[axis] - from[axis] > 1; };
  if (!isWide(0) && !isWide(1) && !isWide(2)) {
    for (std::uint32_t i = from[0]; i <= to[0]; ++i)
      for (std::uint32_t j = from[1]; j <= to[1]; ++j) mark(i, j, from[2], to[2]);
    return;
  }
  // The first and the last stand for what lies beyond, too.
  const auto low = [&](std::uint32_t i, std::size_t axis) {
    return i == 0 ? -kInfinity : low_[axis] + i / cubes_per_[axis] - pad[axis];
  };
  const auto high = [&](std::uint32_t i, std::size_t axis) {
    return i + 1 == kCubes || !(cubes_per_[axis] > 0.0) ? kInfinity
                                                        : low_[axis] + (i + 1) / cubes_per_[axis] + pad[axis];
  };
  std::array<Point3, 9> part;
  for (std::uint32_t i = from[0]; i <= to[0]; ++i) {
    std::size_t corners = 0;
    double bottom = kInfinity, top = -kInfinity;
    forEachCorner(t.data(), 3, 0, low(i, 0), high(i, 0), [&](const Point3& p) {
      part[corners++] = p;
      bottom = std::min(bottom, p[1]), top = std::max(top, p[1]);
    });
    if (corners == 0) continue;
    const std::uint32_t last = cube(top + pad[1], 1);
    for (std::uint32_t j = cube(bottom - pad[1], 1); j <= last; ++j) {
      double least = kInfinity, most = -kInfinity;
      forEachCorner(part.data(), corners, 1, low(j, 1), high(j, 1),
                    [&](const Point3& p) { least = std::min(least, p[2]), most = std::max(most, p[2]); });
      if (least <= most) mark(i, j, cube(least - pad[2], 2), cube(most + pad[2], 2));
    }
  }
}

std::size_t Columns::bytes() const noexcept
{
  return boxes_.capacity() * sizeof(Box) + grids_.capacity() * sizeof(Grid) + cells_.capacity() * sizeof(Cell) +
         entries_.capacity() * sizeof(std::uint32_t) + cubes_.capacity() * sizeof(std::uint64_t);
}

} // namespace pcl_bsh
