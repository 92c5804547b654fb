// SPDX-License-Identifier: BSD-3-Clause
#include "tile_choice.h"

#include <algorithm>
#include <cmath>

namespace pcl_bsh::viewer {
namespace {

constexpr double nearer_where_held = 0.8;

/// Whether some of the box may lie on the positive side of all planes, not only on them: where the sides of the eye's
/// pyramid meet, they touch boxes behind the eye.
bool isSeen(const site::Bounds& box, const Eye& eye)
{
  return std::all_of(eye.planes.begin(), eye.planes.end(), [&box](const std::array<double, 4>& plane) {
    double most = plane[3];
    for (std::size_t k = 0; k < 3; ++k) most += plane[k] * (plane[k] >= 0.0 ? box.high[k] : box.low[k]);
    return most > 0.0;
  });
}

double distanceTo(const site::Bounds& box, const Point3& place)
{
  Point3 nearest = place;
  for (std::size_t k = 0; k < 3; ++k) nearest[k] = std::clamp(place[k], box.low[k], box.high[k]);
  return std::hypot(nearest[0] - place[0], nearest[1] - place[1], nearest[2] - place[2]);
}

double distanceToMiddle(const site::Bounds& box, const Point3& place)
{
  const auto along = [&](std::size_t k) { return 0.5 * box.low[k] + 0.5 * box.high[k] - place[k]; };
  return std::hypot(along(0), along(1), along(2));
}

} // namespace

TileChoice::TileChoice(const site::Site& site, std::uint64_t budget)
: tiles_(site.tiles),
  budget_(budget),
  states_(tiles_.size(), State::away)
{
}

std::optional<TileChoice::Rank> TileChoice::rankOf(std::size_t tile, const Eye& eye) const
{
  const site::Tile& is = tiles_[tile];
  const bool held = states_[tile] == State::held;
  if (!is.bounds || is.points > budget_ || states_[tile] == State::lost) return std::nullopt;
  const bool seen = isSeen(*is.bounds, eye);
  if (!seen && !held) return std::nullopt;
  const double factor = held ? nearer_where_held : 1.0;
  return Rank{!seen, factor * distanceTo(*is.bounds, eye.place), factor * distanceToMiddle(*is.bounds, eye.place),
              tile};
}

void TileChoice::look(const Eye& eye)
{
  std::vector<Rank> order;
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
    if (const std::optional<Rank> rank = rankOf(tile, eye)) order.push_back(*rank);
  std::sort(order.begin(), order.end());
  wanted_.clear();
  std::uint64_t points = 0;
  for (const Rank& rank : order) {
    points += tiles_[rank.tile].points;
    if (points > budget_) break;
    wanted_.push_back(rank.tile);
  }
}

std::vector<std::size_t> TileChoice::superfluous() const
{
  std::vector<std::size_t> tiles;
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    if (states_[tile] == State::held && std::find(wanted_.begin(), wanted_.end(), tile) == wanted_.end())
      tiles.push_back(tile);
  }
  return tiles;
}

std::optional<std::size_t> TileChoice::next() const
{
  const auto away = [this](std::size_t tile) { return states_[tile] == State::away; };
  const auto nearest = std::find_if(wanted_.begin(), wanted_.end(), away);
  return nearest == wanted_.end() ? std::nullopt : std::optional(*nearest);
}

void TileChoice::hold(std::size_t tile)
{
  states_[tile] = State::held;
  ++held_;
  held_points_ += tiles_[tile].points;
}

void TileChoice::drop(std::size_t tile)
{
  states_[tile] = State::away;
  --held_;
  held_points_ -= tiles_[tile].points;
}

void TileChoice::giveUp(std::size_t tile)
{
  states_[tile] = State::lost;
}

} // namespace pcl_bsh::viewer
