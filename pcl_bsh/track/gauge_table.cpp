// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/gauge_table.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/clusters/clusters.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace pcl_bsh {
namespace {

/// The smaller one is worse.
std::tuple<double, std::uint64_t> key(const Infringing& point)
{
  return {point.clearance, point.record};
}

/// Clusters of the points with these numbers.
void addInfringements(const std::vector<Infringing>& list, const std::vector<std::size_t>& numbers, double distance,
                      std::vector<Infringement>& found)
{
  std::vector<Point3> places;
  for (const std::size_t i : numbers) places.push_back(list[i].at);
  const SphereHierarchy cloud(viewOf(places.empty() ? nullptr : places.front().data(), places.size()));
  const Clusters clusters = euclideanClusters(cloud, distance);
  const std::size_t first_found = found.size();
  found.resize(first_found + clusters.sizes.size());
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const Infringing& point = list[numbers[n]];
    Infringement& infringement = found[first_found + static_cast<std::size_t>(clusters.of[n])];
    const double at = point.place.distance;
    const bool first = infringement.members.empty();
    if (first || key(point) < key(infringement.worst)) infringement.worst = point;
    infringement.from = first ? at : std::min(infringement.from, at);
    infringement.to = first ? at : std::max(infringement.to, at);
    infringement.members.push_back(numbers[n]);
  }
}

} // namespace

GaugeTable::GaugeTable(const Axis& axis, std::size_t envelopes, double step)
: length_(axis.length()),
  step_(step),
  envelopes_(envelopes)
{
  const double parts = std::ceil(length_ / step);
  if (!(step > 0.0 && std::isfinite(step) && parts * static_cast<double>(envelopes) <= 1e7))
    throw InvalidInput(Input::trajectory, "step", plainText(step, " makes no table of an axis ", length_, " long"),
                       "give a length above 0, such as 1")
        .withValue(step);
  points_.resize(static_cast<std::size_t>(std::max(1.0, parts)));
  cells_.assign(points_.size() * envelopes * cells_around, std::numeric_limits<double>::infinity());
}

std::size_t GaugeTable::partOf(double distance) const
{
  return std::min(parts() - 1, static_cast<std::size_t>(std::max(0.0, distance) / step_));
}

void GaugeTable::add(const GaugedPoints& found, const std::vector<Envelope>& envelopes)
{
  for (std::size_t i = 0; i < found.state.size(); ++i) {
    if (!hasPlace(found.state[i])) continue;
    const AxisPlace& place = found.place[i];
    const std::size_t part = partOf(place.distance);
    ++points_[part];
    for (std::size_t e = 0; e < envelopes_; ++e) {
      const double clearance = found.each[i * envelopes_ + e];
      if (std::isnan(clearance)) continue;
      const double around = envelopes[e].aroundOf({place.offset, place.height});
      double& least =
          cells_[(part * envelopes_ + e) * cells_around + static_cast<std::size_t>(around * cells_of_sector)];
      least = std::min(least, clearance + 0.0); // no -0: std::min() of 0 and -0 depends on their order
    }
  }
}

double GaugeTable::smallest(std::size_t part, std::size_t envelope, Sector sector) const
{
  const double* const first =
      &cells_[(part * envelopes_ + envelope) * cells_around + static_cast<std::size_t>(sector) * cells_of_sector];
  return *std::min_element(first, first + cells_of_sector);
}

double GaugeTable::smallest(std::size_t part, std::size_t envelope) const
{
  const double* const first = &cells_[(part * envelopes_ + envelope) * cells_around];
  return *std::min_element(first, first + cells_around);
}

void addInfringing(const PointsView& points, const GaugedPoints& found, double limit, std::uint64_t first_record,
                   std::vector<Infringing>& list, std::uint32_t track)
{
  for (std::size_t i = 0; i < found.clearance.size(); ++i)
    if (found.clearance[i] <= limit)
      list.push_back({points.point(points.record(i)), first_record + points.record(i), found.place[i],
                      found.clearance[i], found.envelope[i], track});
}

std::vector<Infringement> infringementsOf(const std::vector<Infringing>& list, double distance)
{
  std::map<std::uint32_t, std::vector<std::size_t>> of_tracks = {{0, {}}}; // also an empty list has `distance` checked
  for (std::size_t i = 0; i < list.size(); ++i) of_tracks[list[i].track].push_back(i);
  std::vector<Infringement> found;
  for (const auto& of_track : of_tracks) addInfringements(list, of_track.second, distance, found);
  std::sort(found.begin(), found.end(), [](const Infringement& a, const Infringement& b) {
    return std::tuple(key(a.worst), a.worst.track) < std::tuple(key(b.worst), b.worst.track);
  });
  return found;
}

} // namespace pcl_bsh
