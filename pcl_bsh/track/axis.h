// SPDX-License-Identifier: BSD-3-Clause
// The line that a vehicle follows: straights, arcs and clothoids in plan, a profile of heights, and cant.
//
//   const Axis axis({{{100, 0, 0, AxisStart{5e5, 4e6, 0}}, {60, 0, 1 / 300.0}, {200, 1 / 300.0, 1 / 300.0}}});
//   const AxisPlaces found = axis.nearest({500120.0, 4000002.0, 31.5}, {});
//   if (found.state == PlaceState::found) use(axis.chainage(found.best.distance), found.best.offset);
//
// A section is the vertical plane across the axis. A point's distance is measured in plan along the axis, from its
// beginning to the place nearest to the point in plan. Its offset is how far it lies beside that place, positive to the
// right. Its height is above that place. Where there is cant, offset and height turn with the section.
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
  double curvature_end = 0.0;                    ///< 1 / radius at its end
  std::optional<AxisStart> start = std::nullopt; ///< the first needs one; others default to the end of the one before
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
  std::vector<Knot> chainages = {};      ///< at distances; none: equal to the distance. Two at one distance: a jump
  double gauge = 1.5;                    ///< distance between the rails' heads, where cant is measured
  CantPivot pivot = CantPivot::low_rail; ///< heights are the low rail's; with centre, those of the middle between both
  double most_gap = 0.01;                ///< how far a given start may be from the end of the element before
  double most_kink = 1e-3;               ///< how much its heading may differ from the heading there, in radians
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
  double deviation = 0.0;       ///< how far through() is at most from the points' polyline, fitted() from a point
  double stretch = 0.0;         ///< of both: the largest |length / difference of chainage - 1| between two points
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

/// The place of the axis that is nearest in plan, and the second nearest if it is within reach. Each is a local minimum
/// of the distance in plan. The first along the axis is `best` where two are equally near.
struct AxisPlaces {
  PlaceState state = PlaceState::too_far;
  AxisPlace best = {}, second = {};
};

/// Never changes. Copies share what they hold; several threads may ask one at once.
///
/// Coordinates count from a place near the beginning, so that distances and offsets of points in UTM coordinates are
/// within 1e-9 of the exact line. Positions are power series whose remainders are below 1e-14. The nearest place is the
/// one zero of a falling function, and is found by bracketing. So no point gets the wrong side or another place.
class Axis {
public:
  /// @throws InvalidInput where the description makes no axis, naming the distance
  explicit Axis(const AxisDescription& description);

  /// Joins each point to the next by two arcs, without a kink. Points on a circle give that circle. Heights and cant
  /// are straight from point to point.
  /// @param most_turn the most that the polyline may turn at a point, in radians
  /// @throws InvalidInput where chainages do not rise, or the polyline turns more
  static Axis through(const std::vector<AxisPoint>& points, AxisDescription rest = {}, double most_turn = 0.2);

  /// Fits few arcs, without a kink, to measured points with errors. Heights and cant are straight from point to point.
  /// @param tolerance finite, > 0: how far from the arcs a point may be in plan. Neighbours that err by more than that,
  ///   together, may be farther: fit().deviation tells
  /// @throws InvalidInput as through() does
  static Axis fitted(const std::vector<AxisPoint>& points, double tolerance, AxisDescription rest = {},
                     double most_turn = 0.2);

  /// The length in plan.
  double length() const;

  /// The chainage at a distance along the axis.
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

  /// @throws InvalidInput for a length of the reach not finite and > 0, and an offset above 0.8 of smallestRadius()
  void requireReach(const AxisReach& reach) const;

  /// The nearest places to a point within reach. @pre requireReach(reach) does not throw
  AxisPlaces nearest(const Point3& point, const AxisReach& reach) const;

private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
  AxisFit fit_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
