// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/question/joined_answers.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/answers/enclosed_in_tile.h>
#include <pcl_bsh/site/answers/nearest_records.h>
#include <pcl_bsh/site/answers/tile_query.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pcl_bsh::site {
namespace {

using Kind = NearRecord::Kind;

/// The smallest distance of what collides counts, then the smallest point.
const NearRecord& nearestColliding(const std::vector<NearRecord>& some, Interval& interval)
{
  const NearRecord* best = nullptr;
  for (const NearRecord& near : some) {
    if (near.kind != Kind::colliding) continue;
    if (!best || std::tie(near.distance, near.point) < std::tie(best->distance, best->point)) best = &near;
    if (!std::isinf(near.interval.lower)) widen(interval, near.interval);
  }
  return *best;
}

/// Among equal distances the first pose counts, then the nearest pair by exact arithmetic, as in one hierarchy.
NearRecord nearestMeasured(const QuestionPart& part, const std::vector<NearRecord>& some)
{
  const auto key = [](const NearRecord& near) { return std::pair(near.distance, near.pose); };
  std::vector<NearRecord> last;
  for (const NearRecord& near : some) {
    if (near.kind != Kind::measured || (!last.empty() && key(near) > key(last.front()))) continue;
    if (!last.empty() && key(near) < key(last.front())) last.clear();
    last.push_back(near);
  }
  if (last.size() == 1) return last.front();
  std::sort(last.begin(), last.end(), [](const NearRecord& a, const NearRecord& b) { return a.point < b.point; });
  std::vector<Point3> places;
  for (const NearRecord& near : last) places.push_back(near.place);
  const SphereHierarchy hierarchy(viewOf(places.front().data(), places.size()));
  const Eigen::Isometry3d pose = part.question.poses()[static_cast<std::size_t>(last.front().pose)];
  DistanceResult found = closestPair(hierarchy, {part.model(), pose});
  if (!part.question.path) addEnclosedOf(part, hierarchy, found);
  NearRecord best = last[found.pair->a];
  best.record = found.pair->b;
  return best;
}

} // namespace

void append(std::vector<double>& numbers, const NearRecord& near)
{
  numbers.insert(numbers.end(), {static_cast<double>(near.obstacle), static_cast<double>(near.kind), near.distance,
                                 near.interval.lower, near.interval.upper, static_cast<double>(near.pose),
                                 static_cast<double>(near.record), static_cast<double>(near.point.source),
                                 static_cast<double>(near.point.record), near.place[0], near.place[1], near.place[2]});
}

NearRecord nearRecordFrom(const double* in)
{
  return {static_cast<std::uint32_t>(in[0]),
          static_cast<Kind>(static_cast<std::uint32_t>(in[1])),
          in[2],
          {in[3], in[4]},
          static_cast<std::int32_t>(in[5]),
          static_cast<std::uint32_t>(in[6]),
          {static_cast<std::uint32_t>(in[7]), static_cast<std::uint32_t>(in[8])},
          {in[9], in[10], in[11]}};
}

NearestRecords::NearestRecords(std::size_t obstacles) : least_(obstacles, infinity), of_(obstacles)
{
}

void NearestRecords::limit(std::uint32_t obstacle, double distance)
{
  least_[obstacle] = std::min(least_[obstacle], distance);
}

void NearestRecords::add(const NearRecord& near)
{
  if (near.kind != Kind::enclosed) limit(near.obstacle, near.distance);
  of_[near.obstacle].push_back(near);
}

void NearestRecords::gather()
{
  if (ranks() == 1) return;
  std::vector<NearRecord> own;
  for (std::vector<NearRecord>& some : of_) {
    own.insert(own.end(), some.begin(), some.end());
    some.clear();
  }
  for (const NearRecord& near : gatheredFromAllRanks(own)) add(near);
}

void NearestRecords::tell(const QuestionPart& part, std::uint32_t obstacle, SiteObstacleAnswer& answer) const
{
  const auto has = [&](Kind kind) {
    return std::any_of(of_[obstacle].begin(), of_[obstacle].end(),
                       [&](const NearRecord& near) { return near.kind == kind; });
  };
  Interval interval;
  NearRecord best;
  if (has(Kind::colliding))
    best = nearestColliding(of_[obstacle], interval);
  else if (has(Kind::measured))
    interval = (best = nearestMeasured(part, of_[obstacle])).interval;
  else
    return;
  answer.closest.distance = best.distance;
  answer.closest.interval = interval;
  answer.closest.pair = PointPair{0, best.record};
  answer.closest_pose = part.question.path ? best.pose : -1;
  answer.pair = SitePair{best.point, {0, best.record}};
  answer.place = best.place;
}

std::optional<Point3> NearestRecords::enclosed(std::uint32_t obstacle) const
{
  const NearRecord* first = nullptr;
  for (const NearRecord& near : of_[obstacle])
    if (near.kind == Kind::enclosed && (!first || near.pose < first->pose)) first = &near;
  return first ? std::optional(first->place) : std::nullopt;
}

} // namespace pcl_bsh::site
