// SPDX-License-Identifier: BSD-3-Clause
// Objects at random places in a box, which move at random velocities and are reflected by its sides.
#pragma once

#include <pcl_bsh/scene/scene.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

namespace pcl_bsh::io {

struct ScatterBox {
  Eigen::Vector3d low, high;
  double speed = 0;    ///< at most, along each axis, per second
  double duration = 0; ///< seconds for which motions are needed
};

class ScatteredMotions {
public:
  ScatteredMotions(const ScatterBox& box, std::uint64_t seed) : box_(box), engine_(seed) {}

  /// The next object's way: a pose at time 0, at each reflection and at the end. One of speed 0 stays where it is.
  /// @param reflections_left reduced by those of this object
  /// @return nothing when it needs more reflections than are left
  std::optional<WaypointMotion> next(std::size_t& reflections_left);

private:
  std::optional<WaypointMotion> follow(Eigen::Vector3d place, Eigen::Vector3d velocity, std::size_t& reflections_left);
  double uniform(); ///< in [0, 1)

  ScatterBox box_;
  std::mt19937_64 engine_;
};

} // namespace pcl_bsh::io
