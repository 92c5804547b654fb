// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/axis_parts.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pcl_bsh {
namespace {

constexpr double most_piece = 32.0;       // the box of a longer straight is loose
constexpr double most_pieces = 4'000'000; // 128,000 km of straights

[[noreturn]] void refuseAxis(const std::string& what, const std::string& wrong, const std::string& remedy, double value)
{
  throw InvalidInput(Input::trajectory, what, wrong, remedy).withValue(value);
}

void requireFinite(const char* what, double at, double value)
{
  if (!std::isfinite(value))
    refuseAxis(plainText("axis at distance ", at), plainText(what, " is ", value), "give a finite number", value);
}

void requireKnots(const char* what, const std::vector<Knot>& knots)
{
  for (std::size_t i = 0; i < knots.size(); ++i) {
    requireFinite("a distance", 0.0, knots[i].at);
    requireFinite(what, knots[i].at, knots[i].value);
    if (i > 0 && knots[i].at < knots[i - 1].at)
      refuseAxis(plainText("axis at distance ", knots[i].at),
                 plainText("the ", what, " before it is at ", knots[i - 1].at),
                 "list them in the order of their distances", knots[i].at);
  }
}

Piecewise chainagesOf(const std::vector<Knot>& knots)
{
  requireKnots("chainage", knots);
  if (knots.size() < 2) {
    const Knot only = knots.empty() ? Knot{} : knots.front();
    return Piecewise({{only.at, only.value, 1.0, 0.0}});
  }
  for (std::size_t i = 1; i < knots.size(); ++i)
    if (knots[i].at > knots[i - 1].at && !(knots[i].value > knots[i - 1].value))
      refuseAxis(plainText("axis at distance ", knots[i].at),
                 plainText("its chainage falls from ", knots[i - 1].value, " to ", knots[i].value),
                 "list the axis in the direction in which chainages rise", knots[i].value);
  return Piecewise::through(knots, Piecewise::Ends::extended);
}

Piecewise gradesOf(const std::vector<GradeChange>& changes)
{
  std::vector<Piecewise::Part> parts;
  double behind = -std::numeric_limits<double>::infinity(); // the end of the last parabola
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const GradeChange& change = changes[i];
    requireFinite("a height", change.distance, change.height);
    requireFinite("the length of a vertical curve", change.distance, change.curve_length);
    const auto grade = [&](std::size_t from) {
      return (changes[from + 1].height - changes[from].height) / (changes[from + 1].distance - changes[from].distance);
    };
    if (i > 0 && !(change.distance > changes[i - 1].distance))
      refuseAxis(plainText("axis at distance ", change.distance),
                 plainText("the height before it is at ", changes[i - 1].distance),
                 "list heights in the order of distances", change.distance);
    const double half = 0.5 * change.curve_length;
    const bool has_both = i > 0 && i + 1 < changes.size();
    if (half < 0.0 || (half > 0.0 && !has_both) || change.distance - half < behind)
      refuseAxis(plainText("axis at distance ", change.distance),
                 plainText("has no room for a vertical curve of length ", change.curve_length),
                 "give a curve_length that ends before its neighbours' begin; the first and the last have none",
                 change.curve_length);
    behind = change.distance + half;
    const double after = i + 1 < changes.size() ? grade(i) : i > 0 ? grade(i - 1) : 0.0;
    if (half > 0.0) {
      const double before = grade(i - 1);
      parts.push_back({change.distance - half, change.height - half * before, before, (after - before) / (2.0 * half)});
    }
    parts.push_back({behind, change.height + half * after, after, 0.0});
  }
  return Piecewise(std::move(parts));
}

} // namespace

void Axis::Parts::Box::add(const Box& other)
{
  low_x = std::min(low_x, other.low_x);
  low_y = std::min(low_y, other.low_y);
  high_x = std::max(high_x, other.high_x);
  high_y = std::max(high_y, other.high_y);
}

Axis::Parts::Parts(const AxisDescription& from, AxisFit& fit)
: description(from),
  smallest_radius(std::numeric_limits<double>::infinity())
{
  if (description.plan.empty() || !description.plan.front().start)
    refuseAxis("axis", "has no beginning", "give an element, and where it starts", 0.0);
  if (!(description.gauge > 0.0 && std::isfinite(description.gauge)))
    refuseAxis("axis", plainText("its gauge is ", description.gauge), "give a length above 0", description.gauge);
  layPlan(fit);
  makeBoxes();
  makeHeights();
  requireKnots("cant", description.cants);
  for (const Knot& cant : description.cants)
    if (!(std::abs(cant.value) <= 0.5 * description.gauge))
      refuseAxis(plainText("axis at distance ", cant.at),
                 plainText("its cant ", cant.value, " is more than half the gauge, ", description.gauge),
                 "give cants in the unit of coordinates", cant.value);
  cants = Piecewise::through(description.cants, Piecewise::Ends::held);
  chainages = chainagesOf(description.chainages);
}

void Axis::Parts::layPlan(AxisFit& fit)
{
  const AxisStart& first = *description.plan.front().start;
  origin = {std::round(first.x), std::round(first.y), 0.0};
  PlanFrame at;
  double heading = 0.0;
  for (const PlanElement& element : description.plan) {
    requireFinite("a length", length, element.length);
    requireFinite("a curvature", length, element.curvature_begin);
    requireFinite("a curvature", length, element.curvature_end);
    if (!(element.length > 0.0))
      refuseAxis(plainText("axis at distance ", length), plainText("an element has the length ", element.length),
                 "leave it out, or give a length above 0", element.length);
    if (element.start) {
      requireFinite("a coordinate", length, element.start->x);
      requireFinite("a coordinate", length, element.start->y);
      requireFinite("a heading", length, element.start->heading);
      const double x = element.start->x - origin[0], y = element.start->y - origin[1];
      if (length > 0.0) {
        const double gap = std::hypot(x - at.x, y - at.y);
        const double kink = std::abs(std::remainder(element.start->heading - heading, 2.0 * 3.14159265358979323846));
        if (gap > fit.gap) fit.gap_at = length;
        fit.gap = std::max(fit.gap, gap);
        fit.kink = std::max(fit.kink, kink);
        if (gap > description.most_gap)
          refuseAxis(plainText("axis at distance ", length), plainText("the next element starts ", gap, " away"),
                     plainText("correct its start; gaps up to ", description.most_gap, " are taken"), gap);
        if (kink > description.most_kink)
          refuseAxis(plainText("axis at distance ", length), plainText("has a kink of ", kink, " radians"),
                     plainText("correct the next element's direction; up to ", description.most_kink, " is taken"),
                     kink);
      }
      at = {x, y, 0.0, 0.0};
      heading = element.start->heading;
    }
    for (const auto& [k, where] :
         {std::pair{element.curvature_begin, length}, {element.curvature_end, length + element.length}}) {
      if (!(1.0 < smallest_radius * std::abs(k))) continue;
      smallest_radius = 1.0 / std::abs(k);
      smallest_radius_at = where;
    }
    lay(element, length, at, heading);
    length += element.length;
  }
  junctions.push_back({at.x, at.y, std::cos(heading), std::sin(heading)});
}

/// @param at, heading where it starts, and then where it ends
void Axis::Parts::lay(const PlanElement& element, double begin, PlanFrame& at, double& heading)
{
  const double k = -element.curvature_begin, c = -(element.curvature_end - element.curvature_begin) / element.length;
  const double most = std::max(std::abs(element.curvature_begin), std::abs(element.curvature_end));
  double count = std::ceil(std::max(element.length / most_piece, element.length * most / AxisPiece::kMostTurn));
  while (count <= most_pieces &&
         AxisPiece::remainder(0.5 * element.length / count, most, c) > AxisPiece::kMostRemainder) {
    count *= 2.0;
  }
  if (count + static_cast<double>(pieces.size()) > most_pieces)
    refuseAxis(
        plainText("axis at distance ", begin),
        plainText("an element of length ", element.length, " and curvature ", most, " is too long or too curved"),
        "give lengths and radii in the unit of coordinates", element.length);
  const auto headingAt = [&](double t) { return heading + t * (k + 0.5 * c * t); };
  const double step = element.length / count;
  double lost_x = 0.0, lost_y = 0.0; // by rounding: the next piece gets it back
  for (double i = 0; i < count; ++i) {
    const double from = i * step, middle = from + 0.5 * step;
    AxisPiece piece(begin + from, step, k + c * middle, c);
    const double turned = headingAt(middle), there = headingAt(from);
    at.cosine = std::cos(there);
    at.sine = std::sin(there);
    junctions.push_back(at);
    piece.middle = {0.0, 0.0, std::cos(turned), std::sin(turned)};
    const PlanFrame back = piece.placed(-piece.half), end = piece.placed(piece.half);
    piece.middle.x = at.x + (lost_x - back.x);
    piece.middle.y = at.y + (lost_y - back.y);
    const double dx = (end.x - back.x) + lost_x, dy = (end.y - back.y) + lost_y;
    const double x = at.x + dx, y = at.y + dy;
    lost_x = dx - (x - at.x);
    lost_y = dy - (y - at.y);
    at.x = x;
    at.y = y;
    pieces.push_back(piece);
  }
  heading = headingAt(element.length);
}

void Axis::Parts::makeBoxes()
{
  std::vector<Box> boxes;
  for (const AxisPiece& piece : pieces) {
    const PlanFrame from = piece.placed(-piece.half), to = piece.placed(piece.half);
    const double most = std::abs(piece.curvature) + std::abs(piece.change) * piece.half;
    const double aside =
        0.5 * most * piece.half * piece.half + 1e-9; // a curve of length l is within k l^2 / 8 of its chord
    boxes.push_back({std::min(from.x, to.x) - aside, std::min(from.y, to.y) - aside, std::max(from.x, to.x) + aside,
                     std::max(from.y, to.y) + aside});
  }
  levels.push_back(std::move(boxes));
  while (levels.back().size() > 1) {
    std::vector<Box> above;
    for (std::size_t i = 0; i < levels.back().size(); i += 2) {
      above.push_back(levels.back()[i]);
      if (i + 1 < levels.back().size()) above.back().add(levels.back()[i + 1]);
    }
    levels.push_back(std::move(above));
  }
}

void Axis::Parts::makeHeights()
{
  if (!description.grades.empty() && !description.heights.empty())
    refuseAxis("axis", "has both grades and heights", "give one of them", 0.0);
  requireKnots("height", description.heights);
  const bool graded = !description.grades.empty();
  if (!graded && description.heights.empty()) return;
  const double first = graded ? description.grades.front().height : description.heights.front().value;
  origin[2] = std::round(first);
  std::vector<GradeChange> grades = description.grades;
  std::vector<Knot> knots = description.heights;
  for (GradeChange& grade : grades) grade.height -= origin[2];
  for (Knot& knot : knots) knot.value -= origin[2];
  heights = graded ? gradesOf(grades) : Piecewise::through(knots, Piecewise::Ends::extended);
}

const AxisPiece& Axis::Parts::pieceAt(double distance) const
{
  const auto after = std::upper_bound(pieces.begin(), pieces.end(), distance,
                                      [](double at, const AxisPiece& piece) { return at < piece.begin; });
  return after == pieces.begin() ? pieces.front() : *(after - 1);
}

} // namespace pcl_bsh
