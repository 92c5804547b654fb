// SPDX-License-Identifier: BSD-3-Clause
// Which distances to the other cloud are wanted: all of DistanceFilter that knows no point type.
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/obstacle_settings.h>

#include <pcl/memory.h>
#include <pcl/types.h>

#include <limits>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The settings that DistanceFilter adds to PCL's, and the query they ask. Lengths are in the clouds' own unit.
///
/// Accuracy: exact() or tolerance(), with which a distance is that much greater than the true one at most.
/// Filtering throws for an accuracy that stops early, because points would be left without a distance.
class DistanceQuery : public ObstacleSettings {
public:
  /// The distances of the points that are kept, both ends inclusive and compared exactly. 0 <= least <= most, and most
  /// may be infinity, or filtering throws. Default: 0 and infinity, all finite points.
  void setFilterLimits(double least, double most) { limits_ = {least, most}; }
  void getFilterLimits(double& least, double& most) const
  {
    least = limits_.first;
    most = limits_.second;
  }

  /// Greater distances are not told but as NaN; which points are kept does not depend on it. >= 0, inclusive, or
  /// filtering throws. Default: infinity, no limit. A small one is faster.
  void setMaxDistance(double max_distance) { max_distance_ = max_distance; }
  double getMaxDistance() const { return max_distance_; }

protected:
  DistanceQuery() = default;
  ~DistanceQuery() = default;
  DistanceQuery(const DistanceQuery&) = default;
  DistanceQuery& operator=(const DistanceQuery& other); ///< all of it, or std::bad_alloc and nothing has changed
  DistanceQuery& operator=(DistanceQuery&&) = default;

  /// @throws std::invalid_argument when a setting is missing or not what its declaration asks for
  PointDistances distances(const PointsView& input);

  /// Parts the input's points, in their order, into those within the limits (if `negative`: those that are not) and the
  /// rest. Points that are not finite are always of the rest. Throws as distances() does.
  /// @param removed may be null
  void select(const PointsView& input, bool negative, pcl::Indices& kept, pcl::Indices* removed);

  /// The same, and the distances as floats, one per record: NaN beyond max_distance, where the record is not finite,
  /// and outside the view's subset.
  void select(const PointsView& input, bool negative, pcl::Indices& kept, pcl::Indices* removed,
              std::vector<float>& distances);

private:
  void requireSettings() const;
  PointDistances within(const PointsView& input, double max_distance);
  double reachOfLimits() const;
  void part(const PointsView& input, const PointDistances& found, bool negative, pcl::Indices& kept,
            pcl::Indices* removed) const;

  std::pair<double, double> limits_ = {0.0, std::numeric_limits<double>::infinity()};
  double max_distance_ = std::numeric_limits<double>::infinity();

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
