// SPDX-License-Identifier: BSD-3-Clause
// Validators of somebody else's planner, for a slide that carries a ball past a point.
#include <pcl_bsh/ompl/joint_space.h>
#include <pcl_bsh/ompl/validators.h>

#include <ompl/base/ScopedState.h>

#include <memory>

int main()
{
  pcl_bsh::robots::Joint slide{"slide", pcl_bsh::robots::Joint::Kind::prismatic, 0};
  slide.lower = 0.0, slide.upper = 2.0;
  const pcl_bsh::robots::Robot robot{"carriage", {{"rail", {}, {}}, {"ball", {{pcl_bsh::robots::Sphere{0.1}}}, slide}}};
  const float xyz[] = {1, 0, 0};
  const pcl_bsh::SphereHierarchy cloud(pcl_bsh::viewOf(xyz, 1));
  const auto world =
      std::make_shared<pcl_bsh::robots::RobotWorld>(robot, std::vector<const pcl_bsh::SphereHierarchy*>{&cloud});

  const auto space = std::make_shared<pcl_bsh::ompl::JointSpace>(robot);
  const auto information = std::make_shared<ompl::base::SpaceInformation>(space);
  information->setStateValidityChecker(std::make_shared<pcl_bsh::ompl::StateValidity>(information, world));
  information->setMotionValidator(std::make_shared<pcl_bsh::ompl::MotionValidity>(information, world));
  information->setup();
  ompl::base::ScopedState<> from(space), to(space), beyond(space);
  from[0] = 0.0, to[0] = 0.8, beyond[0] = 2.0;
  return information->checkMotion(from.get(), to.get()) && !information->checkMotion(from.get(), beyond.get()) &&
                 information->isValid(beyond.get())
             ? 0
             : 1;
}
