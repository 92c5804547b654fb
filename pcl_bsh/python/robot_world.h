// SPDX-License-Identifier: BSD-3-Clause
// Python's RobotWorld, made and changed. A change that is refused leaves it as it was.
#pragma once

#include <pcl_bsh/python/of_clouds.h>
#include <pcl_bsh/python/robot_model.h>
#include <pcl_bsh/python/typed.h>
#include <pcl_bsh/robot/robot_world.h>

#include <memory>
#include <string>
#include <vector>

namespace pcl_bsh::python {

using ObstaclesLike =
    As<"Union[SphereHierarchy, npt.NDArray[Any], Sequence[Union[SphereHierarchy, npt.NDArray[Any]]]]">;
using PosesLike = As<"Union[npt.NDArray[Any], Sequence[npt.ArrayLike]]">;

/// Python's RobotWorld.
struct PyWorld {
  using Placed = OfClouds<robots::RobotWorld>;
  using Obstacles = std::vector<std::shared_ptr<Cloud>>;

  std::shared_ptr<RobotModel> robot;
  Obstacles obstacles;
  robots::WorldOptions options;
  std::vector<Eigen::Isometry3d> poses; ///< of obstacles; none: they stand where they are given
  std::shared_ptr<const Placed> placed; ///< replaced while the interpreter's lock is held
};

/// @throws as robots::RobotWorld does
std::unique_ptr<PyWorld> makeWorld(const std::shared_ptr<RobotModel>& robot, const ObstaclesLike& obstacles,
                                   double clearance, double self_clearance, double tolerance, bool with_self,
                                   const PoseLike& base, const OptionalArray& joint_uncertainties);

void setObstacles(PyWorld& world, const ObstaclesLike& obstacles);
void setObstaclePoses(PyWorld& world, const PosesLike& poses);
void setBase(PyWorld& world, const ArrayLike& base);
void attachTo(PyWorld& world, const std::string& name, const std::string& link, std::vector<robots::Shape> shapes,
              const std::vector<std::string>& ignored);
void detachFrom(PyWorld& world, const std::string& name);

} // namespace pcl_bsh::python
