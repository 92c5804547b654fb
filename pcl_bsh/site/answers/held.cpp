// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/answers/held.h>

namespace pcl_bsh::site {

Question questionOf(const SiteRequest& request, const Placed& a, const Placed& b,
                    const std::vector<Eigen::Isometry3d>* poses)
{
  Question question;
  question.clearance = request.clearance;
  question.threads = request.threads;
  question.swept = request.swept.value_or(0.0);
  question.solid = true;
  question.pose_of_input = a.pose;
  question.pose = b.pose;
  if (poses) question.path = *poses;
  return question;
}

} // namespace pcl_bsh::site
