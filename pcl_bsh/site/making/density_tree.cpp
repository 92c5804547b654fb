// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/making/density_tree.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_bsh::site {

namespace {

constexpr std::uint64_t cells_in_tile = 64;
constexpr int least_exponent = -1000; ///< of an octree's edge
constexpr double farthest = 0x1p1000; ///< greater magnitudes are counted as this one

bool holds(const Point3& corner, double edge, const Point3& point)
{
  for (std::size_t k = 0; k < 3; ++k)
    if (point[k] < corner[k] || point[k] - corner[k] >= edge) return false;
  return true;
}

} // namespace

DensityTree::DensityTree(std::uint64_t tile_points)
: tile_points_(tile_points),
  most_in_cell_(std::max<std::uint64_t>(tile_points / cells_in_tile, 1))
{
}

std::uint32_t DensityTree::addCell()
{
  cells_.emplace_back();
  return static_cast<std::uint32_t>(cells_.size() - 1);
}

DensityTree::Octree& DensityTree::octreeOf(const Point3& point, Point3& magnitudes)
{
  std::size_t octant = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (point[k] < 0.0) octant |= std::size_t{1} << k;
    magnitudes[k] = std::min(std::abs(point[k]), farthest);
  }
  return octrees_[octant];
}

/// Makes the root so large that it holds the point.
void DensityTree::grow(Octree& tree, const Point3& magnitudes)
{
  int exponent = least_exponent;
  for (const double coordinate : magnitudes) {
    int needed = 0;
    std::frexp(coordinate, &needed); // coordinate < 2^needed
    if (coordinate > 0.0) exponent = std::max(exponent, needed);
  }
  if (tree.root == none) {
    tree.root = addCell();
    tree.exponent = exponent;
  }
  for (; tree.exponent < exponent; ++tree.exponent) {
    const std::uint32_t root = addCell();
    cells_[root].part[0] = tree.root;
    cells_[root].is_divided = true;
    tree.root = root;
  }
}

std::size_t DensityTree::partOf(const Place& place, const Point3& magnitudes)
{
  std::size_t part = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (magnitudes[k] >= place.corner[k] + place.edge / 2) part |= std::size_t{1} << k;
  return part;
}

DensityTree::Place DensityTree::step(const Place& place, std::size_t part)
{
  Place below = {cells_[place.cell].part[part], place.corner, place.edge / 2};
  for (std::size_t k = 0; k < 3; ++k)
    if ((part >> k & 1) != 0) below.corner[k] += below.edge;
  return below;
}

/// Divides a cell. Where all of its points lie in one part, their count moves there. Else the cell keeps the count, as
/// it is not known which parts they lie in.
void DensityTree::divide(const Place& place)
{
  cells_[place.cell].is_divided = true;
  const std::size_t part = partOf(place, cells_[place.cell].low);
  if (part != partOf(place, cells_[place.cell].high)) return;
  const std::uint32_t below = addCell();
  Cell& cell = cells_[place.cell];
  cells_[below].own = cell.own;
  cells_[below].low = cell.low;
  cells_[below].high = cell.high;
  cell.own = 0;
  cell.part[part] = below;
}

void DensityTree::add(const Point3& point)
{
  Point3 p;
  Octree& tree = octreeOf(point, p);
  Place place = tree.last;
  if (place.cell == none || !holds(place.corner, place.edge, p)) {
    grow(tree, p);
    place = {tree.root, {}, std::ldexp(1.0, tree.exponent)};
  }
  for (;;) {
    if (!cells_[place.cell].is_divided) {
      Cell& cell = cells_[place.cell];
      const bool at_one_place = cell.own > 0 && cell.low == cell.high && cell.low == p;
      if (cell.own < most_in_cell_ || at_one_place || place.edge < std::ldexp(1.0, tree.exponent - 50)) {
        if (cell.own == 0) cell.low = cell.high = p;
        for (std::size_t k = 0; k < 3; ++k) {
          cell.low[k] = std::min(cell.low[k], p[k]);
          cell.high[k] = std::max(cell.high[k], p[k]);
        }
        ++cell.own;
        tree.last = place;
        return;
      }
      divide(place);
    }
    const std::size_t part = partOf(place, p);
    if (cells_[place.cell].part[part] == none) {
      const std::uint32_t below = addCell();
      cells_[place.cell].part[part] = below;
    }
    place = step(place, part);
  }
}

/// Collects the undivided cells of an octree, also the empty ones: a point counted in a cell above may lie there.
void DensityTree::collect(std::size_t octant, const Place& place, std::uint32_t above, std::uint64_t most_above,
                          Undivided& all)
{
  const auto signedPoint = [&](Point3 magnitudes) {
    for (std::size_t k = 0; k < 3; ++k)
      if ((octant >> k & 1) != 0) magnitudes[k] = -magnitudes[k];
    return magnitudes;
  };
  const Cell cell = cells_[place.cell];
  if (!cell.is_divided) {
    Point3 middle;
    for (std::size_t k = 0; k < 3; ++k)
      middle[k] = cell.own > 0 ? cell.low[k] / 2 + cell.high[k] / 2 : place.corner[k] + place.edge / 2;
    all.cells.push_back(place.cell);
    all.voxels.push_back({signedPoint(middle), cell.own, above, most_above});
    return;
  }
  all.above.push_back({cell.own, above});
  above = static_cast<std::uint32_t>(all.above.size() - 1);
  for (std::size_t part = 0; part < 8; ++part) {
    if (cells_[place.cell].part[part] == none) {
      const std::uint32_t below = addCell();
      cells_[place.cell].part[part] = below;
    }
    collect(octant, step(place, part), above, most_above + cell.own, all);
  }
}

/// Makes a divided cell undivided again where all of its parts are of one tile.
void DensityTree::simplify(std::uint32_t number)
{
  Cell& cell = cells_[number];
  if (!cell.is_divided) return;
  for (const std::uint32_t part : cell.part) simplify(part);
  const Cell& first = cells_[cell.part[0]];
  const bool is_one = std::all_of(cell.part.begin(), cell.part.end(), [&](std::uint32_t part) {
    return !cells_[part].is_divided && cells_[part].tile == first.tile;
  });
  if (!is_one) return;
  cell.is_divided = false;
  cell.tile = first.tile;
}

std::uint32_t DensityTree::plan()
{
  Undivided all;
  for (std::size_t octant = 0; octant < octrees_.size(); ++octant) {
    Octree& tree = octrees_[octant];
    tree.last = {none, {}, 0.0};
    if (tree.root != none) collect(octant, {tree.root, {}, std::ldexp(1.0, tree.exponent)}, DividedVoxel::none, 0, all);
  }
  const std::vector<std::uint32_t> tiles = tilesOf(all.voxels, all.above, tile_points_);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    cells_[all.cells[i]].tile = tiles[i];
    tiles_ = std::max(tiles_, tiles[i] + 1);
  }
  for (const Octree& tree : octrees_)
    if (tree.root != none) simplify(tree.root);
  return tiles_;
}

std::vector<std::uint32_t> DensityTree::planned() const
{
  std::vector<std::uint32_t> numbers = {tiles_};
  for (const Octree& tree : octrees_)
    numbers.insert(numbers.end(), {tree.root, static_cast<std::uint32_t>(tree.exponent - least_exponent)});
  for (const Cell& cell : cells_) {
    numbers.insert(numbers.end(), cell.part.begin(), cell.part.end());
    numbers.insert(numbers.end(), {cell.tile, cell.is_divided ? 1u : 0u});
  }
  return numbers;
}

DensityTree DensityTree::fromPlanned(const std::vector<std::uint32_t>& numbers)
{
  constexpr std::size_t head = 1 + 2 * 8, per_cell = 8 + 2;
  const auto require = [](bool is_right) {
    if (!is_right) throw std::invalid_argument("these are not the numbers of a plan");
  };
  require(numbers.size() >= head && (numbers.size() - head) % per_cell == 0);
  DensityTree tree(1);
  tree.tiles_ = numbers[0];
  tree.cells_.resize((numbers.size() - head) / per_cell);
  const std::size_t cells = tree.cells_.size();
  for (std::size_t i = 0; i < 8; ++i) {
    tree.octrees_[i].root = numbers[1 + 2 * i];
    tree.octrees_[i].exponent = static_cast<int>(numbers[2 + 2 * i]) + least_exponent;
    require(tree.octrees_[i].root == none || tree.octrees_[i].root < cells);
  }
  auto number = numbers.begin() + head;
  for (Cell& cell : tree.cells_) {
    for (std::uint32_t& part : cell.part) part = *number++;
    cell.tile = *number++;
    cell.is_divided = *number++ != 0;
    for (const std::uint32_t part : cell.part) require(part < cells || part == none);
  }
  return tree;
}

std::uint32_t DensityTree::tileOf(const Point3& point)
{
  Point3 p;
  Octree& tree = octreeOf(point, p);
  Place place = tree.last;
  if (place.cell == none || !holds(place.corner, place.edge, p)) {
    if (tree.root == none) return 0; // no point was counted in the octree
    place = {tree.root, {}, std::ldexp(1.0, tree.exponent)};
    while (cells_[place.cell].is_divided) place = step(place, partOf(place, p));
    tree.last = place;
  }
  return cells_[place.cell].tile;
}

} // namespace pcl_bsh::site
