// SPDX-License-Identifier: BSD-3-Clause
// Distances between posed points, decided as exact arithmetic on the given numbers decides them.
//
//   ExactDistance distance(T_world_a, T_world_b);
//   bool collide = distance.compare(p, q, clearance) <= 0;
//
// The twelve numbers of a pose are taken as they are: nothing here assumes that a rotation is one. Coordinates, poses
// and lengths may be any finite doubles, denormal and huge ones included. Expects the
// DefaultFloatEnvironment.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/point3.h>

#include <Eigen/Geometry>

#include <array>

namespace pcl_bsh {

class Dyadic;
struct LongCoordinate;

/// |T_a p - T_b q| under two fixed poses. Const methods may run in several threads at once. Cost: some 20 ns when
/// double arithmetic can vouch for the answer, up to a microsecond when it cannot.
class PCL_BSH_EXPORT_INTERNAL ExactDistance {
public:
  /// A point of each cloud, and how far each reaches.
  struct Pair {
    Point3 p, q;
    double radius_p = 0.0, radius_q = 0.0;
  };

  struct Enclosure {
    double low, high;
  };

  ExactDistance(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b);

  /// T_a p - T_b q by double arithmetic, and how far that may be off as a vector: not finite where nothing is known.
  struct Difference {
    Point3 vector;
    double error;
  };
  Difference approximate(const Point3& p, const Point3& q) const;

  /// Bounds of |T_a p - T_b q| as far as double arithmetic can tell; low may be negative, or both infinite.
  Enclosure enclose(const Point3& p, const Point3& q) const;

  /// Sign of |T_a p - T_b q| - (clearance + radius_p + radius_q): negative, 0 when they are equal, or positive.
  /// The pair collides when the answer is <= 0.
  int compare(const Point3& p, const Point3& q, double clearance, double radius_p = 0.0, double radius_q = 0.0) const;

  /// A length that is a sum, before rounding.
  using Sum = std::array<double, 8>;

  /// Sign of |T_a p - T_b q| - (the sum of the terms of `reach`). @pre finite terms
  int compare(const Point3& p, const Point3& q, const Sum& reach) const;

  /// Sign of gap(first) - gap(second), of the gaps before rounding.
  int compareGaps(const Pair& first, const Pair& second) const { return compareGaps(first, *this, second); }

  /// Sign of gap(first) - other.gap(second), of the gaps before rounding.
  int compareGaps(const Pair& first, const ExactDistance& other, const Pair& second) const;

  /// |T_a p - T_b q| - radius_p - radius_q, rounded to the nearest double (ties to even; infinity beyond the largest).
  double gap(const Pair& pair) const;

private:
  using Row = std::array<double, 4>; // of a pose: rotation, then translation

  Difference approximateTranslated(const Point3& p, const Point3& q) const;
  Enclosure encloseClosely(const Point3& p, const Point3& q) const;
  std::array<LongCoordinate, 3> difference(const Point3& p, const Point3& q) const;
  bool exactDifference(const Point3& p, const Point3& q, Point3& difference) const;
  Dyadic squaredDistance(const Point3& p, const Point3& q) const;

  std::array<Row, 3> a_, b_;
  bool translations_only_;
};

} // namespace pcl_bsh
