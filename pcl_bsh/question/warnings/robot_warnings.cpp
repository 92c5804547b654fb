// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/robot_warnings.h>

namespace pcl_bsh {

std::optional<Warning> warningOfHoles(const NamedCloud& obstacle, const std::string& robot, double clearance)
{
  NamedCloud links;
  links.name = robot;
  links.is_surface = true;
  links.box.extend(Eigen::Vector3d::Zero()); // it is something
  return warningOfDensity(obstacle, links, clearance);
}

} // namespace pcl_bsh
