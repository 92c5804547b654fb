// SPDX-License-Identifier: BSD-3-Clause
// The directions of a scan that are not between beams, in cells.
#pragma once

#include <pcl_bsh/seen/beam_tree.h>
#include <pcl_bsh/seen/direction_cells.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

class HoleMap {
public:
  /// @param angle as SeenOptions has it; 0: nothing is looked at
  HoleMap(const BeamTree& beams, double angle, unsigned threads);

  /// Whether a hole shares a direction with the cone. @param tested counts the cells looked at
  bool meets(const Cone& cone, std::uint64_t& tested) const;

  bool hasAny() const { return has_any_; } ///< whether there is a hole in any direction

private:
  static constexpr unsigned kTileLevels = 6; ///< a tile has 64 x 64 cells

  /// Entries that say a cell's state instead of naming a node or a tile.
  static constexpr std::uint32_t kCovered = 0xfffffffeu, kHole = 0xffffffffu;

  using Tile = std::array<std::uint64_t, 64>; ///< rows along u; 1: a hole
  struct Tree {
    DirectionCell cell{};
    CellSphere sphere{};
    std::uint32_t root = kHole;
    std::vector<std::array<std::uint32_t, 4>> nodes;
    std::vector<Tile> tiles;
  };

  /// The smallest cells from (u, w) to (u_last, w_last) of a face.
  struct Block {
    std::size_t face;
    std::uint32_t u, w, u_last, w_last;
  };

  std::uint32_t make(Tree& tree, const DirectionCell& cell) const;
  std::uint32_t makeTile(Tree& tree, const DirectionCell& cell, const CellSphere& sphere) const;
  bool meets(const Tree& tree, std::uint32_t what, const DirectionCell& cell, const Cone& cone,
             std::uint64_t& tested) const;
  std::optional<Block> blockAround(const Cone& cone) const;
  bool meets(const Block& block, const Cone& cone, std::uint64_t& tested) const;
  bool meetsTile(const Tile& tile, const DirectionCell& part, const Block& block, const Cone& cone,
                 std::uint64_t& tested) const;

  const BeamTree* beams_ = nullptr; ///< while it is built
  double angle_;                    ///< cellAngle()
  unsigned levels_;
  unsigned root_level_;     ///< of the trees' cells; trees are built in parallel
  std::vector<Tree> trees_; ///< of the cells of that level, face by face and row by row
  bool has_any_ = false;
};

} // namespace pcl_bsh
