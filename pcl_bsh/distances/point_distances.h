// SPDX-License-Identifier: BSD-3-Clause
// How far each point of one cloud is from another cloud, and from which of its points.
//
//   SphereHierarchy before(viewOf(before_xyz, n)), after(viewOf(after_xyz, m));
//   PointDistancesRequest request;
//   request.max_distance = 2.0;                                      // in the clouds' unit; inclusive
//   PointDistances change = pointDistances({after}, {before}, request);
//   // change.distance[i]: from record i of `after` to the nearest point of `before`, NaN where that is farther than 2
//
// The distance of triangles is that of the nearest places: so distances of a triangle of a are from its nearest place,
// and means and percentiles are of these. The Hausdorff distance of surfaces is that of their farthest places.
//
// The distance of points p and q is |T_a p - T_b q|, less the points' radii where given: then it may be negative. The
// nearest point is the one that exact arithmetic on the given numbers finds, of several the smallest record. Equal
// input gives equal answers, bit for bit, for any number of threads and any processor.
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Options of pointDistances() and symmetricDistances(). With a tolerance each distance is within it of the smallest;
/// which points have one is exact all the same. Accuracies that stop early (level, pairs, time) give an interval for
/// each point, and a distance where the search came to its end. All points that one call asks about share the pairs and
/// the time.
struct PointDistancesRequest : Effort {
  /// Points of a that have no point of b within it get no distance; >= 0, inclusive, infinity for no limit.
  double max_distance = std::numeric_limits<double>::infinity();
};

/// Vectors have one entry per record of the view of a.
struct PointDistances {
  /// To the nearest point of b, in the clouds' unit, rounded to the nearest double. NaN: no point of b within
  /// max_distance, undecided, or no point of a (its record is not finite, or outside the view's subset).
  std::vector<double> distance;
  std::vector<std::uint32_t> closest_point; ///< its record, of several the smallest; kNothing where NaN
  /// Holds each point's distance for certain, whether within max_distance or not; from max_distance to infinity where
  /// it is proven to be farther than that, and NaN where the record is no point. Empty when the accuracy is exact, for
  /// then the doubles beside `distance` do the same, unless a solid was added that holds triangles
  /// (question/enclosed.h).
  std::vector<Interval> interval;
  std::size_t measured = 0;  ///< points that have a distance
  std::size_t undecided = 0; ///< points that may have one within max_distance, but were left when the search stopped
  /// The greatest of all distances (from points of a to b, the directed Hausdorff distance, where every point has one),
  /// and the pair that realises it, of several the smallest (a, b). NaN and none where no point has one.
  double greatest = std::numeric_limits<double>::quiet_NaN();
  std::optional<PointPair> greatest_pair;
  Work work;
};

/// The distance from each point of a to b.
/// @throws std::invalid_argument when max_distance is negative or NaN, when the accuracy or a pose is not what its
///   declaration asks for. Cancelled.
PointDistances pointDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request = {});

/// Writes into a result whose memory is used again. After an exception the result is empty.
void pointDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request, PointDistances& result);

/// The distances of some records of a alone. The others get the entries of records that are no points.
/// @param records of a's view
PointDistances pointDistances(const Placed& a, const std::vector<std::uint32_t>& records, const Placed& b,
                              const PointDistancesRequest& request = {});

/// Both directions.
struct SymmetricDistances {
  PointDistances a; ///< from each point of a to b
  PointDistances b; ///< from each point of b to a
  /// The symmetric Hausdorff distance: of points the greatest of all, of surfaces as HausdorffDistance::distance. NaN
  /// where a record of either cloud has no distance, because it is farther than max_distance or undecided, or the other
  /// cloud is empty. For surfaces, NaN also where the accuracy stops early. Then it is not known.
  double hausdorff = std::numeric_limits<double>::quiet_NaN();
  std::optional<PointPair> hausdorff_pair; ///< that realises it, of several the smallest (a, b)
  /// Holds that distance for certain, as HausdorffDistance::interval does; the accuracy's tolerance applies to it. NaN
  /// where not known.
  Interval hausdorff_interval{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  Work hausdorff_work; ///< of surfaces: of the Hausdorff distance alone
};

/// Distances from each cloud to the other. A count of sphere tests, or a time, is for both together.
/// @throws as pointDistances() does
SymmetricDistances symmetricDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request = {});

/// Writes into a result whose memory is used again. After an exception the result is empty.
void symmetricDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request,
                        SymmetricDistances& result);

/// Options of hausdorffDistance(). For points it is exact. For surfaces a tolerance says how wide the interval may be;
/// without one it is kHausdorffShare of the larger box's diagonal.
struct HausdorffRequest : Effort {
  using Effort::Effort;
  /** Sets all. */ HausdorffRequest(Effort effort) : Effort(std::move(effort)) {}
  HausdorffRequest() = default;
};

/// Greatest width of the interval of a Hausdorff distance of surfaces, as a share of the larger box's diagonal.
inline constexpr double kHausdorffShare = 0x1p-14;

/// Result of hausdorffDistance().
struct HausdorffDistance {
  /// The greatest distance from a place of either cloud to the other cloud, in the clouds' unit, rounded to the nearest
  /// double: of points exactly, of surfaces that of the farthest place which was measured. NaN where a cloud is empty.
  double distance = std::numeric_limits<double>::quiet_NaN();
  /// Holds the greatest distance for certain; of points both ends are `distance`. It may be wider than the tolerance
  /// where doubles do not tell places apart, or where a million divisions of triangles were not enough.
  Interval interval{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  std::optional<PointPair> pair; ///< that realises it; of points, the smallest (a, b) of several
  Work work; ///< of points with several threads: depends on which is the first to measure a great distance
};

/// The symmetric Hausdorff distance alone: the one that symmetricDistances() returns without a limit, bit for bit, for
/// less work. For surfaces all their places count: triangles are divided, the one that may be the farthest first, until
/// the interval is narrow enough. From a triangle to a record, the greatest distance is that of a corner. Points that
/// are certainly nearer than one that was measured are left out (Taha and Hanbury, "An efficient algorithm for
/// calculating the exact Hausdorff distance", IEEE TPAMI 37(11), 2015), and so are whole nodes.
/// @throws std::invalid_argument when a pose is not what its declaration asks for; an accuracy that stops early.
///   Cancelled.
HausdorffDistance hausdorffDistance(const Placed& a, const Placed& b, const HausdorffRequest& request = {});

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
