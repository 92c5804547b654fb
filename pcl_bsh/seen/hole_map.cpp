// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/hole_map.h>

#include <pcl_bsh/base/parallel.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

/// Cells of a row whose middles are within a beam's angle: [first, last], none where first > last.
struct MiddleRange {
  int first = 1, last = 0;
};

/// Bits [first, last), 0 <= first, last <= 64.
std::uint64_t bitsBetween(int first, int last)
{
  if (first >= last) return 0;
  const std::uint64_t up_to = last == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << last) - 1;
  return up_to & ~((std::uint64_t{1} << first) - 1);
}

using Sides = std::array<std::uint64_t, kBeamSides>;

/// Tells on which sides of each cell of a tile a beam lies (direction_cells.h).
class BeamSides {
public:
  /// @param x, y where the beam meets the tile's face. @param off how far beside a cell it must be. All in edges of a
  ///   cell
  BeamSides(double x, double y, double off)
  : east_(static_cast<int>(std::floor(x - off))),
    west_(static_cast<int>(std::ceil(x + off))),
    north_(static_cast<int>(std::floor(y - off))),
    south_(static_cast<int>(std::ceil(y + off))),
    southeast_(static_cast<int>(std::floor(x - y - 2.0 * off))),
    northwest_(static_cast<int>(std::ceil(x - y + 2.0 * off))),
    northeast_(static_cast<int>(std::floor(x + y - 2.0 * off))),
    southwest_(static_cast<int>(std::ceil(x + y + 2.0 * off)))
  {
  }

  /// Adds the beam to its sides of these cells of one row.
  void add(int row, std::uint64_t cells, Sides& sides) const
  {
    const std::array<std::uint64_t, kBeamSides> half_planes = {
        row < north_ ? cells : 0,  from(northwest_ + row + 1) & cells,
        from(west_) & cells,       from(southwest_ - row) & cells,
        row >= south_ ? cells : 0, upTo(southeast_ + row) & cells,
        upTo(east_) & cells,       upTo(northeast_ - row - 1) & cells};
    for (std::size_t i = 0; i < kBeamSides; ++i) sides[i] |= half_planes[i] & half_planes[(i + 7) % kBeamSides];
  }

private:
  static std::uint64_t upTo(int last) { return bitsBetween(0, std::clamp(last, 0, 64)); }
  static std::uint64_t from(int first) { return bitsBetween(std::clamp(first, 0, 64), 64); }

  int east_, west_, north_, south_, southeast_, northwest_, northeast_, southwest_;
};

/// The middles of a tile's cells: 64 x 64 places of a face.
class TileMiddles {
public:
  TileMiddles(const DirectionCell& tile, unsigned cell_level)
  : face_(tile.face),
    edge_(std::ldexp(2.0, -static_cast<int>(cell_level))),
    u0_(-1.0 + 64.0 * edge_ * tile.u),
    w0_(-1.0 + 64.0 * edge_ * tile.w)
  {
  }

  /// Rows that may have a middle within a beam's angle.
  MiddleRange rows(const Eigen::Vector3d& beam, double sine) const
  {
    const Place d = placeOf(beam);
    return within(d.w, d.up, 1.0, 1.0 - sine * sine - d.u * d.u, w0_, true);
  }

  /// The range of one row.
  MiddleRange row(int row, const Eigen::Vector3d& beam, double sine) const
  {
    const Place d = placeOf(beam);
    const double w = w0_ + edge_ * (row + 0.5);
    return within(d.u, d.w * w + d.up, w * w + 1.0, 1.0 - sine * sine, u0_, false);
  }

  /// On which sides of the cells a beam lies. @pre it is less than a quarter turn from the middle of the face
  BeamSides sidesOf(const Eigen::Vector3d& beam) const
  {
    const Place d = placeOf(beam);
    return {(d.u / d.up - u0_) / edge_, (d.w / d.up - w0_) / edge_, kBesideCell / edge_};
  }

private:
  struct Place {
    double u, w, up;
  };

  Place placeOf(const Eigen::Vector3d& d) const
  {
    const auto axis = static_cast<Eigen::Index>(face_ / 2);
    return {d[(axis + 1) % 3], d[(axis + 2) % 3], face_ % 2 == 0 ? d[axis] : -d[axis]};
  }

  /// Middles x with du x + k >= sqrt(share (x^2 + m)): all between two roots. With `outward` one more on either side.
  MiddleRange within(double du, double k, double m, double share, double x0, bool outward) const
  {
    const double q = share - du * du; // > 0 of each beam that is within the angle of a place of the face
    const double under = k * k - m * q;
    if (!(q > 0.0 && under >= 0.0)) return {};
    const double middle = du * k / q, half = std::sqrt(share * under) / q;
    if (du * middle + k <= 0.0) return {};
    const double from = (middle - half - x0) / edge_ - 0.5, to = (middle + half - x0) / edge_ - 0.5;
    if (!(to >= -1.0 && from <= 64.0)) return {};
    const double first = outward ? std::floor(from) - 1.0 : std::ceil(from), last = outward ? to + 1.0 : std::floor(to);
    return {static_cast<int>(std::clamp(first, 0.0, 64.0)), static_cast<int>(std::clamp(last, -1.0, 63.0))};
  }

  std::size_t face_;
  double edge_, u0_, w0_;
};

} // namespace

HoleMap::HoleMap(const BeamTree& beams, double angle, unsigned threads)
: beams_(&beams),
  angle_(cellAngle(angle)),
  levels_(angle == 0.0 ? kTileLevels : cellLevels(angle)),
  root_level_(std::min(2u, levels_ - kTileLevels))
{
  if (angle == 0.0) return;
  const std::size_t edge = std::size_t{1} << root_level_;
  trees_.resize(kCubeFaces * edge * edge);
  parallelFor(trees_.size(), threads, [&](std::size_t i) {
    trees_[i].cell = {i / (edge * edge), root_level_, static_cast<std::uint32_t>(i % edge),
                      static_cast<std::uint32_t>(i / edge % edge)};
    trees_[i].sphere = CellSphere(trees_[i].cell);
    trees_[i].root = make(trees_[i], trees_[i].cell);
  });
  has_any_ = std::any_of(trees_.begin(), trees_.end(), [](const Tree& tree) { return tree.root != kCovered; });
  beams_ = nullptr;
}

std::uint32_t HoleMap::make(Tree& tree, const DirectionCell& cell) const
{
  const CellSphere sphere(cell);
  const double chord = sphere.chord + chordOf(angle_) + kDirectionError;
  const bool has_beam = beams_->any([&](const BeamNode& node) { return !areDisjoint(sphere.center, chord, node); },
                                    [&](const Beam& beam) { return !isBeyond(sphere.center, chord, beam); });
  if (!has_beam) return kHole;
  if (cell.level + kTileLevels == levels_) return makeTile(tree, cell, sphere);
  std::array<std::uint32_t, 4> quarters;
  for (std::uint32_t q = 0; q < 4; ++q) quarters[q] = make(tree, cell.quarter(q));
  const bool alike = std::all_of(quarters.begin(), quarters.end(), [&](std::uint32_t q) { return q == quarters[0]; });
  if (alike && quarters[0] >= kCovered) return quarters[0];
  tree.nodes.push_back(quarters);
  return static_cast<std::uint32_t>(tree.nodes.size() - 1);
}

std::uint32_t HoleMap::makeTile(Tree& tree, const DirectionCell& cell, const CellSphere& sphere) const
{
  std::array<Sides, 64> sides{}; // of each row
  const TileMiddles middles(cell, levels_);
  const double sine = std::sin(angle_), chord = sphere.chord + chordOf(angle_) + kDirectionError;
  beams_->any([&](const BeamNode& node) { return !areDisjoint(sphere.center, chord, node); },
              [&](const Beam& beam) {
                if (isBeyond(sphere.center, chord, beam)) return false;
                const Eigen::Vector3d direction = beam.direction();
                const MiddleRange rows = middles.rows(direction, sine);
                if (rows.first > rows.last) return false;
                const BeamSides beside = middles.sidesOf(direction);
                for (int row = rows.first; row <= rows.last; ++row) {
                  const MiddleRange near = middles.row(row, direction, sine);
                  beside.add(row, bitsBetween(near.first, near.last + 1), sides[static_cast<std::size_t>(row)]);
                }
                return false;
              });
  Tile holes{};
  std::uint64_t any = 0, all = ~std::uint64_t{0};
  for (std::size_t row = 0; row < holes.size(); ++row) {
    std::uint64_t covered = ~std::uint64_t{0};
    for (const std::uint64_t side : sides[row]) covered &= side;
    any |= covered;
    all &= covered;
    holes[row] = ~covered;
  }
  if (any == 0) return kHole;
  if (all == ~std::uint64_t{0}) return kCovered;
  tree.tiles.push_back(holes);
  return static_cast<std::uint32_t>(tree.tiles.size() - 1);
}

bool HoleMap::meets(const Cone& cone, std::uint64_t& tested) const
{
  if (!has_any_) return false;
  if (const std::optional<Block> block = blockAround(cone)) return meets(*block, cone, tested);
  return std::any_of(trees_.begin(), trees_.end(), [&](const Tree& tree) {
    ++tested;
    return !cone.isApartFrom(tree.sphere) && meets(tree, tree.root, tree.cell, cone, tested);
  });
}

/// Returns cells that hold all directions of a cone. Returns nothing where they are on several faces, or more than 64
/// are side by side.
std::optional<HoleMap::Block> HoleMap::blockAround(const Cone& cone) const
{
  constexpr double slack = 0x1p-30;
  const double up = cone.direction.cwiseAbs().maxCoeff(), share = up * up - cone.sine * cone.sine;
  if (!(share > 0.0)) return std::nullopt; // some directions do not meet the plane of the face
  // Planes through an axis of the face touch the cone at two places u: (u up - along)^2 = sine^2 (1 + u^2).
  const auto range = [&](double place, std::uint32_t& first, std::uint32_t& last) {
    const double along = place * up, cells = static_cast<double>(std::uint64_t{1} << (levels_ - 1));
    const double middle = along * up / share, half = cone.sine * std::sqrt(along * along + share) / share + slack;
    if (!(std::abs(middle) + half < 1.0)) return false;
    first = static_cast<std::uint32_t>((middle - half + 1.0) * cells);
    last = static_cast<std::uint32_t>((middle + half + 1.0) * cells);
    return last - first < 64;
  };
  const FacePlace place = facePlaceOf(cone.direction);
  Block block{place.face, 0, 0, 0, 0};
  if (!range(place.u, block.u, block.u_last) || !range(place.w, block.w, block.w_last)) return std::nullopt;
  return block;
}

bool HoleMap::meets(const Block& block, const Cone& cone, std::uint64_t& tested) const
{
  const std::uint32_t trees = 1u << root_level_; // of a face, along an edge
  const unsigned tile_level = levels_ - kTileLevels, below_root = tile_level - root_level_;
  for (std::uint32_t w = block.w >> kTileLevels; w <= block.w_last >> kTileLevels; ++w)
    for (std::uint32_t u = block.u >> kTileLevels; u <= block.u_last >> kTileLevels; ++u) {
      const Tree& tree = trees_[(block.face * trees + (w >> below_root)) * trees + (u >> below_root)];
      std::uint32_t what = tree.root;
      for (unsigned below = below_root; below > 0 && what < kCovered; --below)
        what = tree.nodes[what][(u >> (below - 1) & 1) | (w >> (below - 1) & 1) << 1];
      ++tested;
      if (what == kCovered) continue;
      const DirectionCell cell{block.face, tile_level, u, w};
      if (what == kHole ? cone.meets(cell) : meetsTile(tree.tiles[what], cell, block, cone, tested)) return true;
    }
  return false;
}

bool HoleMap::meets(const Tree& tree, std::uint32_t what, const DirectionCell& cell, const Cone& cone,
                    std::uint64_t& tested) const
{
  if (what == kCovered) return false;
  if (cell.level > root_level_) {
    ++tested;
    if (cone.isApartFrom(CellSphere(cell))) return false;
  }
  if (what == kHole) return cone.meets(cell);
  if (cell.level + kTileLevels == levels_) {
    constexpr std::uint32_t last = ~std::uint32_t{0};
    return meetsTile(tree.tiles[what], cell, {cell.face, 0, 0, last, last}, cone, tested);
  }
  for (std::uint32_t q = 0; q < 4; ++q)
    if (meets(tree, tree.nodes[what][q], cell.quarter(q), cone, tested)) return true;
  return false;
}

/// @param block holds the cone, or the face
bool HoleMap::meetsTile(const Tile& tile, const DirectionCell& part, const Block& block, const Cone& cone,
                        std::uint64_t& tested) const
{
  const unsigned below = levels_ - part.level;
  const std::uint32_t u = part.u << below, w = part.w << below, more = (1u << below) - 1;
  const std::uint32_t first = std::max(u, block.u), last = std::min(u + more, block.u_last);
  if (first > last) return false;
  const std::uint64_t columns = bitsBetween(static_cast<int>(first & 63), static_cast<int>(last & 63) + 1);
  std::uint64_t any = 0, all = columns;
  for (std::uint32_t row = std::max(w, block.w); row <= std::min(w + more, block.w_last); ++row) {
    any |= tile[row & 63] & columns;
    all &= tile[row & 63];
  }
  if (any == 0) return false;
  ++tested;
  if (cone.isApartFrom(CellSphere(part))) return false;
  if (all == columns) return cone.meets(part);
  for (std::uint32_t q = 0; q < 4; ++q)
    if (meetsTile(tile, part.quarter(q), block, cone, tested)) return true;
  return false;
}

} // namespace pcl_bsh
