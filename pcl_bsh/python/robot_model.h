// SPDX-License-Identifier: BSD-3-Clause
// Python's Robot, and states of one as arrays.
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/arrays/array_layout.h>
#include <pcl_bsh/python/typed.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/robot/kinematics.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::python {

/// A robot as its files describe it, checked.
struct RobotModel {
  RobotModel(robots::Robot read, io::RobotGroups of) : robot(std::move(read)), groups(std::move(of)), kinematics(robot)
  {
  }

  const robots::Robot robot;
  const io::RobotGroups groups;
  const robots::Kinematics kinematics;
};

/// One state, or a row for each of several.
struct States {
  std::vector<robots::RobotState> rows;
  bool is_one = false; ///< (J,), not (n, J)
};

/// A pose that is rigid within 1e-6, made so to the last digits. @throws InvalidInput naming it
inline Eigen::Isometry3d rigidPoseOf(const std::string& name, const PoseLike& given)
{
  const Eigen::Isometry3d pose = poseOf(name, given);
  checkPose(name, pose);
  return robots::rigidPose(pose);
}

inline States statesOf(const std::string& name, const ArrayLike& states, const RobotModel& model)
{
  const auto joints = static_cast<py::ssize_t>(model.kinematics.variables());
  py::array array = asArray(name, states, Input::motion);
  const bool is_one = array.ndim() == 1;
  if (!(is_one || array.ndim() == 2) || array.shape(array.ndim() - 1) != joints)
    throw InvalidInput(Input::motion, name, "has shape " + shapeOf(array),
                       "give (J,) or (n, J), with a value for each of the " + std::to_string(joints) + " joints of " +
                           model.robot.name);
  const py::ssize_t count = is_one ? 1 : array.shape(0);
  const std::vector<double> values = rowsOf(name, array.reshape({count * joints}), 1);
  States made{std::vector<robots::RobotState>(static_cast<std::size_t>(count)), is_one};
  for (py::ssize_t i = 0; i < count; ++i)
    made.rows[static_cast<std::size_t>(i)].assign(values.begin() + i * joints, values.begin() + (i + 1) * joints);
  return made;
}

} // namespace pcl_bsh::python
