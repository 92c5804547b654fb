// SPDX-License-Identifier: BSD-3-Clause
// Where several obstacles are nearest to a site, gathered tile by tile.
#pragma once

#include <pcl_bsh/site/answers/question_part.h>
#include <pcl_bsh/site/site_obstacles.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::site {

/// A result of one tile about an obstacle.
struct NearRecord {
  enum class Kind : std::uint32_t {
    colliding, ///< the smallest distance of points that collide, as along a path
    measured,  ///< the smallest distance of all points over all poses
    enclosed   ///< a place that the obstacle's faces enclose; `pose` is the number of the tile
  };
  std::uint32_t obstacle = 0;
  Kind kind = Kind::measured;
  double distance = 0.0;
  Interval interval = {};
  std::int32_t pose = 0;
  std::uint32_t record = 0; ///< of the obstacle
  SitePoint point = {};
  Point3 place = {0, 0, 0};
};

void append(std::vector<double>& numbers, const NearRecord& near);
NearRecord nearRecordFrom(const double* numbers);
inline constexpr std::size_t near_record_numbers = 12;

/// The records of all tiles.
class NearestRecords {
public:
  explicit NearestRecords(std::size_t obstacles);

  /// Returns an upper bound of the smallest distance of an obstacle, as far as this rank knows.
  double least(std::uint32_t obstacle) const { return least_[obstacle]; }

  /// Lowers the upper bound to a distance.
  void limit(std::uint32_t obstacle, double distance);

  void add(const NearRecord& near);

  /// Gathers the records of all ranks. To be called once by all of them, before tell() and enclosed().
  void gather();

  /// Sets the smallest distance of an obstacle, and its pair. Equal distances are compared once more, exactly.
  void tell(const QuestionPart& part, std::uint32_t obstacle, SiteObstacleAnswer& answer) const;

  /// A place within the obstacle's faces: of several tiles, that of the first.
  std::optional<Point3> enclosed(std::uint32_t obstacle) const;

private:
  std::vector<double> least_;
  std::vector<std::vector<NearRecord>> of_;
};

} // namespace pcl_bsh::site
