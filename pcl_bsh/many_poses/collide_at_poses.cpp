// SPDX-License-Identifier: BSD-3-Clause
// Many poses, one after the other: the last witness is tried first.
#include <pcl_bsh/many_poses/collide_at_poses.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/many_poses/batches.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <limits>
#include <optional>
#include <utility>

namespace pcl_bsh {
namespace {

void checkAtPoses(const Placed& a, const PoseList& poses, const Accuracy& accuracy, unsigned threads)
{
  checkAccuracy(accuracy);
  if (accuracy.stopsEarly())
    throw InvalidInput(Input::accuracy, "accuracy", accuracy.text() + " stops early, which many poses at once do not",
                       "give exact or tolerance=LENGTH");
  checkPose("pose of a", a.pose);
  checkPoses(poses, "b", threads);
}

} // namespace

void checkPoses(const PoseList& poses, const char* whose, unsigned threads)
{
  constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
  if (poses.size() > most)
    throw InvalidInput(Input::pose, "poses", plainText(poses.size(), " are more than an index can name (", most, ")"),
                       "ask for fewer at a time");
  const std::size_t wrong = firstWrong(poses.size(), threads, [&](std::size_t i) { return !isRigid(poses[i]); });
  if (wrong < poses.size()) checkPose(plainText("pose ", wrong, " of ", whose), poses[wrong], wrong);
}

namespace {

/// @param memory of an earlier result
AnyAtPoses answer(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b, const AnyRequest& request,
                  AnyAtPoses&& memory)
{
  checkClearance(request.clearance);
  checkAtPoses(a, T_world_b, request.accuracy, request.threads);
  const DefaultFloatEnvironment environment;
  AnyAtPoses result;
  result.flags.swap(memory.flags);
  result.flags.assign(T_world_b.size(), Verdict::free);
  if (a.hierarchy().empty() || b.empty() || T_world_b.size() == 0) return result;
  const AnyRequest single{request.clearance, {request.accuracy, 1}};
  const MeantPlaces certain = certainPlaces(a, {b});
  Progress progress(request.progress);
  result.work = forEachInBatches(T_world_b.size(), request.threads, progress, [&] {
    return [&, last = std::optional<PointPair>()](std::size_t i, Work& work) mutable {
      const Placed posed{b, T_world_b[i]};
      if (last && PointPairs(a, posed, request.clearance, certain).collide(*last, work)) {
        result.flags[i] = Verdict::colliding;
        return;
      }
      const AnyResult found = anyCollision(a, posed, single);
      result.flags[i] = found.verdict;
      work += found.work;
      if (found.pair && request.accuracy.isExact()) last = found.pair;
    };
  });
  result.colliding = countOf(result.flags, Verdict::colliding);
  result.undecided = countOf(result.flags, Verdict::undecided);
  return result;
}

/// @param memory of an earlier result
DistancesAtPoses answer(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                        const DistanceRequest& request, DistancesAtPoses&& memory)
{
  checkMaxDistance(request.max_distance);
  checkAtPoses(a, T_world_b, request.accuracy, request.threads);
  const DefaultFloatEnvironment environment;
  DistanceRequest at_pose(request.accuracy, 1);
  at_pose.max_distance = request.max_distance;
  DistancesAtPoses result;
  result.distances.swap(memory.distances);
  result.pairs.swap(memory.pairs);
  result.pairs.clear();
  result.distances.assign(T_world_b.size(), std::numeric_limits<double>::infinity());
  if (a.hierarchy().empty() || b.empty() || T_world_b.size() == 0) return result;
  Progress progress(request.progress);
  result.pairs.resize(T_world_b.size());
  result.work = forEachInBatches(T_world_b.size(), request.threads, progress, [&] {
    return [&](std::size_t i, Work& work) {
      const DistanceResult found = closestPair(a, {b, T_world_b[i]}, at_pose);
      result.distances[i] = found.distance;
      result.pairs[i] = found.pair.value_or(PointPair{kNothing, kNothing});
      work += found.work;
    };
  });
  return result;
}

} // namespace

AnyAtPoses anyCollisionAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                               const AnyRequest& request)
{
  return answer(a, b, T_world_b, request, {});
}

void anyCollisionAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                         const AnyRequest& request, AnyAtPoses& result)
{
  result = answer(a, b, T_world_b, request, std::exchange(result, {}));
}

DistancesAtPoses closestPairAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                                    const DistanceRequest& request)
{
  return answer(a, b, T_world_b, request, {});
}

void closestPairAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                        const DistanceRequest& request, DistancesAtPoses& result)
{
  result = answer(a, b, T_world_b, request, std::exchange(result, {}));
}

} // namespace pcl_bsh
