// SPDX-License-Identifier: BSD-3-Clause
// Distances of posed triangles from points and from triangles, decided as exact arithmetic on the given numbers decides
// them.
//
//   TriangleDistance distance(T_world_a, T_world_b);
//   bool collide = distance.compare(p, triangle, clearance) <= 0;
//
// Like ExactDistance for points, it takes poses as they are; coordinates may be any finite doubles. Triangles are
// closed, and may be segments or points; triangles that meet have distance 0. Expects the DefaultFloatEnvironment.
#pragma once

#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

namespace pcl_bsh {

class ExactPlane;
struct Features;
class LongNumber;
enum class PlaneOverlap : std::uint8_t;
template <class Number>
struct Fraction;
template <class Number>
class NearestFeatures;

/// Distances under two fixed poses: the pose of a places the first point or triangle, the pose of b the second. Const
/// methods may run in several threads at once. Cost: about 0.15 us for a point and 1 us for a triangle where doubles
/// can vouch for the answer; up to 0.1 ms where nothing but long integers can.
class PCL_BSH_EXPORT_INTERNAL TriangleDistance {
public:
  using Enclosure = ExactDistance::Enclosure;

  /// How many answers came from double arithmetic, from sums of doubles that know their error, and from integers of any
  /// length (for the distance, or for the nearest features).
  struct Stages {
    std::uint64_t doubles = 0, long_numbers = 0, integers = 0;
  };

  TriangleDistance(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b);

  /// Bounds of the distance as far as double arithmetic can tell; both infinite where it cannot.
  /// @param reach the bounds need not be near to each other where both are on one side of it
  Enclosure enclose(const Point3& p, const Triangle3& b) const;
  Enclosure enclose(const Triangle3& a, const Triangle3& b,
                    double reach = std::numeric_limits<double>::infinity()) const;

  /// Sign of the distance less clearance + radius: negative, 0 when they are equal, or positive. The pair collides when
  /// the answer is <= 0. @param clearance, radius finite; clearance may be infinite, too
  int compare(const Point3& p, const Triangle3& b, double clearance, double radius = 0.0,
              Stages* stages = nullptr) const;
  int compare(const Triangle3& a, const Triangle3& b, double clearance, Stages* stages = nullptr) const;

  struct PointPair {
    Point3 a;
    Triangle3 b;
    double radius = 0.0; ///< of the point: of a ball
  };
  /// Keeps the facing and the nearest features of two triangles under one pair of poses.
  struct Known {
    std::optional<PlaneOverlap> overlap;
    std::uint8_t kind = 0, i = 0, j = 0; ///< of the nearest features
    bool has_features = false;
  };

  struct TrianglePair {
    Triangle3 a, b;
    double radius = 0.0;
    Known* known = nullptr; ///< kept for later, if not null
  };

  /// Sign of the pair's gap, which is the distance less the radius, less the sum of the terms of `reach`.
  /// @param reach finite; its first term may be infinite, too
  int compare(const PointPair& pair, const ExactDistance::Sum& reach, Stages* stages = nullptr) const;
  int compare(const TrianglePair& pair, const ExactDistance::Sum& reach, Stages* stages = nullptr) const;

  /// Sign of the gap of the first less that of the second under the poses of `other`.
  int compareGaps(const PointPair& first, const TriangleDistance& other, const PointPair& second,
                  Stages* stages = nullptr) const;
  int compareGaps(const TrianglePair& first, const TriangleDistance& other, const TrianglePair& second,
                  Stages* stages = nullptr) const;

  /// The distance, rounded to the nearest double (ties to even; infinity beyond the largest).
  double distance(const Point3& p, const Triangle3& b, Stages* stages = nullptr) const;
  double distance(const Triangle3& a, const Triangle3& b, Stages* stages = nullptr) const;

  /// The distance less the radius, rounded in the same way.
  double gap(const PointPair& pair, Stages* stages = nullptr) const;
  double gap(const TrianglePair& pair, Stages* stages = nullptr) const;

  /// From b's place nearest to a, to a's place nearest to b: a vector in the world, within rounding; 0 where they meet.
  Point3 between(const PointPair& pair) const;
  Point3 between(const TrianglePair& pair) const;

  /// Planes through the nearest places, perpendicular to the way between them: one of a and one of b. Each is in the
  /// coordinates in which a or b is given, with its normal towards the other. They are exactly as far apart as the
  /// places. Nothing where the pair meets. Radii do not count.
  std::optional<std::array<ExactPlane, 2>> planesBetween(const PointPair& pair) const;
  std::optional<std::array<ExactPlane, 2>> planesBetween(const TrianglePair& pair) const;

private:
  using Row = std::array<double, 4>; // of a pose: rotation, then translation
  using Pose = std::array<Row, 3>;

  /// Two triangles seen from a corner of the second, in double, and how far they may be off together.
  struct Seen {
    Triangle3 a, b;
    double error;
  };
  Seen seen(const Point3& a, const Triangle3& b) const; ///< from the point: a is a[0]
  Seen seen(const Triangle3& a, const Triangle3& b) const;

  template <class Number>
  std::array<Number, 3> placed(const Pose& pose, const Point3& p) const;
  std::array<std::array<LongNumber, 3>, 3> longCorners(const Pose& pose, const Triangle3& t) const;
  template <class Number, class Pair>
  NearestFeatures<Number> nearest(const Pair& pair) const;
  template <class Number, class Pair>
  Fraction<Number> squared(const Pair& pair, const Features& features) const;
  template <class Pair>
  std::optional<LongNumber> acrossAxis(const Pair& pair) const;
  template <class Pair>
  PlaneOverlap overlap(const Pair& pair) const;
  PlaneOverlap findOverlap(const TrianglePair& pair) const;
  std::optional<bool> areParallelAsGiven(const TrianglePair& pair) const;
  std::optional<int> comparePlanesAsGiven(const TrianglePair& first, const TrianglePair& second) const;
  template <class Pair>
  bool shareCorner(const Pair& pair) const;
  template <class Pair>
  Features nearestFeatures(const Pair& pair, bool& by_integers) const;
  template <class Pair>
  Features findFeatures(const Pair& pair, PlaneOverlap overlap, bool& by_integers) const;
  template <class Pair>
  int compareByStages(const Pair& pair, const ExactDistance::Sum& reach, Stages& stages) const;
  template <class Pair>
  int settle(const Pair& pair, const ExactDistance::Sum& reach, Stages& stages) const;
  template <class Pair>
  int settleOrder(const Pair& first, const TriangleDistance& other, const Pair& second, Stages& stages) const;
  template <class Pair>
  double rounded(const Pair& pair, Stages& stages) const;
  template <class Pair>
  Point3 betweenNearest(const Pair& pair) const;
  template <class Pair>
  std::optional<std::array<ExactPlane, 2>> planesOfNearest(const Pair& pair) const;

  ExactDistance points_;
  Pose a_, b_;
};

} // namespace pcl_bsh
