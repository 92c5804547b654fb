// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/roadmap/motion_batch.h>

#include <vector>

namespace pcl_bsh {

/// Refuses values of the request, poses by their index, and motions that name no pose.
void check(const Placed& scan, const PoseList& poses, const std::vector<PoseMotion>& motions,
           const MotionsRequest& request);

/// Refuses motions that cannot be swept, the first one in the list, whatever their verdicts. @pre neither cloud is
/// empty
/// @param used the poses that motions name
void checkSwept(const MotionsQuery& query, const PoseList& poses, const std::vector<std::uint32_t>& used,
                const std::vector<PoseMotion>& motions);

} // namespace pcl_bsh
