// SPDX-License-Identifier: BSD-3-Clause
// Any text as a trajectory: refused with a reason, or poses that are rigid and finite.
#include "refusal.h"

#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/poses/pose_text.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  fuzz::mayRefuse([&] {
    for (const Eigen::Isometry3d& pose : io::parsePoses(text)) {
      const Eigen::Matrix3d error = pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity();
      fuzz::require(pose.matrix().allFinite() && error.norm() <= 2e-6 && pose.linear().determinant() > 0,
                    "a pose that is not rigid");
    }
  });
  fuzz::mayRefuse([&] { io::poseFrom(io::numbersOf(text)); });
  return 0;
}
