// SPDX-License-Identifier: BSD-3-Clause
// Flags at many poses, a pose to a thread.
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/roadmap/collide_at_poses.h>
#include <pcl_bsh/roadmap/pose_tasks.h>

namespace pcl_bsh {

void collisionFlagsAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                           const FlagsRequest& request,
                           const std::function<void(std::size_t pose, const FlagsResult& flags)>& found)
{
  checkClearance(request.clearance);
  checkAtPoses(a, T_world_b, request.accuracy, request.threads);
  FlagsRequest single = request;
  single.threads = 1;
  parallelFor((T_world_b.size() + kFlagPoses - 1) / kFlagPoses, threadCount(request.threads), [&](std::size_t batch) {
    FlagsResult flags;
    const std::size_t end = std::min(T_world_b.size(), (batch + 1) * kFlagPoses);
    for (std::size_t i = batch * kFlagPoses; i < end; ++i) {
      collisionFlags(a, {b, T_world_b[i]}, single, flags);
      found(i, flags);
    }
  });
}

} // namespace pcl_bsh
