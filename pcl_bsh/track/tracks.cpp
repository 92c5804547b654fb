// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/tracks.h>

#include <pcl_bsh/base/invalid_input.h>

#include <cmath>
#include <limits>
#include <tuple>

namespace pcl_bsh {
namespace {

/// The track that a point is told with. For a point without a place, it is the one whose PlaceState is least.
std::size_t toldTrack(const std::vector<GaugedPoints>& each, std::size_t point)
{
  constexpr double last = std::numeric_limits<double>::infinity();
  const auto rank = [&](const GaugedPoints& found) {
    const bool placed = hasPlace(found.state[point]);
    const double clearance = found.clearance[point];
    return std::tuple(placed ? PlaceState::found : found.state[point], std::isnan(clearance) ? last : clearance,
                      placed ? std::abs(found.place[point].offset) : last);
  };
  std::size_t best = 0;
  for (std::size_t track = 1; track < each.size(); ++track)
    if (rank(each[track]) < rank(each[best])) best = track;
  return best;
}

} // namespace

GaugedTracks gauge(const PointsView& points, const std::vector<Track>& tracks, const GaugeRequest& request)
{
  if (tracks.empty()) throw InvalidInput(Input::trajectory, "tracks", "there are none", "give one at least");
  GaugedTracks found;
  for (const Track& track : tracks) found.each.push_back(gauge(points, track.axis, track.envelopes, request));
  GaugedPoints& told = found.told;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t track = toldTrack(found.each, i);
    const GaugedPoints& from = found.each[track];
    told.state.push_back(from.state[i]);
    told.place.push_back(from.place[i]);
    told.clearance.push_back(from.clearance[i]);
    told.envelope.push_back(from.envelope[i]);
    found.track.push_back(hasPlace(from.state[i]) ? static_cast<std::int32_t>(track) : -1);
    ++told.counts[static_cast<std::size_t>(from.state[i])];
  }
  return found;
}

} // namespace pcl_bsh
