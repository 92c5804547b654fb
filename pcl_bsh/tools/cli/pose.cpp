// SPDX-License-Identifier: BSD-3-Clause
#include "pose.h"

#include "program.h"

#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/io/text/format_error.h>

#include <filesystem>

namespace pcl_bsh::cli {

Eigen::Isometry3d parsePose(const std::string& option, const std::string& text, std::vector<std::string>& warnings)
{
  if (std::filesystem::exists(text)) {
    const io::RigidPose rigid = io::nearestRigid(io::readPose(text));
    if (rigid.deviation > 0)
      warnings.push_back(option + ": " + text + ": " + io::nearestRotationWarning(rigid.deviation));
    return rigid.pose;
  }
  try {
    const std::vector<double> n = io::numbersOf(text);
    if (const auto warning = io::warningOfAngles(n)) warnings.push_back(option + ": " + *warning);
    if (n.size() == 6) return io::poseFrom(n);
  }
  catch (const io::FormatError&) {
    // Not numbers, and no file either.
  }
  throw UsageError(option + ": '" + text +
                   "' is neither six numbers nor a file: give x,y,z,roll,pitch,yaw or a file name");
}

} // namespace pcl_bsh::cli
