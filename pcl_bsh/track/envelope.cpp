// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/envelope.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

void widen(const std::vector<SectionPoint>& corners, const Widening& more, std::vector<SectionPoint>& widened)
{
  widened.assign(corners.begin(), corners.end());
  for (SectionPoint& corner : widened)
    corner.offset += corner.offset > 0.0 ? more.right : corner.offset < 0.0 ? -more.left : 0.0;
}

double mostOf(const Piecewise& widening)
{
  double most = 0.0;
  for (const Piecewise::Part& part : widening.parts()) most = std::max(most, part.value);
  return most;
}

} // namespace

Overthrow overthrowOf(const Vehicle& vehicle, double radius)
{
  if (std::isinf(radius)) return {};
  const double half = 0.5 * vehicle.pivots, end = half + vehicle.overhang;
  if (!(half < radius))
    throw InvalidInput(Input::trajectory, "vehicle",
                       plainText("its pivots, ", vehicle.pivots, " apart, do not fit on a radius of ", radius),
                       "give a shorter distance of pivots, or an axis without such a curve")
        .withValue(vehicle.pivots);
  const double to_middle = std::sqrt((radius - half) * (radius + half));
  const double beyond = end * end - half * half; // differences of roots, without cancellation
  return {half * half / (radius + to_middle), beyond / (std::sqrt(radius * radius + beyond) + radius)};
}

Envelope::Envelope(EnvelopeDescription description) : description_(std::move(description))
{
  const std::string subject = "envelope " + description_.name;
  const auto refuse = [&](const std::string& wrong, const std::string& remedy) {
    throw InvalidInput(Input::trajectory, subject, wrong, remedy);
  };
  try {
    description_.corners = simplePolygon(std::move(description_.corners));
    std::vector<SectionPoint> widest;
    widen(description_.corners, {mostOf(description_.left), mostOf(description_.right)}, widest);
    simplePolygon(widest);
  }
  catch (const InvalidInput& error) {
    refuse(error.wrong(), error.remedy());
  }
  for (const Piecewise* side : {&description_.left, &description_.right})
    for (const Piecewise::Part& part : side->parts())
      if (!(part.value >= 0.0 && std::isfinite(part.value)))
        refuse(plainText("its widening at distance ", part.begin, " is ", part.value), "give lengths of 0 or more");
  for (const ChainageRange& range : description_.ranges)
    if (!(range.from <= range.to))
      refuse(plainText("its range ends at ", range.to, ", before it begins at ", range.from), "exchange the two");
  if (const auto& vehicle = description_.vehicle)
    if (!(vehicle->pivots > 0.0 && vehicle->overhang >= 0.0 && std::isfinite(vehicle->pivots + vehicle->overhang)))
      refuse(plainText("its vehicle has pivots ", vehicle->pivots, " apart and an overhang of ", vehicle->overhang),
             "give a length above 0, and one of 0 or more");
  SectionPoint low = corners().front(), high = low;
  for (const SectionPoint& corner : corners()) {
    low = {std::min(low.offset, corner.offset), std::min(low.height, corner.height)};
    high = {std::max(high.offset, corner.offset), std::max(high.height, corner.height)};
  }
  middle_ = {0.5 * (low.offset + high.offset), 0.5 * (low.height + high.height)};
  half_ = {0.5 * (high.offset - low.offset), 0.5 * (high.height - low.height)};
}

bool Envelope::countsAt(double chainage) const
{
  const auto holds = [&](const ChainageRange& range) { return range.from <= chainage && chainage <= range.to; };
  return description_.ranges.empty() || std::any_of(description_.ranges.begin(), description_.ranges.end(), holds);
}

bool Envelope::widens() const
{
  return description_.vehicle || !description_.left.empty() || !description_.right.empty();
}

Widening Envelope::wideningAt(const Axis& axis, double distance) const
{
  Widening more{description_.left(distance), description_.right(distance)};
  if (!description_.vehicle) return more;
  const double curvature = axis.curvature(distance);
  if (curvature == 0.0) return more;
  const Overthrow over = overthrowOf(*description_.vehicle, 1.0 / std::abs(curvature));
  more.left += curvature > 0.0 ? over.outer : over.inner;
  more.right += curvature > 0.0 ? over.inner : over.outer;
  return more;
}

const std::vector<SectionPoint>& Envelope::outlineAt(const Axis& axis, double distance,
                                                     std::vector<SectionPoint>& room) const
{
  if (!widens()) return corners();
  widen(corners(), wideningAt(axis, distance), room);
  return room;
}

double Envelope::aroundOf(const SectionPoint& place) const
{
  const double x = (place.offset - middle_.offset) / half_.offset, y = (place.height - middle_.height) / half_.height;
  const double most = std::max(std::abs(x), std::abs(y));
  if (most == 0.0) return 0.0;
  const auto share = [&](double part) { return std::clamp(0.5 + 0.5 * part / most, 0.0, 0x1.fffffffffffffp-1); };
  if (std::abs(y) > std::abs(x)) return y > 0.0 ? 1.0 + share(x) : 3.0 + share(-x);
  return x < 0.0 ? share(y) : 2.0 + share(-y);
}

} // namespace pcl_bsh
