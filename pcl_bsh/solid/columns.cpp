// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/columns.h>

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/solid/cells_along.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Entries of the whole first grid, about; a finer one is made where a column has more than kCrowded.
constexpr auto mostEntries = [](std::size_t triangles) { return 6 * triangles + (1 << 14); };
/// Entries added where these make few columns: for long thin triangles, each of which meets many.
constexpr auto moreEntries = [](std::size_t triangles) { return std::min<std::size_t>(40 * triangles, 1 << 21); };
constexpr double kFewColumns = 1.0 / 16; ///< for each triangle
/// Bytes of all grids. A finer one takes up to 128 for each of its triangles.
constexpr auto mostBytes = [](std::size_t triangles) { return 32 * triangles + (1 << 17); };
constexpr std::size_t kFinerEntries = 16, kFinerCells = 8;
constexpr std::uint32_t kCrowded = 128;
constexpr std::uint32_t kTooCrowded = 4096;  ///< for a column without strips
constexpr std::uint32_t kMostColumns = 4096; ///< along an axis
constexpr std::uint32_t kSampled = 8;        ///< places along an axis that tell what a ray costs

/// Cells per unit of length; 0, which puts all into the first cell, where no such number exists.
double perUnit(double cells, double length)
{
  const double per = length > 0.0 ? cells / length : 0.0;
  return per < kInfinity ? per : 0.0;
}

/// Adds room for a few finer grids, so that making them moves nothing.
std::size_t withRoom(std::size_t size)
{
  return size + size / 8;
}

/// Returns the median of sampled corners, per axis. Triangles far off do not shift it, and boxes near it are most
/// precise.
Point3 middleOf(const TrianglesView& view)
{
  constexpr std::size_t kMostSampled = 1023;
  std::array<std::vector<double>, 3> samples;
  const std::size_t step = std::max<std::size_t>(1, view.count / kMostSampled);
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

} // namespace

/// How much of a grid triangles fill: columns of width w take count + extent / w + area / w^2 entries, about.
struct Columns::Shadows {
  std::size_t count = 0;
  double extent = 0.0, area = 0.0, boxes = 0.0; ///< sums

  /// Adds a triangle's shadow on the axes x and y. @param width, height the part of its extent that counts
  void add(const Triangle3& t, std::size_t x, std::size_t y, double width, double height)
  {
    const double twice = (t[1][x] - t[0][x]) * (t[2][y] - t[0][y]) - (t[1][y] - t[0][y]) * (t[2][x] - t[0][x]);
    ++count;
    extent += width + height;
    boxes += width * height;
    area += std::min(width * height, 0.5 * std::abs(twice));
  }
  double entries(double per) const { return static_cast<double>(count) + per * (extent + per * area); }
};

Columns::Columns(const TrianglesView& triangles) : view_(triangles), origin_(middleOf(triangles))
{
  boxes_.append(view_.count);
  Point3 low = {kInfinity, kInfinity, kInfinity}, high = {-kInfinity, -kInfinity, -kInfinity};
  std::array<Shadows, 3> shadows; // along each axis
  for (std::size_t i = 0; i < view_.count; ++i) {
    const Triangle3 t = seenTriangle(static_cast<std::uint32_t>(i));
    FloatBox& box = boxes_[i];
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
    for (std::size_t k = 0; k < 3; ++k)
      shadows[k].add(t, (k + 1) % 3, (k + 2) % 3, wide[(k + 1) % 3], wide[(k + 2) % 3]);
  }
  low_ = low, high_ = high;
  if (empty()) return;

  std::size_t axis = 0;
  double least = kInfinity;
  for (std::size_t k = 0; k < 3; ++k) {
    const double whole = (high[(k + 1) % 3] - low[(k + 1) % 3]) * (high[(k + 2) % 3] - low[(k + 2) % 3]);
    const double layers = whole > 0.0 ? shadows[k].boxes / whole : kInfinity;
    if (layers < least) least = layers, axis = k;
    error_ = std::max({error_, kDoubleUnit * std::abs(low[k]), kDoubleUnit * std::abs(high[k])});
  }
  axes_ = {(axis + 1) % 3, (axis + 2) % 3, axis};
  for (std::size_t k = 0; k < 3; ++k) low_[k] = low[axes_[k]], high_[k] = high[axes_[k]];
  for (FloatBox& box : boxes_) {
    const FloatBox before = box;
    for (std::size_t k = 0; k < 3; ++k) box.low[k] = before.low[axes_[k]], box.high[k] = before.high[axes_[k]];
  }

  cubes_ = Cubes(low_, high_);
  std::vector<std::uint32_t> all;
  all.reserve(view_.count);
  for (std::uint32_t i = 0; i < view_.count; ++i) {
    if (!(boxes_[i].low[0] <= boxes_[i].high[0])) continue;
    all.push_back(i);
    cubes_.mark(seenTriangle(i));
  }
  makeGrid(low_, high_, {all.data(), all.data() + all.size()}, shadows[axis], false);
  refine();
  cells_.shrink(withRoom(cells_.size()));
  entries_.shrink(withRoom(entries_.size()));
}

/// Shadows of the triangles in a column.
Columns::Shadows Columns::shadowsWithin(const Point3& low, const Point3& high, const Range& triangles) const
{
  Shadows shadows;
  for (const std::uint32_t i : triangles) {
    const Triangle3 t = seenTriangle(i);
    Point3 wide;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto [least, most] = std::minmax({t[0][k], t[1][k], t[2][k]});
      wide[k] = std::max(0.0, std::min(most, high[k]) - std::max(least, low[k]));
    }
    shadows.add(t, 0, 1, wide[0], wide[1]);
  }
  return shadows;
}

bool Columns::makeGrid(const Point3& low, const Point3& high, const Range& triangles, const Shadows& shadows,
                       bool finer)
{
  const double width = high[0] - low[0], height = high[1] - low[1], longest = std::max(width, height);
  const auto count = static_cast<double>(triangles.size());
  double most_entries =
      finer ? static_cast<double>(kFinerEntries) * count : static_cast<double>(mostEntries(triangles.size()));
  const double most_cells = finer ? static_cast<double>(kFinerCells) * count : count + 4096.0;
  const auto along = [](double length, double per) { return std::max(1.0, std::ceil(length * per)); };
  double per = perUnit(1.0, longest);
  const auto makeFiner = [&] {
    double cells = along(width, per) * along(height, per);
    for (int step = 0; per > 0.0 && step < 64; ++step) {
      const double next = per * 1.2, next_cells = along(width, next) * along(height, next);
      if (next_cells > most_cells || shadows.entries(next) > most_entries || next * longest > kMostColumns) break;
      per = next, cells = next_cells;
    }
    return cells;
  };
  if (makeFiner() < kFewColumns * count && !finer) {
    most_entries += static_cast<double>(moreEntries(triangles.size()));
    const double cells = makeFiner();
    const double most = 0.5 * shadows.entries(per) / cells;
    if (makeStrips(triangles, most) || makeBundles(triangles, most)) return true;
  }
  Grid grid;
  std::vector<std::uint32_t> ends;
  for (;; per *= 0.8) { // needles meet more columns than their shadows fill
    const double columns = along(width, per), rows = along(height, per);
    if (finer && shadows.entries(per) > 0.6 * count * columns * rows) return false;
    grid = {low[0], low[1], perUnit(columns, width), perUnit(rows, height), 0.0, 0, 0, 0};
    grid.columns = static_cast<std::uint32_t>(columns), grid.rows = static_cast<std::uint32_t>(rows);
    grid.pad = kCellPad * std::max(width / columns, height / rows);
    ends.assign(std::size_t{grid.columns} * grid.rows + 1, 0);
    double entries = 0.0;
    for (const std::uint32_t i : triangles) forEachCell(grid, i, [&](std::size_t cell) { ++ends[cell], ++entries; });
    if (entries <= 1.25 * most_entries || ends.size() <= 2) break;
  }
  grid.first = static_cast<std::uint32_t>(cells_.size());
  std::uint32_t begin = static_cast<std::uint32_t>(entries_.size()), sum = begin;
  for (std::uint32_t& n : ends) sum += std::exchange(n, sum);
  if (!finer) cells_.reserve(withRoom(ends.size())), entries_.reserve(withRoom(sum));
  entries_.reserveMore(sum - begin);
  entries_.resize(sum);
  for (const std::uint32_t i : triangles) forEachCell(grid, i, [&](std::size_t cell) { entries_[ends[cell]++] = i; });
  cells_.reserveMore(ends.size());
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) cells_.push({std::exchange(begin, ends[i]), ends[i]});
  grids_.push_back(grid);
  return true;
}

/// Brings entries into strips.
Columns::Cell Columns::inStrips(std::uint32_t begin, std::uint32_t count)
{
  std::uint32_t* const first = entries_.data() + begin;
  stripped_.push_back({begin, Strips(first, first + count, [this](std::uint32_t i) { return seenTriangle(i); })});
  return {Cell::kStrips, static_cast<std::uint32_t>(stripped_.size() - 1)};
}

/// Calls look(at) for places that are spread over all triangles.
template <class Look>
void Columns::sample(const Look& look) const
{
  for (std::uint32_t i = 0; i < kSampled; ++i)
    for (std::uint32_t j = 0; j < kSampled; ++j) {
      const auto at = [&](double step, std::size_t k) { return low_[k] + (high_[k] - low_[k]) * step / kSampled; };
      look({at(i + 0.37, 0), at(j + 0.73, 1), at((3 * i + 5 * j) % kSampled + 0.59, 2)}); // on no diagonal
    }
}

/// Makes bundles in place of all grids. @return false, and none are made, where a ray looks at more than `most`
/// triangles on the mean: few of them lie alike
bool Columns::makeBundles(const Range& triangles, double most)
{
  constexpr double kOfBundle = 1.5; // a look at one takes as long as at so many triangles
  std::uint32_t* const entries = entries_.append(triangles.size());
  std::copy(triangles.begin(), triangles.end(), entries);
  bundles_.emplace(
      entries, entries + triangles.size(), [this](std::uint32_t i) { return seenTriangle(i); }, boxes_.data());
  std::vector<std::uint32_t> found;
  std::uint64_t looked_at = 0;
  sample([&](const Point3& at) { bundles_->collect(entries, at, 0.0, found, looked_at); });
  const double cost = kOfBundle * static_cast<double>(looked_at) + static_cast<double>(found.size());
  if (cost <= most * kSampled * kSampled) return true;
  entries_.clear();
  bundles_.reset();
  return false;
}

/// Makes one column, in strips, in place of the first grid. @return false, and none is made, where a ray meets more
/// than `most` triangles on the mean: they lie in all directions
bool Columns::makeStrips(const Range& triangles, double most)
{
  std::copy(triangles.begin(), triangles.end(), entries_.append(triangles.size()));
  const Cell cell = inStrips(0, static_cast<std::uint32_t>(triangles.size()));
  std::vector<std::uint32_t> found;
  sample([&](const Point3& at) { stripped_[cell.end].strips.collect(entries_.data(), at, 0.0, found); });
  if (static_cast<double>(found.size()) > most * kSampled * kSampled) {
    entries_.clear();
    stripped_.clear();
    return false;
  }
  const double width = high_[0] - low_[0], height = high_[1] - low_[1];
  grids_.push_back(
      {low_[0], low_[1], perUnit(1.0, width), perUnit(1.0, height), kCellPad * std::max(width, height), 1, 1, 0});
  *cells_.append(1) = cell;
  return true;
}

/// Calls visit(i) for the columns of a grid that the triangle's shadow meets: of each row, those between its leftmost
/// and its rightmost place there.
template <class Visit>
void Columns::forEachCell(const Grid& grid, std::uint32_t triangle, const Visit& visit) const
{
  const FloatBox& box = boxes_[triangle];
  const auto column = [&](double x) { return cellAlong(x, grid.x, grid.per_x, grid.columns); };
  const auto row = [&](double y) { return cellAlong(y, grid.y, grid.per_y, grid.rows); };
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

/// Gives crowded columns finer grids, the most crowded first, as far as memory goes. Where there is no memory, or
/// triangles are too long for a finer grid, columns of more than kTooCrowded entries get strips.
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
  if (bundles_) return;
  note(0);
  std::vector<std::uint32_t> some;
  while (!crowded.empty()) {
    const auto [count, cell, index] = crowded.top();
    crowded.pop();
    const bool has_room =
        entries_.size() * sizeof(std::uint32_t) + cells_.size() * sizeof(Cell) + finer_bytes * count <= most;
    const Grid grid = grids_[index];
    const std::size_t place = cell - grid.first;
    const auto column = static_cast<double>(place % grid.columns), row = static_cast<double>(place / grid.columns);
    Point3 low = low_, high = high_;
    if (grid.per_x > 0.0) low[0] = grid.x + column / grid.per_x, high[0] = grid.x + (column + 1.0) / grid.per_x;
    if (grid.per_y > 0.0) low[1] = grid.y + row / grid.per_y, high[1] = grid.y + (row + 1.0) / grid.per_y;
    // Finer than what double arithmetic tells apart at the largest coordinate is of no use.
    const bool is_wide = std::max(high[0] - low[0], high[1] - low[1]) * kCellPad * kCellPad > error_;
    some.assign(entries_.begin() + cells_[cell].begin, entries_.begin() + cells_[cell].end);
    const Range range{some.data(), some.data() + some.size()};
    if (!has_room || !is_wide || !makeGrid(low, high, range, shadowsWithin(low, high, range), true)) {
      if (count > kTooCrowded) cells_[cell] = inStrips(cells_[cell].begin, count);
      continue;
    }
    const auto finer = static_cast<std::uint32_t>(grids_.size() - 1);
    cells_[cell] = {Cell::kGrid, finer};
    note(finer);
  }
}

void Columns::collect(std::uint32_t index, const Point3& at, double error, std::vector<std::uint32_t>& found) const
{
  const Grid& grid = grids_[index];
  const std::uint32_t left = cellAlong(at[0] - error, grid.x, grid.per_x, grid.columns),
                      right = cellAlong(at[0] + error, grid.x, grid.per_x, grid.columns);
  const std::uint32_t bottom = cellAlong(at[1] - error, grid.y, grid.per_y, grid.rows),
                      top = cellAlong(at[1] + error, grid.y, grid.per_y, grid.rows);
  for (std::uint32_t j = bottom; j <= top; ++j)
    for (std::uint32_t i = left; i <= right; ++i) {
      const Cell& cell = cells_[grid.first + std::size_t{j} * grid.columns + i];
      if (cell.begin == Cell::kGrid)
        collect(cell.end, at, error, found);
      else if (cell.begin == Cell::kStrips)
        stripped_[cell.end].strips.collect(entries_.data() + stripped_[cell.end].begin, at, error, found);
      else
        found.insert(found.end(), entries_.begin() + cell.begin, entries_.begin() + cell.end);
    }
}

Columns::Range Columns::above(const Point3& at, double error, std::vector<std::uint32_t>& several) const
{
  if (bundles_) {
    several.clear();
    std::uint64_t bundles = 0;
    const int turns = bundles_->collect(entries_.data(), at, error, several, bundles);
    return {several.data(), several.data() + several.size(), turns, bundles};
  }
  for (std::uint32_t index = 0;;) {
    const Grid& grid = grids_[index];
    if (!(error <= grid.pad)) break;
    const Cell& cell = cells_[grid.first + std::size_t{cellAlong(at[1], grid.y, grid.per_y, grid.rows)} * grid.columns +
                              cellAlong(at[0], grid.x, grid.per_x, grid.columns)];
    if (cell.begin == Cell::kStrips) {
      several.clear();
      stripped_[cell.end].strips.collect(entries_.data() + stripped_[cell.end].begin, at, error, several);
      return {several.data(), several.data() + several.size()};
    }
    if (cell.begin != Cell::kGrid) return {entries_.data() + cell.begin, entries_.data() + cell.end};
    index = cell.end;
  }
  several.clear();
  collect(0, at, error, several);
  std::sort(several.begin(), several.end());
  several.erase(std::unique(several.begin(), several.end()), several.end());
  return {several.data(), several.data() + several.size()};
}

std::size_t Columns::bytes() const noexcept
{
  std::size_t strips = stripped_.capacity() * sizeof(Stripped);
  for (const Stripped& of : stripped_) strips += of.strips.bytes();
  return strips + (bundles_ ? bundles_->bytes() : 0) + boxes_.bytes() + grids_.capacity() * sizeof(Grid) +
         cells_.bytes() + entries_.bytes() + cubes_.bytes();
}

} // namespace pcl_bsh
