// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/clashes.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/clashes/near_boxes.h>
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/trajectory/told_distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace pcl_bsh {
namespace {

Point3 middleOf(const Clash& clash)
{
  Point3 middle;
  for (std::size_t k = 0; k < 3; ++k) middle[k] = 0.5 * clash.low[k] + 0.5 * clash.high[k];
  return middle;
}

std::string idAt(const char* letter, const Point3& place, double cell)
{
  const auto number = [&](std::size_t axis) { return static_cast<long long>(std::floor(place[axis] / cell)); };
  return plainText(letter, number(0), "_", number(1), "_", number(2));
}

/// Ids that are taken.
class TakenIds {
public:
  void take(const std::string& id) { taken_.insert(id); }

  /// `id`, or with #2, #3, ... behind it, whichever is not taken yet; takes it.
  std::string free(const std::string& id)
  {
    if (taken_.insert(id).second) return id;
    for (int& n = last_.try_emplace(id, 1).first->second;;) {
      std::string candidate = id + "#" + std::to_string(++n);
      if (taken_.insert(candidate).second) return candidate;
    }
  }

private:
  std::set<std::string> taken_;
  std::map<std::string, int> last_; ///< the last number that was tried behind an id
};

void giveIds(std::vector<Clash>& clashes, const char* letter, double cluster_distance)
{
  const double cell = std::exp2(std::ceil(std::log2(4 * cluster_distance)));
  std::vector<Clash*> by_place;
  for (Clash& clash : clashes) by_place.push_back(&clash);
  std::stable_sort(by_place.begin(), by_place.end(), [](const Clash* a, const Clash* b) {
    return std::tie(a->low, a->high) < std::tie(b->low, b->high);
  });
  TakenIds taken;
  for (Clash* clash : by_place) clash->id = taken.free(idAt(letter, middleOf(*clash), cell));
}

/// Adds the record of an entry of the result.
void add(Clash& clash, std::uint32_t record, std::size_t entry, const PointsView& scan, const TrajectoryResult& found)
{
  clash.records.push_back(record);
  clash.distances.push_back(found.distance[entry]);
  clash.closest_poses.push_back(found.closest_pose[entry]);
  ++clash.points;
  if (found.flags[entry] == Verdict::colliding) ++clash.certain_points;
  const Extent extent = extentOf(scan, record);
  for (std::size_t k = 0; k < 3; ++k) { // -0 becomes 0: boxes do not depend on the order of points
    clash.low[k] = std::min(clash.low[k], extent.low[k] + 0.0);
    clash.high[k] = std::max(clash.high[k], extent.high[k] + 0.0);
  }
  clash.first_pose = std::min(clash.first_pose, found.first_pose[entry]);
  const double distance = toldDistance(found, entry);
  if (!found.interval.empty() && !std::isnan(found.interval[entry].lower)) {
    clash.interval.lower = std::fmin(clash.interval.lower, found.interval[entry].lower);
    clash.interval.upper = std::fmin(clash.interval.upper, found.interval[entry].upper);
  }
  if (!(distance < clash.distance)) return;
  clash.distance = distance;
  clash.scan_point = record;
  clash.place = scan.point(record);
  clash.model_point = found.closest_point[entry];
  clash.closest_pose = found.closest_pose[entry];
}

/// @param records that the result is about
void check(std::size_t records, const TrajectoryResult& found, double cluster_distance)
{
  if (!(std::isfinite(cluster_distance) && cluster_distance > 0.0)) {
    throw InvalidInput(Input::cluster_distance, "cluster distance", plainText(cluster_distance),
                       "give a finite length > 0")
        .withValue(cluster_distance);
  }
  for (const std::size_t size : {found.flags.size(), found.distance.size(), found.first_pose.size(),
                                 found.closest_pose.size(), found.closest_point.size()}) {
    if (size == records) continue;
    throw InvalidInput(Input::result, "result", "has " + counted(size, "value") + " for " + counted(records, "point"),
                       "ask for flags, distances, first_poses and closest_poses of this scan");
  }
}

double squaredDistance(const Point3& p, const Point3& q)
{
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) sum += (p[k] - q[k]) * (p[k] - q[k]);
  return sum;
}

} // namespace

const char* nameOf(ClashStatus status) noexcept
{
  constexpr std::array<const char*, clash_statuses> names = {"new",         "persisting",  "resolved",
                                                             "not_visited", "not_scanned", "unseen"};
  return names[static_cast<std::size_t>(status)];
}

CollidingRecords::CollidingRecords(const TrajectoryResult& of_all)
{
  for (std::size_t i = 0; i < of_all.flags.size(); ++i)
    if (of_all.flags[i] != Verdict::free) records.push_back(static_cast<std::int32_t>(i));
  const auto keep = [&](const auto& of_each, auto& kept) {
    if (of_each.size() != of_all.flags.size()) return; // was not asked for
    kept.reserve(records.size());
    for (const std::int32_t i : records) kept.push_back(of_each[static_cast<std::size_t>(i)]);
  };
  keep(of_all.flags, found.flags);
  keep(of_all.distance, found.distance);
  keep(of_all.first_pose, found.first_pose);
  keep(of_all.closest_pose, found.closest_pose);
  keep(of_all.closest_point, found.closest_point);
  keep(of_all.interval, found.interval);
  keep(of_all.certain_pose, found.certain_pose);
  found.colliding = of_all.colliding;
  found.undecided = of_all.undecided;
  found.poses = of_all.poses;
  found.first_contact = of_all.first_contact;
  found.certain_contact = of_all.certain_contact;
  found.work = of_all.work;
}

std::vector<Clash> findClashes(const PointsView& scan, const TrajectoryResult& found, double cluster_distance)
{
  check(scan.count, found, cluster_distance);
  return findClashes(scan, CollidingRecords(found), cluster_distance);
}

std::vector<Clash> findClashes(const PointsView& scan, const CollidingRecords& colliding, double cluster_distance)
{
  const std::vector<std::int32_t>& records = colliding.records;
  check(records.size(), colliding.found, cluster_distance);
  if (records.empty()) return {};
  PointsView subset = scan;
  subset.restrictTo(records.data(), records.size());
  const Clusters clusters = euclideanClusters(SphereHierarchy(subset), cluster_distance);

  constexpr double infinity = std::numeric_limits<double>::infinity();
  Clash none;
  none.low = {infinity, infinity, infinity};
  none.high = {-infinity, -infinity, -infinity};
  none.distance = infinity;
  none.first_pose = std::numeric_limits<std::int32_t>::max();
  std::vector<Clash> clashes(clusters.sizes.size(), none);
  for (std::size_t entry = 0; entry < records.size(); ++entry) {
    const auto record = static_cast<std::uint32_t>(records[entry]);
    add(clashes[static_cast<std::size_t>(clusters.of[record])], record, entry, scan, colliding.found);
  }
  nameClashes(clashes, cluster_distance);
  return clashes;
}

void nameClashes(std::vector<Clash>& clashes, double cluster_distance)
{
  giveIds(clashes, "C", cluster_distance);
  std::sort(clashes.begin(), clashes.end(), isMoreSevere);
}

bool isMoreSevere(const Clash& one, const Clash& other)
{
  const auto key = [](const Clash& clash) {
    const double distance = clash.wasNoClash() ? std::numeric_limits<double>::infinity() : clash.distance;
    return std::tuple(!clash.isCertain(), distance);
  };
  return std::tuple_cat(key(one), std::tie(other.points, one.id)) <
         std::tuple_cat(key(other), std::tie(one.points, other.id));
}

void nameUnseenPlaces(std::vector<Clash>& places, double cluster_distance)
{
  for (Clash& place : places) place.place = middleOf(place);
  giveIds(places, "U", cluster_distance);
  std::sort(places.begin(), places.end(), isMoreSevere);
}

std::uint64_t compareWithEarlier(std::vector<Clash>& clashes, const std::vector<Clash>& earlier, double nearness)
{
  // Every pair that touches, the nearest first; ids pass on one to one.
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  std::vector<bool> there_still(earlier.size(), false);
  std::vector<Extent> boxes;
  for (const Clash& clash : clashes) boxes.push_back({clash.low, clash.high});
  NearBoxes now(std::move(boxes));
  for (std::size_t j = 0; j < earlier.size(); ++j) {
    if (earlier[j].status == ClashStatus::resolved) {
      there_still[j] = true; // forgotten
      continue;
    }
    now.visitNear({earlier[j].low, earlier[j].high}, nearness, [&](std::size_t i) {
      if (clashes[i].wasNoClash() != earlier[j].wasNoClash()) return false;
      pairs.emplace_back(squaredDistance(middleOf(clashes[i]), middleOf(earlier[j])), j, i);
      if (!clashes[i].wasNoClash()) clashes[i].status = ClashStatus::persisting;
      there_still[j] = true;
      return false;
    });
  }
  std::sort(pairs.begin(), pairs.end());

  TakenIds taken;
  for (const Clash& clash : earlier) taken.take(clash.id);
  std::vector<bool> heir(clashes.size(), false), inherited(earlier.size(), false);
  for (const auto& [distance, j, i] : pairs) {
    if (heir[i] || inherited[j]) continue;
    heir[i] = inherited[j] = true;
    clashes[i].id = earlier[j].id;
  }
  for (std::size_t i = 0; i < clashes.size(); ++i) {
    if (!heir[i]) clashes[i].id = taken.free(clashes[i].id);
  }

  for (std::size_t j = 0; j < earlier.size(); ++j) {
    if (there_still[j] || earlier[j].wasNoClash()) continue;
    clashes.push_back(earlier[j]);
    clashes.back().status = ClashStatus::resolved;
    clashes.back().clearRecords(); // these are records of an earlier scan
  }
  return now.compared;
}

} // namespace pcl_bsh
