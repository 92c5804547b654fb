// SPDX-License-Identifier: BSD-3-Clause
// Chooses the tiles of a site that are drawn for an eye, within a budget of points. Does not read or draw them.
//
//   TileChoice choice(site, budget);
//   choice.look(eye);
//   for (const std::size_t tile : choice.superfluous()) choice.drop(tile);
//   while (const std::optional<std::size_t> tile = choice.next()) choice.hold(*tile);
#pragma once

#include <pcl_bsh/site/site.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::viewer {

struct Eye {
  Point3 place = {};
  /// The eye sees the positive side of each: a x + b y + c z + d > 0. None: all is seen.
  std::vector<std::array<double, 4>> planes;
};

/// The tiles that an eye sees, the nearest first, as many as the budget holds: the first that does not fit ends the
/// list. The rest of the budget keeps tiles which are held and no longer seen. A tile that is held counts as nearer
/// than it is, so that small moves of the eye change nothing.
class TileChoice {
public:
  /// @param budget points that held tiles have together at most; a tile of more is never wanted
  TileChoice(const site::Site& site, std::uint64_t budget);

  /// Chooses the wanted tiles anew.
  void look(const Eye& eye);

  std::vector<std::size_t> superfluous() const; ///< held, not wanted: to be dropped before another is held
  std::optional<std::size_t> next() const;      ///< the nearest that is wanted and not held

  void hold(std::size_t tile);
  void drop(std::size_t tile);
  void giveUp(std::size_t tile); ///< it cannot be read: not wanted any more

  std::size_t wanted() const { return wanted_.size(); }
  std::size_t held() const { return held_; }
  std::uint64_t heldPoints() const { return held_points_; }

private:
  enum class State : std::uint8_t { away, held, lost };

  /// The order in which tiles are wanted.
  struct Rank {
    bool is_hidden;
    double distance, to_middle;
    std::size_t tile;

    auto operator<=>(const Rank&) const = default;
  };

  std::optional<Rank> rankOf(std::size_t tile, const Eye& eye) const;

  std::vector<site::Tile> tiles_;
  std::uint64_t budget_;
  std::vector<State> states_;
  std::vector<std::size_t> wanted_; ///< the nearest first
  std::size_t held_ = 0;
  std::uint64_t held_points_ = 0;
};

} // namespace pcl_bsh::viewer
