// SPDX-License-Identifier: BSD-3-Clause
// Several tracks beside one another, gauged in one pass.
//
//   const std::vector<Track> tracks = {{"left", left_axis, {gauge_of_left}}, {"right", right_axis, {gauge_of_right}}};
//   const GaugedTracks found = gauge(viewOf(scan), tracks, {});
//   if (found.told.clearance[i] <= 0.0) tell(tracks[found.track[i]].name, found.told.place[i]);
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/track/gauge.h>

#include <cstdint>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// An axis, and what must stay free along it.
struct Track {
  std::string name; ///< empty where there is only one
  Axis axis;
  std::vector<Envelope> envelopes;
};

/// The answer of gauge() for each of several tracks, and the one of them that each point is told with.
struct GaugedTracks {
  std::vector<GaugedPoints> each;  ///< of each track, as if it were alone
  GaugedPoints told;               ///< point by point the answer of one track; its own `each` is empty
  std::vector<std::int32_t> track; ///< the number of that track; -1: the point has a place at none
};

/// A point counts at every track that it has a place at. It is told with the track where its clearance is smallest, of
/// equal ones where it is nearer, by its offset, then with the first. A track where no envelope counts comes behind all
/// others. A point without any place is told as `before` if it is before some axis, else as `behind` if it is behind
/// some axis, else as `too_far`.
/// @throws InvalidInput for no track, and as gauge() of one axis does
GaugedTracks gauge(const PointsView& points, const std::vector<Track>& tracks, const GaugeRequest& request);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
