// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/clusters/disjoint_sets.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/answers/clash_piece.h>
#include <pcl_bsh/site/site_clashes.h>
#include <pcl_bsh/site/tiles/cloud_boxes.h>
#include <pcl_bsh/site/tiles/records.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_bsh::site {

class ClashFinder::Joining {
public:
  Joining(const Site& site, double cluster_distance) : site_(site), distance_(cluster_distance)
  {
    findClashes(PointsView{}, TrajectoryResult(), cluster_distance); // refuses a distance even where no tile collides
  }

  Pieces piecesOf(const Tile& tile, const pcl::PCLPointCloud2& cloud, const CollidingRecords& found,
                  const std::vector<MetPoint>* met) const
  {
    Pieces of_tile;
    of_tile.of_site = met != nullptr;
    const PointsView view = viewOf(cloud);
    const PointNames names(cloud);
    const auto nameOf = [&](std::uint32_t i) { return names(cloud.data.data() + std::size_t{i} * cloud.point_step); };
    const std::vector<Bounds> others = neighborsOf(tile);
    for (Clash& clash : findClashes(view, found, distance_)) {
      const SitePoint piece = nameOf(clash.records.front());
      std::vector<Member> some;
      Member nearest;
      for (std::size_t k = 0; k < clash.records.size(); ++k) {
        const std::uint32_t i = clash.records[k];
        some.push_back({view.point(i), nameOf(i), piece, clash.distances[k], clash.closest_poses[k]});
        if (i == clash.scan_point) nearest = some.back();
        if (isNear(some.back().place, others)) of_tile.border.push_back(some.back());
      }
      drawSome(some, most_points);
      of_tile.some.insert(of_tile.some.end(), some.begin(), some.end());
      const MetPoint of_model = met ? (*met)[clash.model_point] : MetPoint{{0, clash.model_point}, {0, 0, 0}};
      clash.clearRecords();
      of_tile.pieces.push_back({std::move(clash), nearest, of_model});
    }
    return of_tile;
  }

  void add(const double* begin, const double* end) { site::add(found_, begin, end); }

  SiteClashes finish()
  {
    found_ = gathered(found_);
    std::sort(found_.pieces.begin(), found_.pieces.end(),
              [](const Piece& a, const Piece& b) { return a.nearest.piece < b.nearest.piece; });
    const std::vector<std::size_t> clash_of = joinPieces();
    std::vector<std::vector<Member>> some(clashes_.size());
    for (const Member& member : found_.some) some[clash_of[numberOf(member.piece)]].push_back(member);
    return listed(some);
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
    const auto place = std::lower_bound(found_.pieces.begin(), found_.pieces.end(), piece,
                                        [](const Piece& a, const SitePoint& b) { return a.nearest.piece < b; });
    return static_cast<std::size_t>(place - found_.pieces.begin());
  }

  /// Makes clashes of the pieces, in the order of their smallest points. @return of each piece, its clash
  std::vector<std::size_t> joinPieces()
  {
    const std::vector<Piece>& pieces = found_.pieces;
    const std::vector<Member>& border = found_.border;
    DisjointSets sets(pieces.size());
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
    std::vector<std::size_t> clash_of(pieces.size());
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
      const std::uint32_t root = sets.find(i); // the smallest of its set: comes first
      if (root == i) {
        clash_of[i] = clashes_.size();
        clashes_.push_back(pieces[i]);
        continue;
      }
      clash_of[i] = clash_of[root];
      join(clashes_[clash_of[i]], pieces[i]);
    }
    return clash_of;
  }

  SiteClashes listed(std::vector<std::vector<Member>>& some)
  {
    SiteClashes list;
    for (std::size_t i = 0; i < clashes_.size(); ++i) {
      Clash& clash = clashes_[i].clash;
      const Member& nearest = clashes_[i].nearest;
      clash.place = nearest.place;
      clash.model_point = found_.of_site ? static_cast<std::uint32_t>(i) : clashes_[i].met.point.record;
      if (found_.of_site) list.met.push_back(clashes_[i].met);
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
        clash.distances.push_back(member.distance);
        clash.closest_poses.push_back(member.closest_pose);
        list.points.push_back(member.point);
        list.places.push_back(member.place);
      }
      list.clashes.push_back(std::move(clash));
    }
    nameClashes(list.clashes, distance_);
    return list;
  }

  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  const Site& site_;
  const double distance_;
  Pieces found_;
  std::vector<Piece> clashes_;
};

ClashFinder::ClashFinder(const Site& site, double cluster_distance)
: joining_(std::make_unique<Joining>(site, cluster_distance))
{
}

ClashFinder::~ClashFinder() = default;

std::vector<double> ClashFinder::numbersOf(const Tile& tile, const pcl::PCLPointCloud2& cloud,
                                           const CollidingRecords& found, const std::vector<MetPoint>* met) const
{
  return site::numbersOf(joining_->piecesOf(tile, cloud, found, met));
}

void ClashFinder::add(const std::vector<double>& numbers, std::size_t begin)
{
  joining_->add(numbers.data() + begin, numbers.data() + numbers.size());
}

SiteClashes ClashFinder::finish()
{
  return joining_->finish();
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

} // namespace pcl_bsh::site
