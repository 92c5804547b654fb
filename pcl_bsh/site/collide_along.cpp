// SPDX-License-Identifier: BSD-3-Clause
// The part of a question about a site that is along a path.
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/site/answers/enclosed_in_tile.h>
#include <pcl_bsh/site/answers/passage_sum.h>
#include <pcl_bsh/site/answers/tile_query.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>
#include <pcl_bsh/site/tiles/obstacle_tiles.h>
#include <pcl_bsh/site/tiles/records.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <map>

namespace pcl_bsh::site {

namespace {

using Poses = std::vector<Eigen::Isometry3d>;

/// The joined results of several models that move together, about the points of a scan.
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

  /// Adds the result of one model.
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
  /// Whether this model is nearer to point i than the models before. At equal distances the earlier pose counts, then
  /// the smaller point of a model. Distances that are equal as floats may differ: exact arithmetic decides. Distances
  /// of swept motion are not exact, and are not compared again.
  bool isNearer(std::uint32_t i, const TrajectoryResult& found, const MetPoint& nearest) const
  {
    const float before = joined_.distance[i], now = found.distance[i];
    if (now != before) return !(now > before); // true also where there was none before, which is NaN
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

/// Summaries of poses of several models that move together: a point of the scan that meets two of them counts once.
class JoinedPoses {
public:
  /// All are borrowed.
  JoinedPoses(const SphereHierarchy& scan, const Poses& poses, const TrajectoryRequest& request)
  : scan_(scan),
    poses_(poses),
    request_(request),
    sum_(poses.size())
  {
  }

  /// Adds the summaries of the next model.
  void add(const std::vector<PoseSummary>& of_model)
  {
    meets_.emplace_back(poses_.size());
    for (std::size_t k = 0; k < of_model.size(); ++k) {
      sum_[k] += of_model[k];
      meets_.back()[k] = of_model[k].colliding_points + of_model[k].undecided_points > 0;
    }
  }

  /// Returns the summaries of all models together. At poses at which several models meet points, flags are computed
  /// once more, and joined.
  /// @param model_of the points of a model, by its number among those added; asked for once for many poses
  template <typename ModelOf>
  std::vector<PoseSummary> joined(const ModelOf& model_of)
  {
    constexpr std::size_t most_flags = std::size_t{1} << 26; // bytes, of several poses
    const std::vector<std::size_t> shared = sharedPoses();
    const std::size_t at_once = std::max<std::size_t>(most_flags / std::max<std::size_t>(scan_.view().count, 1), 1);
    for (std::size_t begin = 0; begin < shared.size(); begin += at_once) {
      const auto first = shared.begin() + static_cast<std::ptrdiff_t>(begin);
      count({first, first + static_cast<std::ptrdiff_t>(std::min(at_once, shared.size() - begin))}, model_of);
    }
    return sum_;
  }

private:
  std::vector<std::size_t> sharedPoses() const
  {
    std::vector<std::size_t> shared;
    for (std::size_t k = 0; k < poses_.size(); ++k)
      if (std::count_if(meets_.begin(), meets_.end(), [k](const std::vector<bool>& model) { return model[k]; }) > 1)
        shared.push_back(k);
    return shared;
  }

  template <typename ModelOf>
  void count(const std::vector<std::size_t>& poses, const ModelOf& model_of)
  {
    const FlagsRequest wanted(request_.clearance, Flagged::a, {request_.accuracy, request_.threads});
    std::vector<std::vector<Verdict>> flags(poses.size());
    for (auto& of_pose : flags) of_pose.assign(scan_.view().count, Verdict::free);
    FlagsResult found;
    for (std::size_t m = 0; m < meets_.size(); ++m) {
      if (std::none_of(poses.begin(), poses.end(), [&](std::size_t k) { return meets_[m][k]; })) continue;
      const SphereHierarchy model = model_of(m);
      for (std::size_t i = 0; i < poses.size(); ++i) {
        if (!meets_[m][poses[i]]) continue;
        collisionFlags({scan_}, {model, poses_[poses[i]]}, wanted, found);
        join(flags[i], found.a);
      }
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
      sum_[poses[i]].colliding_points = countOf(flags[i], Verdict::colliding);
      sum_[poses[i]].undecided_points = countOf(flags[i], Verdict::undecided);
    }
  }

  const SphereHierarchy& scan_;
  const Poses& poses_;
  const TrajectoryRequest& request_;
  std::vector<PoseSummary> sum_;
  std::vector<std::vector<bool>> meets_; ///< of each model, whether it meets points at each pose
};

/// Asks about tiles of the site, adds up the answers, and returns the tiles read.
template <typename Find>
TilesRead visitTiles(const QuestionPart& part, TileQuery& tile_query, const std::vector<std::uint32_t>& tiles,
                     PassageSum& sum, const Find& find)
{
  const auto ask = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
    Answer of_tile;
    std::vector<MetPoint> met;
    of_tile.collisions = find(tile, hierarchy, met);
    if (part.means.receiver) part.means.receiver(tile, cloud, of_tile);
    return sum.numbersOf(tile, cloud, CollidingRecords(of_tile.collisions), part.other ? &met : nullptr);
  };
  return tile_query.visitAndAdd(
      tiles, ask, [&](const auto& numbers) { sum.add(numbers); }, part.other != nullptr);
}

void followPathOfCloud(const QuestionPart& part, const Poses& poses, PassageSum& sum, SiteAnswer& answer)
{
  const PlacedSite site = part.input();
  const SphereHierarchy& model = part.model();
  const TrajectoryRequest wanted = alongPath(part);
  refusePassage(site.site, model, poses, wanted);
  TileQuery tile_query(part, site);
  const auto find = [&](const Tile&, const SphereHierarchy& hierarchy, std::vector<MetPoint>&) {
    TrajectoryResult found = collideAlong({hierarchy}, model, poses, wanted);
    addEnclosedOf(part, hierarchy, found);
    return found;
  };
  const std::vector<std::uint32_t> tiles =
      tilesAlong(site.site, boxesOf(model.view(), part.question.solid), poses, pathReach(wanted), site.uncertainty);
  answer.tiles += visitTiles(part, tile_query, tiles, sum, find);
}

/// Answers about an obstacle that is a site and moves along a path. Reads its tiles that come near a tile of the input
/// on their way.
void followPathOfSite(const QuestionPart& part, const Poses& poses, PassageSum& sum, SiteAnswer& answer)
{
  const PlacedSite site = part.input();
  const Site& model = *part.other;
  const TrajectoryRequest wanted = alongPath(part);
  const std::vector<Point3> corners = cornersOf(model);
  refusePassage(site.site, SphereHierarchy(viewOf(corners.empty() ? nullptr : corners.front().data(), corners.size())),
                poses, wanted);
  TileQuery tile_query(part, site);
  const Uncertainty of_model = part.question.uncertaintyOfObstacle();
  ObstacleTiles models({model, Eigen::Isometry3d::Identity(), of_model}, tile_query.bytesLeft());
  std::vector<std::vector<std::uint32_t>> near(site.site.tiles.size()); // for each tile, the model's near it
  for (std::uint32_t j = 0; j < model.tiles.size(); ++j) {
    if (!model.tiles[j].bounds) continue;
    const CloudBoxes box(trueBounds(model.tiles[j], of_model));
    for (const std::uint32_t i : tilesAlong(site.site, box, poses, pathReach(wanted), site.uncertainty))
      near[i].push_back(j);
  }
  std::vector<std::uint32_t> tiles;
  for (std::uint32_t i = 0; i < near.size(); ++i)
    if (!near[i].empty()) tiles.push_back(i);

  const auto find = [&](const Tile& tile, const SphereHierarchy& hierarchy, std::vector<MetPoint>& met) {
    JoinedResults joined(hierarchy.view(), poses, wanted);
    JoinedPoses joined_poses(hierarchy, poses, wanted);
    const std::vector<std::uint32_t>& numbers = near[static_cast<std::size_t>(&tile - site.site.tiles.data())];
    for (const std::uint32_t j : numbers) {
      const PointsView points = models.points(j);
      const TrajectoryResult of_model_tile =
          collideAlong({hierarchy}, SphereHierarchy(points, tile_query.building()), poses, wanted);
      joined.add(of_model_tile, points, models.last());
      if (wanted.pose_summaries) joined_poses.add(of_model_tile.poses);
    }
    TrajectoryResult& found = joined.result(met);
    if (wanted.pose_summaries) {
      found.poses = joined_poses.joined(
          [&](std::size_t m) { return SphereHierarchy(models.points(numbers[m]), tile_query.building()); });
    }
    return std::move(found);
  };
  answer.tiles += visitTiles(part, tile_query, tiles, sum, find);
  answer.obstacle_tiles += models.read();
}

} // namespace

void followPath(const QuestionPart& part, SiteAnswer& answer)
{
  const Poses poses = part.question.poses();
  PassageSum sum(part, poses.size());
  if (part.other)
    followPathOfSite(part, poses, sum, answer);
  else
    followPathOfCloud(part, poses, sum, answer);
  sum.tell(answer);
}

} // namespace pcl_bsh::site
