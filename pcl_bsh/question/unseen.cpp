// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/unseen.h>

#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/seen/unseen_points.h>

namespace pcl_bsh {
void lookAround(const Question& question, Shape& input, Shape& obstacle, Answer& answer)
{
  const SphereHierarchy& model = obstacle.hierarchy(question.uncertaintyOfObstacle(), question.threads);
  const SphereHierarchy& scan = input.hierarchy(question.uncertaintyOfInput(), question.threads);
  const SeenSpace& seen = input.seen(question.origin, question.seen_angle, question.threads);
  Answer::Unseen& unseen = answer.unseen;
  for (std::size_t i = 0; i < seen.size(); ++i) unseen.angles.push_back(seen.angle(i));
  FlagsRequest flags;
  flags.clearance = question.clearance.value_or(0.0);
  flags.threads = question.threads;
  flags.flagged = Side::b;
  UnseenRequest request;
  request.clearance = flags.clearance;
  request.threads = question.threads;
  answer.obstacle_flags.assign(model.view().count, Verdict::free);
  FlagsResult found;
  const std::vector<Eigen::Isometry3d> poses = question.poses();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (question.progress && !question.progress(1.0)) throw Cancelled(); // all but this is done
    const Placed placed(model, poses[k]);
    collisionFlags(scan, placed, flags, found);
    answer.work += found.work;
    answer.work += markUnseen(seen, placed, request, found.b).work;
    unseen.at_poses.push_back(countOf(found.b, Verdict::unseen));
    if (unseen.at_poses.back() > 0 && !unseen.first_pose) unseen.first_pose = k;
    for (std::size_t i = 0; i < found.b.size(); ++i)
      answer.obstacle_flags[i] = graver(answer.obstacle_flags[i], found.b[i]);
  }
  unseen.count = countOf(answer.obstacle_flags, Verdict::unseen);
}

} // namespace pcl_bsh
