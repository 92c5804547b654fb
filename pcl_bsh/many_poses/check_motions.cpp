// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/many_poses/motions_query.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/many_poses/batches.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/trajectory/check_trajectory.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace pcl_bsh {
namespace {

std::string nameOf(const std::vector<PoseMotion>& motions, std::size_t m)
{
  return plainText("motion ", m, ", from pose ", motions[m].from, " to pose ", motions[m].to);
}

/// Whether neither the turn nor the way of a motion can be one that is refused: most are settled here, without the
/// axis and the angle of their turn.
bool isPlain(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, const PosePath::Sweep& sweep)
{
  const double turned = from.linear().cwiseProduct(to.linear()).sum(); // 1 + 2 cos of the angle; -1 for half a turn
  if (!(turned > -0.99)) return false;
  const Eigen::Vector3d pivot(sweep.pivot[0], sweep.pivot[1], sweep.pivot[2]);
  const double way = 2.0 * (to * pivot - from * pivot).norm() + sweep.rounding;
  const double reach = sweep.radius + sweep.reach + way;
  const Bow most = bowSeenByBody(std::numbers::pi, way);
  const double parts = 2.0 + std::sqrt((most.turn * reach + most.drift) / sweep.stray);
  return parts < PosePath::kMostPoses && 0x1p-51 * parts * (way + std::numbers::pi * reach) < sweep.rounding;
}

/// Whether a swept path refuses the motion.
bool isRefused(const MotionsQuery& query, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to,
               const PosePath::Sweep& sweep)
{
  if (isPlain(from, to, sweep)) return false;
  const RigidMotion motion = motionBetween(from, to, query.request.pivot);
  const std::function<bool(double)> silent;
  Progress progress(silent);
  try {
    PosePath::check({motion.from(), motion.to()}, sweep, progress);
  }
  catch (const InvalidInput&) {
    return true;
  }
  return false;
}

} // namespace

void check(const Placed& scan, const PoseList& poses, const std::vector<PoseMotion>& motions,
           const MotionsRequest& request)
{
  checkClearance(request.clearance);
  checkSwept(request.swept);
  checkPivot(request.pivot);
  checkPose("pose of the scan", scan.pose);
  checkPoses(poses, "the model", request.threads);
  constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
  if (motions.size() > most)
    throw InvalidInput(Input::motion, "motions",
                       plainText(motions.size(), " are more than an index can name (", most, ")"),
                       "ask for fewer at a time");
  for (std::size_t m = 0; m < motions.size(); ++m)
    if (motions[m].from >= poses.size() || motions[m].to >= poses.size())
      throw InvalidInput(Input::motion, nameOf(motions, m), "the list has " + counted(poses.size(), "pose"),
                         "name poses by their indices in the list, from 0")
          .withIndex(m);
}

void checkSwept(const MotionsQuery& query, const PoseList& poses, const std::vector<std::uint32_t>& used,
                const std::vector<PoseMotion>& motions)
{
  const double reach = reachOf(query.swept, reachBetween(query.scan, {query.model}, query.request.clearance,
                                                         possiblePlaces(query.scan, {query.model})));
  double far = 0.0;
  for (const std::uint32_t k : used) far = std::max(far, farthestPlace(poses[k], query.boxes, query.request.pivot));
  checkTolerance(query.scan, query.swept, query.boxes, reach, far);

  const PosePath::Sweep sweep = sweepOf(query.swept, query.boxes, reach);
  const std::size_t wrong = firstWrong(motions.size(), query.request.threads, [&](std::size_t m) {
    return isRefused(query, poses[motions[m].from], poses[motions[m].to], sweep);
  });
  if (wrong == motions.size()) return;
  if (isHalfTurn(shorterTurn(poses[motions[wrong].from].linear(), poses[motions[wrong].to].linear())))
    throw InvalidInput(Input::motion, nameOf(motions, wrong), "half a turn, both directions are as short",
                       "give a pose between them")
        .withIndex(wrong);
  throw InvalidInput(Input::swept, "swept", plainText(query.request.swept, ": too small for ", nameOf(motions, wrong)),
                     "give a larger tolerance, or poses that are nearer to each other")
      .withIndex(wrong)
      .withValue(query.request.swept);
}

} // namespace pcl_bsh
