// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/leaf/record_course.h>

#include <pcl_bsh/geometry/triangle/vector3.h>

namespace pcl_bsh {
namespace {

Corners inModel(const TrajectoryQuery& query, std::uint32_t record)
{
  Corners corners = cornersOf(query.model.view(), record);
  for (Point3& corner : corners.at) corner = corner - query.boxes.origin;
  return corners;
}

constexpr double kResolution = 0x1p-6; // of the tolerance

/// A record of the model in swept motion: a pose that is not quite rigid stretches it.
MovingCorners stretchingIn(const TrajectoryQuery& query, std::uint32_t record, const PathInterval& interval)
{
  const Corners corners = inModel(query, record);
  MovingCorners moving{{}, {}, {}, corners.count};
  for (std::uint32_t i = 0; i < corners.count; ++i) {
    moving.from[i] = query.path.stretched(interval.first, corners.at[i]);
    moving.way[i] = query.path.stretched(interval.last, corners.at[i]) - moving.from[i];
  }
  return moving;
}

} // namespace

RecordCourse::RecordCourse(const TrajectoryQuery& query, std::uint32_t record, const PathInterval& interval)
: world(cornersOf(query.scan.hierarchy().view(), record))
{
  for (std::uint32_t i = 0; i < world.count; ++i) world.at[i] = carried(query.scan.pose, world.at[i]);
  const Corners first = seenAt(query.path.poses[interval.first]), last = seenAt(query.path.poses[interval.last]);
  arcs.count = world.count;
  for (std::uint32_t i = 0; i < world.count; ++i) {
    arcs.from[i] = first.at[i];
    arcs.way[i] = last.at[i] - first.at[i];
    arcs.bow[i] = {0.0, 0.0, 0.0};
  }
  if (query.path.is_swept || interval.last - interval.first < 2) return;
  const Corners middle = seenAt(query.path.poses[interval.middle()]);
  const double t = static_cast<double>(interval.middle() - interval.first) / (interval.last - interval.first);
  const double bent = 0.25 / (t * (1.0 - t));
  for (std::uint32_t i = 0; i < world.count; ++i)
    arcs.bow[i] = bent * (middle.at[i] - (arcs.from[i] + t * arcs.way[i]));
}

Corners RecordCourse::seenAt(const PathPose& pose) const
{
  Corners seen = world;
  for (std::uint32_t i = 0; i < world.count; ++i) seen.at[i] = pose.see(world.at[i]);
  return seen;
}

Approach RecordCourse::approachTo(const TrajectoryQuery& query, std::uint32_t record, const PathInterval& interval,
                                  double near_enough, bool nearest, double early_enough) const
{
  return approachOf(arcs, stretchingIn(query, record, interval), near_enough, kResolution * *query.request.swept,
                    nearest, early_enough);
}

MovingCorners restingAt(const TrajectoryQuery& query, std::uint32_t record)
{
  const Corners corners = inModel(query, record);
  return {corners.at, {}, {}, corners.count};
}

MovingCorners restingAt(const Point3& place)
{
  return {Corners::of(place).at, {}, {}, 1};
}

} // namespace pcl_bsh
