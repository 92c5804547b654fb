// SPDX-License-Identifier: BSD-3-Clause
// The gauging run: where every point of a scan is beside an axis, and how far it is outside of envelopes.
//
//   const std::vector<Envelope> envelopes = {Envelope({"wagon", {{-1.5, 0}, {1.5, 0}, {1.5, 4}, {-1.5, 4}}})};
//   GaugedPoints found = gauge(viewOf(scan), axis, envelopes, {});
//   if (found.clearance[i] <= 0.0) tell(axis.chainage(found.place[i].distance), found.envelope[i]);
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/track/envelope.h>

#include <array>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// How far from the axis points count, and on how many threads.
struct GaugeRequest {
  AxisReach reach;
  unsigned threads = 1; ///< 0: all of the machine's
};

/// The answers of gauge(), in the order of the view's points.
struct GaugedPoints {
  std::vector<PlaceState> state;
  std::vector<AxisPlace> place;        ///< the one that has the clearance, else the best; zeros: none
  std::vector<double> clearance;       ///< the smallest of all envelopes, negative inside; NaN where none counts
  std::vector<std::int32_t> envelope;  ///< number of the one with that clearance, of equal ones the first; -1: none
  std::vector<double> each;            ///< point by point the clearance of each envelope; NaN where it does not count
  std::array<std::size_t, 6> counts{}; ///< points of each state
};

/// A point that two places of the axis are near to counts at both: its clearance is the smaller one, and its place is
/// the one that has it, of equal ones the nearer. Results do not depend on the number of threads.
/// @throws InvalidInput for no envelope, and as Axis::requireReach() does
GaugedPoints gauge(const PointsView& points, const Axis& axis, const std::vector<Envelope>& envelopes,
                   const GaugeRequest& request);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
