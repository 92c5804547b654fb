// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/gauge.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/parallel.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr std::size_t block_points = 4096;
constexpr double no_clearance = std::numeric_limits<double>::quiet_NaN();

/// The envelopes' answer at one place.
struct Judged {
  double least = no_clearance;
  std::int32_t envelope = -1;
  std::vector<double> each;
};

class GaugeBlock {
public:
  GaugeBlock(const Axis& axis, const std::vector<Envelope>& envelopes) : axis_(axis), envelopes_(envelopes) {}

  void judge(const AxisPlace& place, Judged& judged)
  {
    judged.least = no_clearance;
    judged.envelope = -1;
    judged.each.assign(envelopes_.size(), no_clearance);
    const double chainage = axis_.chainage(place.distance);
    for (std::size_t e = 0; e < envelopes_.size(); ++e) {
      if (!envelopes_[e].countsAt(chainage)) continue;
      const auto& outline = envelopes_[e].outlineAt(axis_, place.distance, room_);
      const double clearance = signedDistance(outline, {place.offset, place.height});
      judged.each[e] = clearance;
      if (judged.envelope >= 0 && !(clearance < judged.least)) continue;
      judged.least = clearance;
      judged.envelope = static_cast<std::int32_t>(e);
    }
  }

private:
  const Axis& axis_;
  const std::vector<Envelope>& envelopes_;
  std::vector<SectionPoint> room_;
};

} // namespace

GaugedPoints gauge(const PointsView& points, const Axis& axis, const std::vector<Envelope>& envelopes,
                   const GaugeRequest& request)
{
  if (envelopes.empty()) throw InvalidInput(Input::trajectory, "envelopes", "there are none", "give one at least");
  axis.requireReach(request.reach);
  const std::size_t count = points.size(), each = envelopes.size();
  GaugedPoints found;
  found.state.resize(count);
  found.place.resize(count);
  found.clearance.resize(count);
  found.envelope.resize(count);
  found.each.resize(count * each);
  const DefaultFloatEnvironment environment;
  parallelFor((count + block_points - 1) / block_points, threadCount(request.threads), [&](std::size_t block) {
    askWatcher();
    GaugeBlock judges(axis, envelopes);
    Judged at_best, at_second;
    const std::size_t end = std::min(count, (block + 1) * block_points);
    for (std::size_t i = block * block_points; i < end; ++i) {
      const AxisPlaces places = axis.nearest(points.point(points.record(i)), request.reach);
      found.state[i] = places.state;
      const bool placed = hasPlace(places.state);
      AxisPlace place = places.best;
      Judged* judged = &at_best;
      if (placed) {
        judges.judge(place, at_best);
      }
      else {
        at_best.least = no_clearance;
        at_best.envelope = -1;
        at_best.each.assign(each, no_clearance);
      }
      if (places.state == PlaceState::two_places) {
        judges.judge(places.second, at_second);
        if (at_second.envelope >= 0 && !(at_best.least <= at_second.least)) {
          judged = &at_second;
          place = places.second;
        }
      }
      found.place[i] = place;
      found.clearance[i] = judged->least;
      found.envelope[i] = judged->envelope;
      std::copy(judged->each.begin(), judged->each.end(), found.each.begin() + static_cast<std::ptrdiff_t>(i * each));
    }
  });
  for (const PlaceState state : found.state) ++found.counts[static_cast<std::size_t>(state)];
  return found;
}

} // namespace pcl_bsh
