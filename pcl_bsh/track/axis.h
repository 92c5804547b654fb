// SPDX-License-Identifier: BSD-3-Clause
// The line that a vehicle follows: straights, arcs and clothoids in plan, a profile of heights, and cant.
//
//   const Axis axis({{{100, 0, 0, AxisStart{5e5, 4e6, 0}}, {60, 0, 1 / 300.0}, {200, 1 / 300.0, 1 / 300.0}}});
//   const AxisPlaces found = axis.nearest({500120.0, 4000002.0, 31.5}, {});
//   if (found.state == PlaceState::found) use(axis.chainage(found.best.distance), found.best.offset);
//
// A section is the vertical plane across the axis in plan. A point's distance is that of the place of the axis that is
// nearest in plan; its offset is how far it is from there, and to the right it is positive. Its height is above the
// axis' height there. Where there is cant, offset and height are those in the cant's plane.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/track/piecewise.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Where an element begins in plan.
struct AxisStart {
  double x = 0.0, y = 0.0;
  double heading = 0.0; ///< radians from x towards y
};

/// A part of the axis in plan, whose curvature grows evenly: a straight, an arc or a clothoid.
struct PlanElement {
  double length = 0.0;                           ///< > 0
  double curvature_begin = 0.0;                  ///< 1 / radius; positive where it turns to the right
  double curvature_end = 0.0;                    ///< the same at its end
  std::optional<AxisStart> start = std::nullopt; ///< of the first always; others go on where the last one ends
};

/// Where two grades meet, and how long the vertical parabola is that rounds it.
struct GradeChange {
  double distance = 0.0;     ///< along the axis
  double height = 0.0;       ///< where the grades would meet
  double curve_length = 0.0; ///< in plan; 0: a kink
};

/// The line that cant turns about.
enum class CantPivot : std::uint8_t { centre, low_rail };

/// The parts of an axis. Distances are from its beginning, in plan.
struct AxisDescription {
  std::vector<PlanElement> plan;
  std::vector<GradeChange> grades = {};  ///< in order; none: height 0. Beyond the ends the grade goes on
  std::vector<Knot> heights = {};        ///< instead of grades: straight from knot to knot
  std::vector<Knot> cants = {};          ///< how much higher the left rail is; straight ramps; held beyond the ends
  std::vector<Knot> chainages = {};      ///< at distances; none: the distance itself. Two at one distance: a jump
  double gauge = 1.5;                    ///< between the rails' heads, whose heights cant tells
  CantPivot pivot = CantPivot::low_rail; ///< height 0 is the low rail's; of centre, the middle of both
  double most_gap = 0.01;                ///< how far a given start may be from where the last element ends
  double most_kink = 1e-3;               ///< the same of its heading, in radians
};

/// A point of a measured axis.
struct AxisPoint {
  double chainage = 0.0;
  Point3 at = {};
  double cant = 0.0;
};

/// How an axis fits what it was made of.
struct AxisFit {
  double gap = 0.0, kink = 0.0; ///< the largest between elements
  double gap_at = 0.0;          ///< its distance
  double deviation = 0.0; ///< of an axis through points the farthest from their polyline; of a fitted one from a point
  double stretch = 0.0;   ///< of both: the largest |length / difference of chainage - 1| between two points
};

/// The axis' own directions at a place.
struct AxisFrame {
  Point3 origin = {}; ///< offset 0 and height 0 there
  Point3 along = {};  ///< horizontal
  Point3 right = {};  ///< in the cant's plane
  Point3 up = {};
};

/// Where a point is beside an axis.
struct AxisPlace {
  double distance = 0.0; ///< of the nearest place, from the axis' beginning
  double offset = 0.0;   ///< to the right, in the cant's plane
  double height = 0.0;   ///< above it
};

/// How far from an axis points still belong to it.
struct AxisReach {
  double offset = 10.0; ///< in plan, to either side; at most 0.8 of the smallest radius
  double below = 5.0;   ///< the axis' height
  double above = 15.0;
};

/// Whether a point has a place at the axis, and why not.
enum class PlaceState : std::uint8_t {
  found,
  two_places, ///< a second place of the axis is within reach, too, as in hairpins
  before,     ///< beyond the axis' beginning
  behind,     ///< beyond its end
  too_far,
  not_finite,
};

/// Whether the point has a place at the axis, or two.
inline bool hasPlace(PlaceState state)
{
  return state == PlaceState::found || state == PlaceState::two_places;
}

/// The nearest place in plan, of two at one distance the first along the axis; and the second nearest, if there is one
/// within reach. A place is one where the axis is nearest among its neighbours.
struct AxisPlaces {
  PlaceState state = PlaceState::too_far;
  AxisPlace best = {}, second = {};
};

/// Never changes. Copies share what they hold; several threads may ask one at once.
///
/// Coordinates count from a place near the beginning, so that distances and offsets of points given as UTM's are within
/// 1e-9 of the exact line. Positions are power series whose remainders are below 1e-14; the nearest place is found by
/// bracketing the one zero of a function that falls, so no point has the wrong side or another place.
class Axis {
public:
  /// @throws InvalidInput for what is no axis, naming the distance
  explicit Axis(const AxisDescription& description);

  /// Two arcs from each point to the next, without a kink; a circle through points on one. Heights and cant are
  /// straight from point to point.
  /// @param most_turn of the polyline at a point, in radians
  /// @throws InvalidInput where chainages do not rise, or the polyline turns more
  static Axis through(const std::vector<AxisPoint>& points, AxisDescription rest = {}, double most_turn = 0.2);

  /// Few arcs near measured points that err, without a kink. Heights and cant are straight from point to point.
  /// @param tolerance finite, > 0: how far from the arcs a point may be in plan. Neighbours that err by more than that,
  ///   together, may be farther: fit().deviation tells
  /// @throws InvalidInput as through() does
  static Axis fitted(const std::vector<AxisPoint>& points, double tolerance, AxisDescription rest = {},
                     double most_turn = 0.2);

  /// In plan.
  double length() const;

  /// The number that a distance along the axis has.
  double chainage(double distance) const;

  /// All distances with that chainage: none in a gap of the chainage, two where it repeats.
  std::vector<double> distancesAt(double chainage) const;

  AxisFrame frame(double distance) const;     ///< 0 <= distance <= length()
  double curvature(double distance) const;    ///< positive to the right
  double cant(double distance) const;         ///< how much higher the left rail is
  double smallestRadius() const;              ///< infinity of straights
  double smallestRadiusAt() const;            ///< its distance
  const AxisFit& fit() const;                 ///< how well it fits what it was made of
  const AxisDescription& description() const; ///< what it was made of

  /// @throws InvalidInput when the reach is not one of this axis
  void requireReach(const AxisReach& reach) const;

  /// @pre requireReach()
  AxisPlaces nearest(const Point3& point, const AxisReach& reach) const;

private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
  AxisFit fit_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
