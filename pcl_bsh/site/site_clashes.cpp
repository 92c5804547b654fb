// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/clusters/disjoint_sets.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/clash_piece.h>
#include <pcl_bsh/site/cloud_boxes.h>
#include <pcl_bsh/site/records.h>
#include <pcl_bsh/site/site_clashes.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_bsh::sites {

class ClashFinder::Pieces {
public:
  Pieces(const Site& site, double cluster_distance) : site_(site), distance_(cluster_distance)
  {
    findClashes(PointsView{}, TrajectoryResult(), cluster_distance); // refuses a distance although no tile may collide
  }

  void add(const Tile& tile, const pcl::PCLPointCloud2& cloud, const TrajectoryResult& found,
           const std::vector<MetPoint>* met)
  {
    const PointsView view = viewOf(cloud);
    const std::size_t source_at = offsetOf(cloud, source_field_name), record_at = offsetOf(cloud, record_field_name);
    const auto memberOf = [&](std::uint32_t i, const SitePoint& piece) {
      const std::uint8_t* const bytes = cloud.data.data() + std::size_t{i} * cloud.point_step;
      return Member{view.point(i),
                    {numberAt(bytes + source_at), numberAt(bytes + record_at)},
                    piece,
                    found.distance[i],
                    found.closest_pose[i]};
    };
    const std::vector<Bounds> others = neighborsOf(tile);
    for (Clash& clash : findClashes(view, found, distance_)) {
      const SitePoint piece = memberOf(clash.records.front(), {}).point;
      std::vector<Member> some;
      for (const std::uint32_t i : clash.records) {
        some.push_back(memberOf(i, piece));
        if (isNear(some.back().place, others)) border_.push_back(some.back());
      }
      drawSome(some, most_points);
      some_.insert(some_.end(), some.begin(), some.end());
      const Member nearest = memberOf(clash.scan_point, piece);
      const MetPoint of_model = met ? (*met)[clash.model_point] : MetPoint{{0, clash.model_point}, {0, 0, 0}};
      clash.records.clear();
      pieces_.push_back({std::move(clash), nearest, of_model});
    }
  }

  SiteClashes finish(bool model_is_site)
  {
    pieces_ = gathered(pieces_);
    std::sort(pieces_.begin(), pieces_.end(),
              [](const Piece& a, const Piece& b) { return a.nearest.piece < b.nearest.piece; });
    const std::vector<std::size_t> clash_of = joinPieces(gathered(border_));
    std::vector<std::vector<Member>> some(pieces_.size());
    for (const Member& member : gathered(some_)) some[clash_of[numberOf(member.piece)]].push_back(member);
    return listed(some, model_is_site);
  }

private:
  std::vector<Bounds> neighborsOf(const Tile& tile) const
  {
    std::vector<Bounds> others;
    for (const Tile& other : site_.tiles) {
      if (&other == &tile || !other.bounds || !tile.bounds) continue;
      if (leastDistance(*other.bounds, *tile.bounds) <= distance_) others.push_back(*other.bounds);
    }
    return others;
  }

  bool isNear(const Point3& place, const std::vector<Bounds>& others) const
  {
    return std::any_of(others.begin(), others.end(), [&](const Bounds& other) {
      return leastDistance({place, place}, other) <= distance_;
    });
  }

  /// @pre pieces are in the order of their smallest points
  std::size_t numberOf(const SitePoint& piece) const
  {
    const auto place = std::lower_bound(pieces_.begin(), pieces_.end(), piece,
                                        [](const Piece& a, const SitePoint& b) { return a.nearest.piece < b; });
    return static_cast<std::size_t>(place - pieces_.begin());
  }

  /// Leaves one piece of each clash, in the order of their smallest points. @return of each earlier piece, its clash
  std::vector<std::size_t> joinPieces(const std::vector<Member>& border)
  {
    DisjointSets sets(pieces_.size());
    std::vector<Point3> places;
    for (const Member& member : border) places.push_back(member.place);
    const SphereHierarchy hierarchy(viewOf(places.empty() ? nullptr : places.front().data(), places.size()));
    const Clusters clusters = euclideanClusters(hierarchy, distance_);
    std::vector<std::uint32_t> first(clusters.sizes.size(), none);
    for (std::size_t i = 0; i < border.size(); ++i) {
      std::uint32_t& of_cluster = first[static_cast<std::size_t>(clusters.of[i])];
      const auto piece = static_cast<std::uint32_t>(numberOf(border[i].piece));
      if (of_cluster == none) of_cluster = piece;
      sets.unite(of_cluster, piece);
    }
    std::vector<std::size_t> clash_of(pieces_.size());
    std::vector<Piece> joined;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      const std::uint32_t root = sets.find(i); // the smallest of its set: comes first
      if (root == i) {
        clash_of[i] = joined.size();
        joined.push_back(pieces_[i]);
        continue;
      }
      clash_of[i] = clash_of[root];
      join(joined[clash_of[i]], pieces_[i]);
    }
    clashes_ = std::move(joined);
    return clash_of;
  }

  SiteClashes listed(std::vector<std::vector<Member>>& some, bool model_is_site)
  {
    SiteClashes list;
    for (std::size_t i = 0; i < clashes_.size(); ++i) {
      Clash& clash = clashes_[i].clash;
      const Member& nearest = clashes_[i].nearest;
      clash.model_point = model_is_site ? static_cast<std::uint32_t>(i) : clashes_[i].met.point.record;
      if (model_is_site) list.met.push_back(clashes_[i].met);
      std::vector<Member>& members = some[i];
      drawSome(members, most_points);
      members.push_back(nearest);
      std::sort(members.begin(), members.end(), [](const Member& a, const Member& b) { return a.point < b.point; });
      const auto same = [](const Member& a, const Member& b) { return a.point == b.point; };
      members.erase(std::unique(members.begin(), members.end(), same), members.end());
      for (const Member& member : members) {
        const auto number = static_cast<std::uint32_t>(list.points.size());
        if (member.point == nearest.point) clash.scan_point = number;
        clash.records.push_back(number);
        list.points.push_back(member.point);
        list.places.push_back(member.place);
        list.distance.push_back(member.distance);
        list.closest_pose.push_back(member.closest_pose);
      }
      list.clashes.push_back(std::move(clash));
    }
    nameClashes(list.clashes, distance_);
    return list;
  }

  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  const Site& site_;
  const double distance_;
  std::vector<Piece> pieces_, clashes_;
  std::vector<Member> border_; ///< points that a step of the distance may lead to another tile
  std::vector<Member> some_;   ///< of each piece
};

ClashFinder::ClashFinder(const Site& site, double cluster_distance)
: pieces_(std::make_unique<Pieces>(site, cluster_distance))
{
}

ClashFinder::~ClashFinder() = default;

void ClashFinder::add(const Tile& tile, const pcl::PCLPointCloud2& cloud, const TrajectoryResult& found,
                      const std::vector<MetPoint>* met)
{
  pieces_->add(tile, cloud, found, met);
}

SiteClashes ClashFinder::finish(bool model_is_site)
{
  return pieces_->finish(model_is_site);
}

double spacingOf(const Site& site)
{
  std::vector<std::pair<double, std::uint64_t>> spacings;
  std::uint64_t points = 0, below = 0;
  for (const Tile& tile : site.tiles) {
    spacings.emplace_back(tile.spacing, tile.points);
    points += tile.points;
  }
  std::sort(spacings.begin(), spacings.end());
  for (const auto& [spacing, count] : spacings)
    if (2 * (below += count) >= points) return spacing;
  return 0.0;
}

} // namespace pcl_bsh::sites
