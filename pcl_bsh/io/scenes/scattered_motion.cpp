// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/scenes/scattered_motion.h>

#include <cmath>

namespace pcl_bsh::io {

double ScatteredMotions::uniform()
{
  return std::ldexp(static_cast<double>(engine_() >> 11), -53);
}

std::optional<WaypointMotion> ScatteredMotions::next(std::size_t& reflections_left)
{
  Eigen::Vector3d place, velocity;
  for (int k = 0; k < 3; ++k) {
    place[k] = box_.low[k] + uniform() * (box_.high[k] - box_.low[k]);
    velocity[k] = box_.speed * (2.0 * uniform() - 1.0);
  }
  return follow(place, velocity, reflections_left);
}

std::optional<WaypointMotion> ScatteredMotions::follow(Eigen::Vector3d place, Eigen::Vector3d velocity,
                                                       std::size_t& reflections_left)
{
  WaypointMotion motion;
  double time = 0.0;
  for (;;) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = place;
    motion.times.push_back(time);
    motion.poses.push_back(pose);
    if (time >= box_.duration || !(box_.speed > 0.0)) return motion;
    double free = box_.duration - time; // until the first side, or the end
    int side = -1;
    for (int k = 0; k < 3; ++k) {
      if (velocity[k] == 0.0) continue;
      const double until = ((velocity[k] > 0.0 ? box_.high[k] : box_.low[k]) - place[k]) / velocity[k];
      if (until >= free) continue;
      free = until;
      side = k;
    }
    place = (place + free * velocity).cwiseMax(box_.low).cwiseMin(box_.high);
    if (side >= 0) {
      velocity[side] = -velocity[side];
      if (reflections_left-- == 0) return std::nullopt;
    }
    if (!(free > 1e-9)) { // caught in a corner or between sides that touch
      velocity.setZero();
      free = box_.duration - time;
    }
    time += free;
  }
}

} // namespace pcl_bsh::io
