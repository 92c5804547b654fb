// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/site/answers/held.h>
#include <pcl_bsh/site/answers/inquiry.h>
#include <pcl_bsh/site/answers/joined_poses.h>
#include <pcl_bsh/site/answers/passage_sum.h>
#include <pcl_bsh/site/collide_site.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>
#include <pcl_bsh/site/tiles/obstacle_tiles.h>
#include <pcl_bsh/site/tiles/records.h>

#include <algorithm>
#include <map>

namespace pcl_bsh::site {

namespace {

using Poses = std::vector<Eigen::Isometry3d>;

/// What several models that move together meet of a scan.
class JoinedResults {
public:
  JoinedResults(const PointsView& scan, const Poses& poses, const TrajectoryRequest& request)
  : scan_(scan),
    poses_(poses),
    is_swept_(request.swept.has_value())
  {
    joined_.flags.assign(scan.count, Verdict::free);
    if (!request.distances) return;
    joined_.distance.assign(scan.count, std::numeric_limits<float>::quiet_NaN());
    joined_.first_pose.assign(scan.count, -1);
    joined_.closest_pose.assign(scan.count, -1);
  }

  /// What one of them meets.
  void add(const TrajectoryResult& found, const PointsView& model, const pcl::PCLPointCloud2& cloud)
  {
    join(joined_.flags, found.flags);
    for (std::uint32_t i = 0; i < joined_.distance.size(); ++i) {
      if (found.first_pose[i] < 0) continue;
      std::int32_t& first = joined_.first_pose[i];
      first = first < 0 ? found.first_pose[i] : std::min(first, found.first_pose[i]);
      const MetPoint nearest{nameOf(cloud, found.closest_point[i]), model.point(found.closest_point[i])};
      if (!isNearer(i, found, nearest)) continue;
      joined_.distance[i] = found.distance[i];
      joined_.closest_pose[i] = found.closest_pose[i];
      nearest_[i] = nearest;
    }
    keepEarlier(joined_.first_contact, found.first_contact);
    keepEarlier(joined_.certain_contact, found.certain_contact);
  }

  /// @param met gets the nearest points, where distances are asked for
  TrajectoryResult& result(std::vector<MetPoint>& met)
  {
    if (!joined_.distance.empty()) {
      joined_.closest_point.assign(scan_.count, kNothing);
      for (const auto& [i, nearest] : nearest_) {
        joined_.closest_point[i] = static_cast<std::uint32_t>(met.size());
        met.push_back(nearest);
      }
    }
    joined_.colliding = countOf(joined_.flags, Verdict::colliding);
    joined_.undecided = countOf(joined_.flags, Verdict::undecided);
    return joined_;
  }

private:
  /// Whether point i is nearer to this model, or as near at an earlier pose, or there to a smaller point. Distances
  /// that are one float may differ: exact arithmetic decides. Those of swept motion are not exact.
  bool isNearer(std::uint32_t i, const TrajectoryResult& found, const MetPoint& nearest) const
  {
    const float before = joined_.distance[i], now = found.distance[i];
    if (now != before) return !(now > before); // as they are where there was none before
    const std::int32_t pose = found.closest_pose[i], pose_before = joined_.closest_pose[i];
    int sign = 0;
    if (!is_swept_) {
      const ExactDistance at(Eigen::Isometry3d::Identity(), poses_[static_cast<std::size_t>(pose)]);
      const ExactDistance at_before(Eigen::Isometry3d::Identity(), poses_[static_cast<std::size_t>(pose_before)]);
      const Point3 p = scan_.point(i);
      sign = at.compareGaps({p, nearest.place, 0.0, 0.0}, at_before, {p, nearest_.at(i).place, 0.0, 0.0});
    }
    if (sign != 0) return sign < 0;
    return pose != pose_before ? pose < pose_before : nearest.point < nearest_.at(i).point;
  }

  static void keepEarlier(std::optional<FirstContact>& kept, const std::optional<FirstContact>& other)
  {
    if (other) kept = kept ? earlier(*kept, *other) : *other;
  }

  const PointsView& scan_;
  const Poses& poses_;
  const bool is_swept_;
  TrajectoryResult joined_;
  std::map<std::uint32_t, MetPoint> nearest_; ///< of the points that meet something
};

/// For each tile of a site the tiles of the model that may come near to it on their way.
std::vector<std::vector<std::uint32_t>> tilesOfModelNear(const Site& site, const Uncertainty& uncertainty,
                                                         const Site& model, const Uncertainty& of_model,
                                                         const Poses& poses, const PathReach& reach)
{
  std::vector<std::vector<std::uint32_t>> near(site.tiles.size());
  for (std::uint32_t j = 0; j < model.tiles.size(); ++j) {
    if (!model.tiles[j].bounds) continue;
    const CloudBoxes box(trueBounds(model.tiles[j], of_model));
    for (const std::uint32_t i : tilesAlong(site, box, poses, reach, uncertainty)) near[i].push_back(j);
  }
  return near;
}

} // namespace

SitePassage collideAlong(const Site& site, const SphereHierarchy& model, const Poses& poses, const SiteRequest& request,
                         const PassageSink& sink)
{
  const TrajectoryRequest wanted = alongPath(request);
  refusePassage(site, model, poses, wanted);
  requireUncertainty(site, request.uncertainty);
  PassageSum sum(request, poses.size());
  Inquiry inquiry(site, request);
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
    TrajectoryResult found = pcl_bsh::collideAlong({hierarchy}, model, poses, wanted);
    addHeldOf(request, {hierarchy}, {model}, found, &poses);
    if (sink) sink(tile, cloud, found);
    return sum.numbersOf(tile, cloud, found);
  };
  const std::vector<std::uint32_t> tiles =
      tilesAlong(site, boxesOf(model.view(), request.solid != nullptr), poses, pathReach(request), request.uncertainty);
  const TilesRead read = inquiry.visitAndAdd(tiles, find, [&](const auto& numbers) { sum.add(numbers); });
  SitePassage result = sum.ofAllRanks();
  result.tiles = read;
  return result;
}

SitePassage collideAlong(const Site& site, const Site& model, const Uncertainty& model_uncertainty, const Poses& poses,
                         const SiteRequest& request, const PassageSink& sink)
{
  const TrajectoryRequest wanted = alongPath(request);
  const std::vector<Point3> corners = cornersOf(model);
  refusePassage(site, SphereHierarchy(viewOf(corners.empty() ? nullptr : corners.front().data(), corners.size())),
                poses, wanted);
  requireUncertainty(site, request.uncertainty);
  Inquiry inquiry(site, request);
  ObstacleTiles models({model, Eigen::Isometry3d::Identity(), model_uncertainty},
                       request.memory - std::min(request.memory, inquiry.bytesForLargest()));
  const auto near = tilesOfModelNear(site, request.uncertainty, model, model_uncertainty, poses, pathReach(request));
  std::vector<std::uint32_t> tiles;
  for (std::uint32_t i = 0; i < near.size(); ++i)
    if (!near[i].empty()) tiles.push_back(i);

  PassageSum sum(request, poses.size());
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
    JoinedResults joined(hierarchy.view(), poses, wanted);
    JoinedPoses joined_poses(hierarchy, poses, wanted);
    const std::vector<std::uint32_t>& numbers = near[static_cast<std::size_t>(&tile - site.tiles.data())];
    for (const std::uint32_t j : numbers) {
      const PointsView points = models.points(j);
      const TrajectoryResult of_model =
          pcl_bsh::collideAlong({hierarchy}, SphereHierarchy(points, inquiry.building()), poses, wanted);
      joined.add(of_model, points, models.last());
      if (request.pose_summaries) joined_poses.add(of_model.poses);
    }
    std::vector<MetPoint> met;
    TrajectoryResult& found = joined.result(met);
    if (request.pose_summaries) {
      found.poses = joined_poses.joined(
          [&](std::size_t m) { return SphereHierarchy(models.points(numbers[m]), inquiry.building()); });
    }
    if (sink) sink(tile, cloud, found);
    return sum.numbersOf(tile, cloud, found, &met);
  };
  const TilesRead read = inquiry.visitAndAdd(
      tiles, find, [&](const auto& numbers) { sum.add(numbers); }, true);
  SitePassage result = sum.ofAllRanks();
  result.tiles = read;
  result.tiles_b = models.read();
  return result;
}

} // namespace pcl_bsh::site
