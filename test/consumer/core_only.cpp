// SPDX-License-Identifier: BSD-3-Clause
// The core alone: C++17, Eigen, no PCL.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/version.h>

#include <cstdio>
#include <vector>

static_assert(PCL_BSH_VERSION >= 100);

/// An exception of the library is caught by its type, though this program hides its own symbols.
bool catchesWhatIsThrown(const pcl_bsh::SphereHierarchy& cloud)
{
  try {
    pcl_bsh::FlagsRequest request;
    request.clearance = -1.0;
    pcl_bsh::collisionFlags({cloud}, {cloud}, request);
  }
  catch (const pcl_bsh::InvalidInput& error) {
    std::printf("refused: %s\n", error.what());
    return true;
  }
  return false;
}

/// collide.h alone brings all of these.
bool asksEverything(const pcl_bsh::SphereHierarchy& a, const pcl_bsh::SphereHierarchy& b)
{
  const pcl_bsh::Effort effort(2);
  const double between = pcl_bsh::hausdorffDistance({a}, {b}, pcl_bsh::HausdorffRequest(effort)).distance;
  const bool same = pcl_bsh::pointDistances({b}, {a}).distance.at(0) <= between;
  const std::vector<Eigen::Isometry3d> path = {Eigen::Isometry3d::Identity()};
  pcl_bsh::TrajectoryRequest along;
  along.clearance = 0.5;
  return same && pcl_bsh::collidingIndices({a}, {b}, {0.5}).a.size() == 1 &&
         !pcl_bsh::pairsWithin({a}, {b}, {0.5}).pairs.empty() &&
         pcl_bsh::collideAlong({a}, b, path, along).colliding == 1;
}

int main()
{
  const float wall[] = {0, 0, 0, 0, 1, 0, 0, 2, 0};
  const double robot[] = {0.5, 1, 0};
  const pcl_bsh::SphereHierarchy a(pcl_bsh::viewOf(wall, 3)), b(pcl_bsh::viewOf(robot, 1));

  pcl_bsh::FlagsRequest request;
  request.clearance = 0.5;
  const auto found = pcl_bsh::collisionFlags({a}, {b}, request);
  const auto expected = pcl_bsh::brute_force::collisionFlags({a}, {b}, request);
  std::printf("%zu colliding point(s), smallest distance %g\n", found.colliding_a,
              pcl_bsh::closestPair({a}, {b}).distance);
  return catchesWhatIsThrown(a) && asksEverything(a, b) && found.colliding_a == 1 && found.a == expected.a ? 0 : 1;
}
