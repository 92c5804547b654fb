// SPDX-License-Identifier: BSD-3-Clause
// The other cloud of a question, and its pose.
#pragma once

#include <pcl_bsh/filters/pipeline/option_type.h>
#include <pcl_bsh/io/poses/rigid_pose.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::pipeline {

/// A matrix of few printed digits stands for its nearest rotation, with a warning; nothing stands for no motion. What
/// is farther from rigid stays as it is, for the query to refuse.
inline Eigen::Isometry3d rigidPoseOf(const std::optional<Pose>& pose, std::vector<std::string>& warnings)
{
  Eigen::Isometry3d only = Eigen::Isometry3d::Identity();
  if (pose) only.matrix() = pose->matrix;
  const io::RigidPose rigid = io::nearestRigid(only);
  if (rigid.deviation > 0) warnings.push_back("pose: " + io::nearestRotationWarning(rigid.deviation));
  return rigid.pose;
}

/// Shares the ownership of what it points into.
inline std::shared_ptr<const pcl::PCLPointCloud2> pointsOf(const StageCloudPtr& cloud)
{
  return {cloud, &cloud->cloud};
}

} // namespace pcl_bsh::pipeline
