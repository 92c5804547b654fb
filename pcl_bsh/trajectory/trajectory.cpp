// SPDX-License-Identifier: BSD-3-Clause
// A trajectory query as a whole: the path, which voxels of the scan come near when, their walks, and what they add up
// to.
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/trajectory/check_trajectory.h>
#include <pcl_bsh/trajectory/strays.h>
#include <pcl_bsh/trajectory/walk.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

void allocate(TrajectoryResult& result, const TrajectoryRequest& request, std::size_t records, std::size_t poses)
{
  const auto sized = [records](bool asked) { return asked ? records : 0; };
  result.flags.assign(sized(request.flags), 0);
  result.distance.assign(sized(request.distances), std::numeric_limits<float>::quiet_NaN());
  result.first_pose.assign(sized(request.first_poses), -1);
  result.closest_pose.assign(sized(request.closest_poses), -1);
  result.closest_point.assign(sized(request.distances || request.closest_poses), TrajectoryResult::kNoPoint);
  if (request.pose_summaries) result.poses.resize(poses);
}

/// Equal poses in a row were looked at once.
void summarize(const TrajectoryQuery& query, TrajectoryResult& result)
{
  const std::vector<PathPose>& poses = query.path.poses;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    PoseSummary summary;
    summary.colliding_points = query.pose_counts[k];
    summary.colliding = summary.colliding_points > 0;
    if (summary.colliding) {
      const PointPair pair = query.nearest_at_pose[k].pair;
      const PointsView &a = query.scan.hierarchy().view(), &b = query.model.view();
      summary.distance = ExactDistance(query.scan.pose, query.given[poses[k].given])
                             .gap({a.point(pair.a), b.point(pair.b), a.radius(pair.a), b.radius(pair.b)});
    }
    const std::size_t next = k + 1 < poses.size() ? poses[k + 1].given : result.poses.size();
    std::fill(result.poses.begin() + poses[k].given, result.poses.begin() + static_cast<std::ptrdiff_t>(next), summary);
  }
}

/// The instant of a place on a swept path.
FirstContact instantOf(const PosePath& path, double time)
{
  const auto k = static_cast<std::size_t>(time);
  const PathPose& pose = path.poses[k];
  if (k + 1 == path.poses.size()) return {pose.given, 0.0};
  const PathPose& next = path.poses[k + 1];
  const double end = next.given == pose.given ? next.fraction : 1.0;
  const double fraction = pose.fraction + (end - pose.fraction) * (time - static_cast<double>(k));
  return {pose.given, std::min(fraction, 1.0 - kDoubleUnit)};
}

/// Takes the given voxels along the trajectory.
std::vector<VoxelResult> followAll(const TrajectoryQuery& query, const StopRule& rule,
                                   const std::vector<std::vector<std::uint32_t>>& near_intervals,
                                   const std::vector<std::uint32_t>& voxels, Progress& progress)
{
  std::vector<VoxelResult> answers(voxels.size());
  const auto walk = [&](std::size_t i, const StopRule& own) {
    if (progress.stopped()) return;
    answers[i] = walkVoxel(query, own, voxels[i], near_intervals[voxels[i]], progress);
    progress.step();
  };
  if (rule.node_pairs == StopRule::kNever) {
    parallelFor(voxels.size(), threadCount(query.request.threads), [&](std::size_t i) { walk(i, rule); });
  }
  else { // one after another: what one leaves is the next one's
    StopRule own = rule;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      walk(i, own);
      own.node_pairs -= std::min(own.node_pairs, answers[i].work.node_pairs);
    }
  }
  progress.throwIfStopped();
  return answers;
}

void markUndecided(const SphereHierarchy& scan, std::uint32_t voxel, std::vector<std::uint8_t>& flags)
{
  scan.storage().forEachRecord(voxel, [&](std::uint32_t i) { flags[i] = flagOf(Verdict::undecided); });
}

void countFlags(TrajectoryResult& result)
{
  const auto count = [&](Verdict verdict) {
    return static_cast<std::size_t>(std::count(result.flags.begin(), result.flags.end(), flagOf(verdict)));
  };
  result.colliding = count(Verdict::colliding);
  result.undecided = count(Verdict::undecided);
}

/// The same in passes, each for the voxels that the one before left with undecided points.
void followUntilStopped(const TrajectoryQuery& query, StopRule rule,
                        const std::vector<std::vector<std::uint32_t>>& near_intervals,
                        std::vector<std::uint32_t> voxels, Progress& progress)
{
  for (const std::uint32_t voxel : voxels) markUndecided(query.scan.hierarchy(), voxel, query.result.flags);
  const std::size_t all = voxels.size();
  const std::uint64_t budget = rule.node_pairs;
  std::uint64_t spent = query.result.work.node_pairs; // above the voxels
  if (budget != StopRule::kNever) rule.node_pairs = budget - std::min(budget, spent);
  std::size_t passed = 0;
  for (const std::uint64_t deepest : rule.passes()) {
    rule.deepest = deepest;
    std::vector<std::uint32_t> left;
    const std::vector<VoxelResult> answers = followAll(query, rule, near_intervals, voxels, progress);
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      query.result.work += answers[i].work;
      spent += answers[i].work.node_pairs;
      if (answers[i].undecided) left.push_back(voxels[i]);
    }
    if (budget != StopRule::kNever) rule.node_pairs = budget - std::min(budget, spent);
    voxels = std::move(left);
    progress.skipTo(++passed * all);
  }
  countFlags(query.result);
}

void follow(const TrajectoryQuery& query, const StopRule& rule, Progress& progress)
{
  const TrajectoryRequest& request = query.request;
  TrajectoryResult& result = query.result;
  if (request.pose_summaries) {
    query.nearest_at_pose.resize(query.path.poses.size());
    query.pose_counts.resize(query.path.poses.size());
  }
  const std::vector<std::vector<std::uint32_t>> near_intervals = query.nearIntervals(rule, progress);
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t v = 0; v < near_intervals.size(); ++v)
    if (!near_intervals[v].empty()) voxels.push_back(v);

  progress.begin(1.0, voxels.size() * (rule.mayStop() ? rule.passes().size() : 1));
  double first_contact = std::numeric_limits<double>::infinity();
  if (rule.mayStop()) {
    followUntilStopped(query, rule, near_intervals, std::move(voxels), progress);
  }
  else {
    for (const VoxelResult& answer : followAll(query, rule, near_intervals, voxels, progress)) {
      result.work += answer.work;
      result.colliding += answer.colliding;
      first_contact = std::min(first_contact, answer.first_contact);
    }
  }
  if (request.swept && std::isfinite(first_contact)) result.first_contact = instantOf(query.path, first_contact);
  if (request.pose_summaries) summarize(query, result);
}

/// One walk, of points that are where `places` says. Nothing where floats cannot hold the lengths.
std::optional<TrajectoryResult> walkAlong(const Placed& scan, const SphereHierarchy& model,
                                          const std::vector<Eigen::Isometry3d>& model_poses,
                                          const TrajectoryRequest& request, Places places)
{
  TrajectoryResult result;
  allocate(result, request, scan.hierarchy().view().count, model_poses.size());
  if (!asksForAnything(request) || scan.hierarchy().empty() || model.empty() || model_poses.empty()) return result;
  const StopRule rule(request.accuracy);
  Progress progress(request.progress);
  try {
    progress.limit(&rule);
    const BoxTree boxes(model.storage(), travelOf(model_poses, model.storage().frame.origin));
    const TrajectoryQuery query(scan, model, boxes, model_poses, request, result, progress, places);
    result.work.volumes_built += countChildren(boxes.storage.top);
    progress.limit(nullptr);
    if (!query.inFloatRange()) return std::nullopt;
    follow(query, rule, progress);
  }
  catch (const OutOfTime&) { // before the path was made: nothing is known
    for (std::uint32_t v = 0; v < scan.hierarchy().storage().voxel_count; ++v)
      markUndecided(scan.hierarchy(), v, result.flags);
    countFlags(result);
  }
  return result;
}

/// Of each pose, what surely collides, and what else may.
void withholdPoses(std::vector<PoseSummary>& possible, const std::vector<PoseSummary>& certain)
{
  for (std::size_t k = 0; k < possible.size(); ++k) {
    PoseSummary& pose = possible[k];
    const std::size_t may = pose.colliding_points;
    pose.colliding_points = std::min(may, certain[k].colliding_points);
    pose.undecided_points = may - pose.colliding_points;
    pose.colliding = pose.colliding_points > 0;
  }
}

/// One walk for what may collide, one for what does for certain.
TrajectoryResult walkUncertain(const Placed& scan, const SphereHierarchy& model,
                               const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& asked)
{
  TrajectoryRequest request = asked;
  request.flags = true;
  request.accuracy = halfOf(asked.accuracy);
  const auto share = [&](double begin) {
    return [&asked, begin](double fraction) { return asked.progress(begin + 0.5 * fraction); };
  };
  if (asked.progress) request.progress = share(0.0);
  std::optional<TrajectoryResult> possible = walkAlong(scan, model, model_poses, request, Places::possible);
  if (!possible) return brute_force::collideAlong(scan, model, model_poses, asked);
  request.distances = request.closest_poses = false;
  if (asked.progress) request.progress = share(0.5);
  const std::optional<TrajectoryResult> certain = walkAlong(scan, model, model_poses, request, Places::certain);
  if (!certain) return brute_force::collideAlong(scan, model, model_poses, asked);

  TrajectoryResult& result = *possible;
  withhold(result.flags, certain->flags, result.colliding, result.undecided);
  withholdPoses(result.poses, certain->poses);
  result.certain_pose = certain->first_pose;
  for (std::size_t i = 0; i < result.certain_pose.size(); ++i)
    if (result.flags[i] != flagOf(Verdict::colliding)) result.certain_pose[i] = -1;
  result.certain_contact = certain->first_contact;
  result.work += certain->work;
  if (!asked.flags) result.flags.clear();
  return std::move(*possible);
}

TrajectoryResult walk(const Placed& scan, const SphereHierarchy& model,
                      const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request)
{
  if (areUncertain(scan, {model}) && asksForAnything(request)) return walkUncertain(scan, model, model_poses, request);
  std::optional<TrajectoryResult> result = walkAlong(scan, model, model_poses, request, Places::measured);
  return result ? std::move(*result) : brute_force::collideAlong(scan, model, model_poses, request);
}

SphereHierarchy hierarchyOf(const SphereHierarchy& of, const std::vector<std::int32_t>& records)
{
  PointsView some = of.view();
  some.indices = records.data();
  some.index_count = records.size();
  return SphereHierarchy(some, of.options());
}

/// Strays by themselves, and all other points by themselves.
TrajectoryResult walkApart(const Placed& scan, const SphereHierarchy& model,
                           const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request,
                           const Strays& strays)
{
  const auto ask = [&](const std::vector<std::int32_t>& of_scan, const std::vector<std::int32_t>& of_model,
                       const TrajectoryRequest& asked) {
    const SphereHierarchy some_scan = hierarchyOf(scan.hierarchy(), of_scan);
    return walk(Placed(some_scan, scan.pose), hierarchyOf(model, of_model), model_poses, asked);
  };
  TrajectoryResult result = ask(strays.ordinary_scan, strays.ordinary_model, request);
  if (strays.stray_scan.empty() || strays.stray_model.empty()) return result;
  TrajectoryRequest quietly = request;
  quietly.progress = {};
  addStrays(result, ask(strays.stray_scan, strays.stray_model, quietly), strays.stray_scan);
  return result;
}

} // namespace

TrajectoryResult collideAlong(const Placed& scan, const SphereHierarchy& model,
                              const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request)
{
  check(scan, model_poses, request);
  const DefaultFloatEnvironment environment;
  // Swept motion refuses such coordinates, and what stops early has one budget for all points.
  if (!request.swept && !StopRule(request.accuracy).mayStop() && asksForAnything(request))
    if (const std::optional<Strays> strays = findStrays(scan, model, model_poses, request.clearance))
      return walkApart(scan, model, model_poses, request, *strays);
  return walk(scan, model, model_poses, request);
}

} // namespace pcl_bsh
