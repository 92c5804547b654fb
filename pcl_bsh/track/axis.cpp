// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/axis.h>
#include <pcl_bsh/track/axis_parts.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

AxisPlace inCantsPlane(const AxisDescription& description, double distance, double cant, double right, double above)
{
  const CantTurn turn(description, cant);
  const double u = right - turn.right, v = above - turn.above;
  return {distance, u * turn.cosine - v * turn.sine, u * turn.sine + v * turn.cosine};
}

} // namespace

Axis::Axis(const AxisDescription& description) : parts_(std::make_shared<const Parts>(description, fit_))
{
}

double Axis::length() const
{
  return parts_->length;
}

double Axis::chainage(double distance) const
{
  return parts_->chainages(distance);
}

std::vector<double> Axis::distancesAt(double chainage) const
{
  constexpr double doubt = 1e-9; // how far a chainage computed for an end may be off
  std::vector<double> found;
  const std::vector<Piecewise::Part>& parts = parts_->chainages.parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Piecewise::Part& part = parts[i];
    const bool last = i + 1 == parts.size();
    const double from = i == 0 ? -doubt : part.begin;
    const double to = last ? length() + doubt : parts[i + 1].begin;
    const double at = part.begin + (chainage - part.value) / part.slope;
    if (at >= from && (last ? at <= to : at < to)) found.push_back(std::clamp(at, 0.0, length()));
  }
  return found;
}

double Axis::cant(double distance) const
{
  return parts_->cants(distance);
}

double Axis::curvature(double distance) const
{
  const AxisPiece& piece = parts_->pieceAt(distance);
  return -(piece.curvature + piece.change * (distance - piece.begin - piece.half));
}

double Axis::smallestRadius() const
{
  return parts_->smallest_radius;
}

double Axis::smallestRadiusAt() const
{
  return parts_->smallest_radius_at;
}

const AxisFit& Axis::fit() const
{
  return fit_;
}

const AxisDescription& Axis::description() const
{
  return parts_->description;
}

AxisFrame Axis::frame(double distance) const
{
  const AxisPiece& piece = parts_->pieceAt(distance);
  const PlanFrame p = piece.placed(distance - piece.begin - piece.half);
  const CantTurn turn(parts_->description, parts_->cants(distance));
  const double rx = p.sine, ry = -p.cosine; // to the right, level
  AxisFrame frame;
  frame.origin = {parts_->origin[0] + (p.x + turn.right * rx), parts_->origin[1] + (p.y + turn.right * ry),
                  parts_->origin[2] + (parts_->heights(distance) + turn.above)};
  frame.along = {p.cosine, p.sine, 0.0};
  frame.right = {turn.cosine * rx, turn.cosine * ry, -turn.sine};
  frame.up = {turn.sine * rx, turn.sine * ry, turn.cosine};
  return frame;
}

void Axis::requireReach(const AxisReach& reach) const
{
  for (const double part : {reach.offset, reach.below, reach.above})
    if (!(part > 0.0 && std::isfinite(part)))
      throw InvalidInput(Input::trajectory, "reach", plainText(part, " is no length"), "give lengths above 0")
          .withValue(part);
  if (reach.offset > 0.8 * smallestRadius())
    throw InvalidInput(Input::trajectory, "reach",
                       plainText(reach.offset, " beside the axis is more than 0.8 of its smallest radius, ",
                                 smallestRadius(), " at chainage ", chainage(smallestRadiusAt())),
                       plainText("give at most ", 0.8 * smallestRadius()))
        .withValue(reach.offset);
}

AxisPlaces Axis::nearest(const Point3& point, const AxisReach& reach) const
{
  AxisPlaces found;
  if (!isFinite(point)) {
    found.state = PlaceState::not_finite;
    return found;
  }
  const Parts& parts = *parts_;
  const double x = point[0] - parts.origin[0], y = point[1] - parts.origin[1], z = point[2] - parts.origin[2];
  const double none = std::numeric_limits<double>::infinity();
  struct Candidate {
    double distance = 0.0, right, above = 0.0;
    bool operator<(const Candidate& other) const
    {
      const double a = std::abs(right), b = std::abs(other.right);
      return a < b || (a == b && distance < other.distance);
    }
  };
  Candidate best{0.0, none}, second{0.0, none};
  parts.forPiecesNear(x, y, reach.offset, [&](std::size_t i) {
    // Both pieces at a junction are divided by one plane, so that each zero of the distance's slope lies in one piece.
    const double ahead = parts.junctions[i].ahead(x, y), left_over = parts.junctions[i + 1].ahead(x, y);
    const bool last = i + 1 == parts.pieces.size();
    if (!(ahead >= 0.0) || !(last ? left_over <= 0.0 : left_over < 0.0)) return;
    const AxisPiece::Foot foot = parts.pieces[i].foot(x, y);
    if (!(std::abs(foot.left) <= reach.offset)) return;
    const double along = parts.pieces[i].begin + parts.pieces[i].half + foot.t; // rounding may go beyond an end
    Candidate candidate{std::clamp(along, 0.0, parts.length), -foot.left};
    candidate.above = z - parts.heights(candidate.distance);
    if (!(candidate.above >= -reach.below && candidate.above <= reach.above)) return;
    if (candidate < best) {
      second = best;
      best = candidate;
    }
    else if (candidate < second) {
      second = candidate;
    }
  });
  const auto placed = [&](const Candidate& at) {
    return inCantsPlane(parts.description, at.distance, parts.cants(at.distance), at.right, at.above);
  };
  if (best.right < none) {
    found.state = second.right < none ? PlaceState::two_places : PlaceState::found;
    found.best = placed(best);
    if (second.right < none) found.second = placed(second);
    return found;
  }
  const PlanFrame &first = parts.junctions.front(), &end = parts.junctions.back();
  if (first.ahead(x, y) < 0.0 && std::abs(first.aside(x, y)) <= reach.offset)
    found.state = PlaceState::before;
  else if (end.ahead(x, y) > 0.0 && std::abs(end.aside(x, y)) <= reach.offset)
    found.state = PlaceState::behind;
  return found;
}

} // namespace pcl_bsh
