// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/origin_path.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace pcl_bsh {

OriginPath::OriginPath(std::vector<TimedOrigin> places) : places_(std::move(places))
{
  if (places_.size() < 2)
    throw InvalidInput(Input::seen, "origin path", plainText("has ", places_.size(), " of the two places it needs"),
                       "give the scanner's place before the first point, and behind the last one");
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto refuse = [&](const std::string& wrong, const std::string& remedy) {
      throw InvalidInput(Input::seen, plainText("origin path, place ", i), wrong, remedy).withIndex(i);
    };
    if (!std::isfinite(places_[i].time) || !isFinite(places_[i].at))
      refuse("has a value that is not finite", "correct it, or leave the place out");
    if (i > 0 && !(places_[i].time > places_[i - 1].time))
      refuse(plainText("its time ", places_[i].time, " does not exceed the one before, ", places_[i - 1].time),
             "list places in the order of rising times");
  }
}

std::optional<Point3> OriginPath::at(double time) const
{
  if (!(time >= from() && time <= to())) return std::nullopt;
  const auto after = std::upper_bound(places_.begin() + 1, places_.end() - 1, time,
                                      [](double wanted, const TimedOrigin& place) { return wanted < place.time; });
  const TimedOrigin &a = *(after - 1), &b = *after;
  const double share = (time - a.time) / (b.time - a.time);
  Point3 place;
  for (std::size_t k = 0; k < 3; ++k) place[k] = a.at[k] + share * (b.at[k] - a.at[k]);
  return place;
}

std::vector<Point3> originsOf(const PointsView& points, const TimeField& field, const OriginPath& path,
                              std::uint64_t first_record, OutsidePath& outside)
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  PointsView times = points; // its points have the time as x, y and z
  times.offset = {field.offset, field.offset, field.offset};
  times.scalar = field.scalar;
  std::vector<Point3> origins(points.size(), {none, none, none});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double time = times.point(points.record(i))[0];
    if (const std::optional<Point3> origin = path.at(time))
      origins[i] = *origin;
    else if (outside.points++ == 0)
      outside = {1, first_record + points.record(i), time};
  }
  return origins;
}

} // namespace pcl_bsh
