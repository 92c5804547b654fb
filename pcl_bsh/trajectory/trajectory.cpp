// SPDX-License-Identifier: BSD-3-Clause
// A trajectory query as a whole: the path, which voxels of the scan come near when, their walks, and what they add up
// to.
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/trajectory/check_trajectory.h>
#include <pcl_bsh/trajectory/outliers.h>
#include <pcl_bsh/trajectory/query.h>
#include <pcl_bsh/traversal/voxel_passes.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

/// Writes the summary of each pose. Equal poses in a row were looked at once, and have equal summaries.
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
      const RecordDistance distance(a, query.scan.pose, b, query.given[poses[k].given]);
      summary.distance = distance.gap(pair);
    }
    const std::size_t next = k + 1 < poses.size() ? poses[k + 1].given : result.poses.size();
    std::fill(result.poses.begin() + poses[k].given, result.poses.begin() + static_cast<std::ptrdiff_t>(next), summary);
  }
}

/// Returns the instant at a time on a swept path. @param time pose of the path, plus the fraction of the motion to the
/// next
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

void markUndecided(const SphereHierarchy& scan, std::uint32_t voxel, std::vector<Verdict>& flags)
{
  scan.storage().forEachRecord(voxel, [&](std::uint32_t i) { flags[i] = Verdict::undecided; });
}

void countFlags(TrajectoryResult& result)
{
  result.colliding = countOf(result.flags, Verdict::colliding);
  result.undecided = countOf(result.flags, Verdict::undecided);
}

/// Takes all voxels along the trajectory.
void follow(const TrajectoryQuery& query, const StopRule& rule, Progress& progress)
{
  const TrajectoryRequest& request = query.request;
  TrajectoryResult& result = query.result;
  if (request.pose_summaries) {
    query.nearest_at_pose.resize(query.path.poses.size());
    query.pose_counts.resize(query.path.poses.size());
  }
  progress.begin(kBroadPhaseDone, query.scan.hierarchy().storage().top[0].count);
  const std::vector<NearVoxel> near_voxels = query.nearVoxels(rule, progress);
  progress.end();

  VoxelPasses<std::span<const NearVoxel>, VoxelResult> voxels(threadCount(request.threads), result.work, progress);
  for (std::span<const NearVoxel> left = near_voxels; !left.empty();) voxels.places.push_back(takeVoxel(left));
  if (rule.mayStop())
    for (const auto& near : voxels.places) markUndecided(query.scan.hierarchy(), near[0].voxel, result.flags);
  progress.begin(1.0, voxels.steps(rule));
  const std::uint64_t tests = // those above the voxels count, too
      rule.node_pairs - (rule.node_pairs == StopRule::kNever ? 0 : std::min(rule.node_pairs, result.work.node_pairs));
  voxels.run(rule, tests,
             [&](const StopRule& own, std::span<const NearVoxel> near) { return walkVoxel(query, own, near); });
  if (rule.mayStop()) countFlags(result);
  if (request.swept && std::isfinite(query.earliest)) result.first_contact = instantOf(query.path, query.earliest);
  if (request.pose_summaries) summarize(query, result);
}

/// Walks once, for the places of uncertain points that `places` means. Returns nothing where floats cannot hold the
/// lengths.
std::optional<TrajectoryResult> walkAlong(const Placed& scan, const SphereHierarchy& model,
                                          const std::vector<Eigen::Isometry3d>& model_poses,
                                          const TrajectoryRequest& request, MeantPlaces places,
                                          TrajectoryResult&& memory = {})
{
  TrajectoryResult result = allFree(request, scan.hierarchy().view().count, model_poses.size(), std::move(memory));
  if (!asksForAnything(request) || scan.hierarchy().empty() || model.empty() || model_poses.empty()) return result;
  const StopRule rule(request.accuracy);
  Progress progress(request.progress);
  try {
    progress.limit(&rule);
    const BoxTree boxes(model.storage(), travelOf(model_poses, model.storage().frame.origin),
                        divisionFor(scan.hierarchy().storage().size, scan.hierarchy().storage().largest_radius));
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

/// Divides the points that may collide at each pose into those that surely collide and those that are undecided.
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

/// Walks once for points that may collide, and once for points that collide for certain.
TrajectoryResult walkUncertain(const Placed& scan, const SphereHierarchy& model,
                               const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& asked,
                               TrajectoryResult&& memory)
{
  TrajectoryRequest request = asked;
  request.flags = true;
  request.accuracy = halfOf(asked.accuracy);
  const auto share = [&](double begin) {
    return [&asked, begin](double fraction) { return asked.progress(begin + 0.5 * fraction); };
  };
  if (asked.progress) request.progress = share(0.0);
  std::optional<TrajectoryResult> possible =
      walkAlong(scan, model, model_poses, request, MeantPlaces::possible, std::move(memory));
  if (!possible) return brute_force::collideAlong(scan, model, model_poses, asked);
  request.distances = request.closest_poses = false;
  if (asked.progress) request.progress = share(0.5);
  const std::optional<TrajectoryResult> certain = walkAlong(scan, model, model_poses, request, MeantPlaces::certain);
  if (!certain) return brute_force::collideAlong(scan, model, model_poses, asked);

  TrajectoryResult& result = *possible;
  withhold(result.flags, certain->flags, result.colliding, result.undecided);
  withholdPoses(result.poses, certain->poses);
  result.certain_pose = certain->first_pose;
  for (std::size_t i = 0; i < result.certain_pose.size(); ++i)
    if (result.flags[i] != Verdict::colliding) result.certain_pose[i] = -1;
  result.certain_contact = certain->first_contact;
  result.work += certain->work;
  if (!asked.flags) result.flags.clear();
  return std::move(*possible);
}

TrajectoryResult walk(const Placed& scan, const SphereHierarchy& model,
                      const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request,
                      TrajectoryResult&& memory = {})
{
  if (areUncertain(scan, {model}) && asksForAnything(request))
    return walkUncertain(scan, model, model_poses, request, std::move(memory));
  std::optional<TrajectoryResult> result =
      walkAlong(scan, model, model_poses, request, MeantPlaces::measured, std::move(memory));
  return result ? std::move(*result) : brute_force::collideAlong(scan, model, model_poses, request);
}

SphereHierarchy hierarchyOf(const SphereHierarchy& of, const std::vector<std::int32_t>& records)
{
  PointsView some = of.view();
  some.restrictTo(records.data(), records.size());
  return SphereHierarchy(some, of.options());
}

/// Asks about outliers alone and about all other points alone, and adds up the answers.
TrajectoryResult walkApart(const Placed& scan, const SphereHierarchy& model,
                           const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request,
                           const Outliers& outliers)
{
  const auto ask = [&](const std::vector<std::int32_t>& of_scan, const std::vector<std::int32_t>& of_model,
                       const TrajectoryRequest& asked) {
    const SphereHierarchy some_scan = hierarchyOf(scan.hierarchy(), of_scan);
    return walk(Placed(some_scan, scan.pose), hierarchyOf(model, of_model), model_poses, asked);
  };
  TrajectoryResult result = ask(outliers.ordinary_scan, outliers.ordinary_model, request);
  if (outliers.outlier_scan.empty() || outliers.outlier_model.empty()) return result;
  TrajectoryRequest quietly = request;
  quietly.progress = {};
  addOutliers(result, ask(outliers.outlier_scan, outliers.outlier_model, quietly), outliers.outlier_scan);
  return result;
}

/// @param memory of an earlier result
TrajectoryResult answer(const Placed& scan, const SphereHierarchy& model,
                        const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request,
                        TrajectoryResult&& memory)
{
  check(scan, model_poses, request);
  const DefaultFloatEnvironment environment;
  // Swept motion refuses such coordinates, and an accuracy that stops early has one budget for all points.
  if (!request.swept && !StopRule(request.accuracy).mayStop() && asksForAnything(request))
    if (const std::optional<Outliers> outliers = findOutliers(scan, model, model_poses, request.clearance))
      return walkApart(scan, model, model_poses, request, *outliers);
  return walk(scan, model, model_poses, request, std::move(memory));
}

} // namespace

TrajectoryResult collideAlong(const Placed& scan, const SphereHierarchy& model,
                              const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request)
{
  return answer(scan, model, model_poses, request, {});
}

void collideAlong(const Placed& scan, const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& model_poses,
                  const TrajectoryRequest& request, TrajectoryResult& result)
{
  result = answer(scan, model, model_poses, request, std::exchange(result, {}));
}

} // namespace pcl_bsh
