// SPDX-License-Identifier: BSD-3-Clause
// One question about tiles of a site.
#pragma once

#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/answers/question_part.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>
#include <pcl_bsh/site/tiles/tile_visitor.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace pcl_bsh::site {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Joins the flags of points with those against another tile: a point that collides with a tile collides, and a point
/// is free only if all tiles leave it free.
inline void join(std::vector<Verdict>& flags, const std::vector<Verdict>& of_other)
{
  std::transform(flags.begin(), flags.end(), of_other.begin(), flags.begin(), graver);
}

/// Returns the request for each tile.
template <typename Wanted>
Wanted wantedOf(const Question& question)
{
  Wanted wanted;
  if constexpr (requires { wanted.clearance; }) wanted.clearance = question.clearance.value_or(0.0);
  wanted.accuracy = question.accuracy;
  wanted.threads = question.threads;
  return wanted;
}

/// Returns the verdict of all tiles.
/// @param collides equal on all ranks. @param is_undecided whether a tile of this rank is undecided
inline Verdict verdictOfAllRanks(bool collides, bool is_undecided)
{
  const bool none_is_sure = sumOfAllRanks(is_undecided ? 1 : 0) > 0;
  if (collides) return Verdict::colliding;
  return none_is_sure ? Verdict::undecided : Verdict::free;
}

class TileQuery {
public:
  /// @param visited whose tiles are asked about. @throws as requireUncertainty() and TileVisitor do
  TileQuery(const QuestionPart& part, const PlacedSite& visited)
  : part_(part),
    visited_(visited),
    visitor_(visited.site, part.means.memory)
  {
    requireUncertainty(visited.site, visited.uncertainty);
  }

  /// Calls ask(tile, cloud, its hierarchy) for each of the first of these tiles, on one of the ranks.
  /// @param go_on as that of TileVisitor::visitInTurn()
  template <typename Ask>
  TilesRead visit(const std::vector<std::uint32_t>& tiles, const Ask& ask,
                  const std::function<bool(std::size_t)>& go_on)
  {
    visitor_.visitInTurn(tiles, use(ask, tiles.size()), go_on);
    return readOf(tiles.size());
  }

  /// Calls find() for all of these tiles, and add() with the numbers that it returns. Tiles whose numbers an earlier
  /// run has kept are not asked about: add() gets these numbers on the first rank.
  /// @param find called with (tile, cloud, its hierarchy): calls the receiver, and returns the tile's numbers
  /// @param add called with the numbers
  /// @param runs whether tiles that follow each other are better asked about on one rank
  /// @param still as that of TileVisitor::visitAll()
  template <typename Find, typename Add>
  TilesRead visitAndAdd(const std::vector<std::uint32_t>& tiles, const Find& find, const Add& add, bool runs = false,
                        const std::function<bool(std::uint32_t)>& still = nullptr)
  {
    TileAnswers* const answers = part_.means.answers;
    std::vector<std::uint32_t> left;
    for (const std::uint32_t tile : tiles) {
      const std::vector<double>* const known = answers ? answers->known(tile) : nullptr;
      if (known == nullptr)
        left.push_back(tile);
      else if (rankHere() == 0)
        add(*known);
    }
    const auto ask = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
      const std::vector<double> numbers = find(tile, cloud, hierarchy);
      add(numbers);
      if (answers) answers->keep(static_cast<std::size_t>(&tile - visited_.site.tiles.data()), numbers);
    };
    constexpr std::size_t runs_of_rank = 4; // enough for quick ranks to relieve slow ones
    const std::size_t run = left.size() / (runs_of_rank * static_cast<std::size_t>(ranks()));
    visitor_.visitAll(left, use(ask, left.size()), runs ? std::max<std::size_t>(run, 1) : 1, still);
    return readOf(tiles.size());
  }

  /// The memory that the largest tile leaves.
  std::uint64_t bytesLeft() const noexcept { return part_.means.memory - visitor_.bytesForLargest(); }

  /// How hierarchies of tiles are built.
  HierarchyOptions building() const
  {
    HierarchyOptions options;
    options.threads = part_.question.threads;
    return options;
  }

  /// The points of a tile, or of a part of it, with their uncertainties.
  static PointsView pointsOf(const pcl::PCLPointCloud2& cloud, const Site& site, const Tile& tile,
                             const Uncertainty& uncertainty)
  {
    return withUncertainty(viewOf(cloud), cloud.fields, (site.folder / tile.file).string(), uncertainty);
  }

private:
  template <typename Ask>
  TileVisitor::Use use(const Ask& ask, std::size_t tiles)
  {
    return [this, &ask, tiles](const Tile& tile, const pcl::PCLPointCloud2& cloud) {
      ask(tile, cloud, SphereHierarchy(pointsOf(cloud, visited_.site, tile, visited_.uncertainty), building()));
      const double done = static_cast<double>(visitor_.place() + 1) / static_cast<double>(tiles);
      progress_.tellWhole(done);
    };
  }

  /// To be called by all ranks, after the visit.
  TilesRead readOf(std::size_t needed) const
  {
    TilesRead found{visited_.site.tiles.size(), needed, sumOfAllRanks(visitor_.read()),
                    gatheredFromAllRanks(visitor_.costs())};
    std::sort(found.costs.begin(), found.costs.end(), [](const auto& c, const auto& d) { return c.place < d.place; });
    return found;
  }

  const QuestionPart& part_;
  const PlacedSite visited_;
  Progress progress_{part_.question.progress};
  TileVisitor visitor_;
};

} // namespace pcl_bsh::site
