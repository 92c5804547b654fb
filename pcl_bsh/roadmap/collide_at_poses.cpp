// SPDX-License-Identifier: BSD-3-Clause
// Many poses as a whole: the order in which neighbours share a search, and their batches.
#include <pcl_bsh/roadmap/collide_at_poses.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/roadmap/batches.h>

#include <limits>
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

/// Each by itself: calls answer(i, pose), from several threads. @return the sum of the work that it returns
template <class Answer>
Work forEachPose(const PoseList& poses, unsigned threads, Progress& progress, const Answer& answer)
{
  return forEachBatch(poses.size(), threads, progress, [&](std::size_t begin, std::size_t end) {
    Work work;
    Pulse pulse;
    for (std::size_t i = begin; i < end; ++i) {
      const Work of_pose = answer(i, poses[i]);
      work += of_pose;
      pulse.count(costInPairs(of_pose) + 64);
    }
    return work;
  });
}

/// Calls answer(batch, order) for batches of poses that are near each other, from several threads: `order` has the
/// poses' indices in the list. Neither cloud is empty. @return the sum of the work that it returns
template <class Answer>
Work forEachNeighborhood(const Placed& a, const SphereHierarchy& b, const PoseList& poses, unsigned threads,
                         Progress& progress, const Answer& answer)
{
  const BodyBall body(b);
  const std::vector<std::uint32_t> order = orderOf(poses, body, threadCount(threads));
  return forEachBatch(order.size(), threads, progress, [&](std::size_t begin, std::size_t end) {
    PoseBatch batch{a, b, body, {}};
    batch.poses.reserve(end - begin);
    for (std::size_t k = begin; k < end; ++k) batch.poses.push_back(poses[order[k]]);
    return answer(batch, order.data() + begin);
  });
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
  if (!request.accuracy.isExact()) {
    const AnyRequest single{request.clearance, {request.accuracy, 1}};
    Progress progress(request.progress);
    result.work = forEachPose(T_world_b, request.threads, progress, [&](std::size_t i, const Eigen::Isometry3d& pose) {
      const AnyResult found = anyCollision(a, {b, pose}, single);
      result.flags[i] = found.verdict;
      return found.work;
    });
  }
  else {
    result.work =
        giveVerdicts(areUncertain(a, {b}), request.progress, 0.0, result.flags,
                     [&](const std::vector<std::uint32_t>& some, Places places, Progress& progress, const auto& mark) {
                       return forEachNeighborhood(a, b, SomePoses{T_world_b, some}, request.threads, progress,
                                                  [&](const PoseBatch& batch, const std::uint32_t* order) {
                                                    bool found[kBatchPoses] = {};
                                                    const Work work = anyOfBatch(batch, request, places, found);
                                                    for (std::size_t i = 0; i < batch.poses.size(); ++i)
                                                      if (found[i]) mark(order[i]);
                                                    return work;
                                                  });
                     });
  }
  result.colliding = countOf(result.flags, Verdict::colliding);
  result.undecided = countOf(result.flags, Verdict::undecided);
  return result;
}

/// @param memory of an earlier result
DistancesAtPoses answer(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                        const DistanceRequest& request, DistancesAtPoses&& memory)
{
  checkAtPoses(a, T_world_b, request.accuracy, request.threads);
  const DefaultFloatEnvironment environment;
  DistancesAtPoses result;
  result.distances.swap(memory.distances);
  result.pairs.swap(memory.pairs);
  result.pairs.clear();
  result.distances.assign(T_world_b.size(), std::numeric_limits<double>::infinity());
  if (a.hierarchy().empty() || b.empty() || T_world_b.size() == 0) return result;
  Progress progress(request.progress);
  result.pairs.resize(T_world_b.size());
  if (request.accuracy.isExact())
    result.work = forEachNeighborhood(
        a, b, T_world_b, request.threads, progress,
        [&](const PoseBatch& batch, const std::uint32_t* order) { return closestOfBatch(batch, order, result); });
  else
    result.work = forEachPose(T_world_b, request.threads, progress, [&](std::size_t i, const Eigen::Isometry3d& pose) {
      const DistanceResult found = closestPair(a, {b, pose}, {request.accuracy, 1});
      result.distances[i] = found.distance;
      result.pairs[i] = *found.pair;
      return found.work;
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
