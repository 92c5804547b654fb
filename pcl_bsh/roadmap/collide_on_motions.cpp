// SPDX-License-Identifier: BSD-3-Clause
// Many motions as a whole: what collides at a pose, the order of the motions that are left, and their batches.
#include <pcl_bsh/roadmap/collide_on_motions.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/roadmap/check_motions.h>
#include <pcl_bsh/roadmap/collide_at_poses.h>
#include <pcl_bsh/roadmap/motion_batch.h>
#include <pcl_bsh/roadmap/pose_tasks.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr double kAtPoses = 0.25; ///< of the progress

/// Those poses of a list that motions name.
struct UsedPoses {
  UsedPoses(const PoseList& poses, const std::vector<PoseMotion>& motions) : list(poses), place(poses.size(), kUnused)
  {
    for (const PoseMotion& motion : motions) place[motion.from] = place[motion.to] = 0;
    for (std::size_t k = 0; k < place.size(); ++k) {
      if (place[k] == kUnused) continue;
      place[k] = static_cast<std::uint32_t>(indices.size());
      indices.push_back(static_cast<std::uint32_t>(k));
    }
  }

  std::size_t size() const { return indices.size(); }
  Eigen::Isometry3d operator[](std::size_t i) const { return list[indices[i]]; }

  static constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

  const PoseList& list;
  std::vector<std::uint32_t> place; ///< of a pose of the list, among those that are used
  std::vector<std::uint32_t> indices;
};

/// About where motions have their middles: enough to order them.
struct RoughMiddles {
  std::size_t size() const { return open.size(); }
  Eigen::Isometry3d operator[](std::size_t i) const
  {
    const PoseMotion& motion = motions[open[i]];
    Eigen::Isometry3d middle = Eigen::Isometry3d::Identity();
    middle.matrix().topRows<3>() =
        0.5 * (poses[motion.from].matrix().topRows<3>() + poses[motion.to].matrix().topRows<3>());
    return middle;
  }

  const PoseList& poses;
  const std::vector<PoseMotion>& motions;
  const std::vector<std::uint32_t>& open;
};

MotionBatch batchOf(const MotionsQuery& query, const PoseList& poses, const std::vector<PoseMotion>& motions,
                    const std::vector<std::uint32_t>& some, const BodyBall& body)
{
  MotionBatch batch{query, {query.scan, query.model, body, {}}, {}};
  batch.middles.poses.reserve(some.size());
  batch.middles.extents.reserve(some.size());
  batch.motions.reserve(some.size());
  for (const std::uint32_t m : some) {
    const RigidMotion& motion =
        batch.motions.emplace_back(motionBetween(poses[motions[m].from], poses[motions[m].to], query.request.pivot));
    batch.middles.poses.push_back(motion.at(0.5));
    batch.middles.extents.push_back(extentAround(batch.middles.poses.back(), motion, body));
  }
  return batch;
}

/// Of the motions in `open`, which do not collide at their poses, gives those that do between them a verdict.
/// @param begin, end of the progress
Work decideOpen(const MotionsQuery& query, const PoseList& poses, const std::vector<PoseMotion>& motions,
                const std::vector<std::uint32_t>& open, double begin, double end, Verdict verdict,
                std::vector<std::uint8_t>& verdicts)
{
  const std::function<bool(double)> report = [&](double done) {
    return !query.request.progress || query.request.progress(begin + (end - begin) * done);
  };
  Progress progress(report);
  const BodyBall body(query.model);
  const unsigned threads = threadCount(query.request.threads);
  const std::vector<std::uint32_t> order = orderOf(RoughMiddles{poses, motions, open}, body, threads);
  const std::size_t batches = (order.size() + kBatchPoses - 1) / kBatchPoses;
  return forEachPart(batches, threads, progress, [&](std::size_t b) {
    const std::size_t first = b * kBatchPoses, last = std::min(order.size(), first + kBatchPoses);
    std::vector<std::uint32_t> some;
    some.reserve(last - first);
    for (std::size_t i = first; i < last; ++i) some.push_back(open[order[i]]);
    bool found[kBatchPoses] = {};
    const Work work = anyOfMotionBatch(batchOf(query, poses, motions, some, body), found, progress);
    for (std::size_t i = 0; i < some.size(); ++i)
      if (found[i]) verdicts[some[i]] = flagOf(verdict);
    return work;
  });
}

std::vector<std::uint32_t> withVerdict(const std::vector<std::uint8_t>& verdicts, Verdict verdict)
{
  std::vector<std::uint32_t> some;
  for (std::size_t m = 0; m < verdicts.size(); ++m)
    if (verdicts[m] == flagOf(verdict)) some.push_back(static_cast<std::uint32_t>(m));
  return some;
}

/// The verdict of a motion from those at its poses: certainty counts more than a possibility.
std::uint8_t worse(std::uint8_t one, std::uint8_t other)
{
  if (one == flagOf(Verdict::colliding) || other == flagOf(Verdict::colliding)) return flagOf(Verdict::colliding);
  return std::max(one, other);
}

} // namespace

AnyOnMotions anyCollisionOnMotions(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                                   const std::vector<PoseMotion>& motions, const MotionsRequest& request)
{
  check(scan, poses, motions, request);
  const DefaultFloatEnvironment environment;
  AnyOnMotions result;
  result.verdicts.assign(motions.size(), flagOf(Verdict::free));
  if (scan.hierarchy().empty() || model.empty() || motions.empty()) return result;
  MotionsQuery query(scan, model, request);
  result.work.volumes_built += countChildren(query.boxes.storage.top);
  const UsedPoses used(poses, motions);
  checkSwept(query, poses, used.indices, motions);

  AnyRequest at_poses;
  at_poses.clearance = request.clearance;
  at_poses.threads = request.threads;
  const AnyAtPoses found = anyCollisionAtPoses(
      scan, model, used, at_poses, [&](double done) { return !request.progress || request.progress(kAtPoses * done); });
  result.work += found.work;

  for (std::size_t m = 0; m < motions.size(); ++m)
    result.verdicts[m] = worse(found.verdicts[used.place[motions[m].from]], found.verdicts[used.place[motions[m].to]]);
  const auto decide = [&](Verdict open, Verdict verdict, double begin, double end) {
    const std::vector<std::uint32_t> some = withVerdict(result.verdicts, open);
    if (!some.empty()) result.work += decideOpen(query, poses, motions, some, begin, end, verdict, result.verdicts);
  };
  if (areUncertain(scan, {model})) {
    constexpr double middle = 0.5 * (kAtPoses + 1.0);
    decide(Verdict::free, Verdict::undecided, kAtPoses, middle);
    query.ask(Places::certain);
    decide(Verdict::undecided, Verdict::colliding, middle, 1.0);
  }
  else {
    decide(Verdict::free, Verdict::colliding, kAtPoses, 1.0);
  }
  result.colliding = countOf(result.verdicts, Verdict::colliding);
  result.undecided = countOf(result.verdicts, Verdict::undecided);
  return result;
}

} // namespace pcl_bsh
