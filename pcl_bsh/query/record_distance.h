// SPDX-License-Identifier: BSD-3-Clause
// Distances between posed records of two clouds, whatever these are: points, balls, or triangles.
//
//   RecordDistance distance(a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose);
//   bool collide = distance.compare({i, j}, clearance) <= 0;
//
// RecordDistance is to records as ExactDistance is to points and TriangleDistance to triangles. Expects the
// DefaultFloatEnvironment.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/triangle/triangle_distance.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/query/result.h>

#include <Eigen/Geometry>

#include <array>
#include <limits>
#include <optional>

namespace pcl_bsh {

/// Distances of records under two fixed poses. A gap is the distance less the radii of points; triangles have none, and
/// are at 0 where they meet. Const methods may run in several threads at once. The views must outlive this.
class PCL_BSH_EXPORT_INTERNAL RecordDistance {
public:
  using Enclosure = ExactDistance::Enclosure;
  using Sum = ExactDistance::Sum;

  /// Two records, read from their views. For triangles, the points are the middles of their balls.
  struct Pair : ExactDistance::Pair {
    Pair() = default;
    Pair(const ExactDistance::Pair& points, PointPair of) : ExactDistance::Pair(points), records(of) {}

    PointPair records;
    mutable TriangleDistance::Known known; ///< of triangles: what comparing gaps has found
  };

  RecordDistance(const PointsView& a, const Eigen::Isometry3d& pose_a, const PointsView& b,
                 const Eigen::Isometry3d& pose_b)
  : a_(&a),
    b_(&b),
    points_(pose_a, pose_b)
  {
    if (a.triangles) to_a_.emplace(pose_b, pose_a); // points come first
    if (b.triangles) to_b_.emplace(pose_a, pose_b);
  }

  Pair pair(PointPair records) const
  {
    return {ExactDistance::Pair{a_->point(records.a), b_->point(records.b), a_->ownRadius(records.a),
                                b_->ownRadius(records.b)},
            records};
  }

  /// Whether one of the clouds is of triangles.
  bool ofTriangles() const { return to_a_ || to_b_; }

  /// The distance of points, such as centres of nodes.
  const ExactDistance& ofPoints() const { return points_; }

  /// Sign of the pair's gap less the clearance: it collides when the answer is <= 0.
  int compare(PointPair records, double clearance) const
  {
    if (ofTriangles()) return compareTriangles(records, clearance);
    return points_.compare(a_->point(records.a), b_->point(records.b), clearance, a_->radius(records.a),
                           b_->radius(records.b));
  }
  int compare(const Pair& pair, double clearance) const
  {
    if (ofTriangles()) return compareTriangles(pair.records, clearance);
    return points_.compare(pair.p, pair.q, clearance, pair.radius_p, pair.radius_q);
  }

  /// Sign of the distance, radii not subtracted, less the sum of the terms of `reach`. @pre finite terms
  int compare(PointPair records, const Sum& reach) const
  {
    if (ofTriangles()) return compareTriangles(records, reach);
    return points_.compare(a_->point(records.a), b_->point(records.b), reach);
  }

  /// Bounds of the distance, radii not subtracted, as far as double arithmetic can tell; both infinite where it cannot.
  Enclosure enclose(const Pair& pair) const
  {
    return ofTriangles() ? encloseTriangles(pair.records, std::numeric_limits<double>::infinity())
                         : points_.enclose(pair.p, pair.q);
  }

  /// Whether doubles know a pair of triangles, or of a point and a triangle, to have a greater gap than this.
  bool isSurelyBeyond(const Pair& pair, double gap) const
  {
    const double reach = (gap + pair.radius_p + pair.radius_q) * (1.0 + kDoubleMargin);
    return encloseTriangles(pair.records, reach).low > reach;
  }

  /// From b's nearest place to a's, in the world, within rounding; 0 where they meet. For balls it is the vector
  /// between their centres.
  Eigen::Vector3d between(PointPair records) const;

  /// Planes through the nearest places of a's record and of b's, exactly as far apart as these. Each normal points at
  /// the other record: places behind the first plane are no nearer to places behind the second. In the coordinates of
  /// a's view and of b's. Nothing where records meet, without triangles, and where points have radii.
  std::optional<std::array<ExactPlane, 2>> planesBetween(PointPair records) const;

  /// Sign of gap(first) - gap(second), before rounding.
  int compareGaps(const Pair& first, const Pair& second) const { return compareGaps(first, *this, second); }

  /// Sign of gap(first) - other.gap(second), before rounding. @param other of the same clouds, at other poses
  int compareGaps(const Pair& first, const RecordDistance& other, const Pair& second) const
  {
    if (ofTriangles()) return compareTriangleGaps(first, other, second);
    return points_.compareGaps(first, other.points_, second);
  }

  int compareGaps(PointPair first, PointPair second) const { return compareGaps(pair(first), pair(second)); }
  int compareGaps(PointPair first, const RecordDistance& other, PointPair second) const
  {
    return compareGaps(pair(first), other, other.pair(second));
  }

  /// Rounded to the nearest double (ties to even; infinity beyond the largest).
  double gap(const Pair& pair) const { return ofTriangles() ? gapOfTriangles(pair.records) : points_.gap(pair); }
  double gap(PointPair records) const { return gap(pair(records)); }

private:
  template <class Visit>
  auto withTriangles(PointPair records, const Visit& visit) const;
  const TriangleDistance& distanceOfPair() const;
  int compareTriangles(PointPair records, double clearance) const;
  int compareTriangles(PointPair records, const Sum& reach) const;
  Enclosure encloseTriangles(PointPair records, double reach) const;
  int compareTriangleGaps(const Pair& first, const RecordDistance& other, const Pair& second) const;
  double gapOfTriangles(PointPair records) const;

  const PointsView* a_;
  const PointsView* b_;
  ExactDistance points_;
  std::optional<TriangleDistance> to_a_, to_b_; ///< from the other cloud, where one is of triangles
};

} // namespace pcl_bsh
