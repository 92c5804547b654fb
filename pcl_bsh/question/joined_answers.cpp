// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/joined_answers.h>

#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/trajectory/told_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace pcl_bsh {
namespace {

bool isNearer(double one, double other)
{
  return std::isnan(other) ? !std::isnan(one) : one < other;
}

/// Returns the earlier of two poses, given by number; a number below 0 is no pose.
std::int32_t earlier(std::int32_t one, std::int32_t other)
{
  if (one < 0 || other < 0) return std::max(one, other);
  return std::min(one, other);
}

void setEarlier(std::optional<FirstContact>& one, const std::optional<FirstContact>& other)
{
  const auto at = [](const FirstContact& contact) { return static_cast<double>(contact.pose) + contact.fraction; };
  if (other && (!one || at(*other) < at(*one))) one = other;
}

/// Counts records that have a distance, and finds the greatest.
void summarise(PointDistances& all)
{
  all.measured = 0;
  all.greatest = std::numeric_limits<double>::quiet_NaN();
  all.greatest_pair.reset();
  for (std::uint32_t i = 0; i < all.distance.size(); ++i) {
    if (std::isnan(all.distance[i])) continue;
    ++all.measured;
    if (all.distance[i] <= all.greatest) continue;
    all.greatest = all.distance[i];
    all.greatest_pair = PointPair{i, all.closest_point[i]};
  }
}

} // namespace

void JoinedAnswers::add(std::uint32_t obstacle, const Answer& answer)
{
  addCollisions(obstacle, answer.collisions, nullptr);
  addDistances(obstacle, answer.distances.a, answer.within);
  addLists(answer.indices);
  Answer& all = joined_.all;
  if (answer.any.verdict != Verdict::free && graver(all.any.verdict, answer.any.verdict) != all.any.verdict)
    all.any = answer.any;
  if (answer.closest.pair && isNearer(answer.closest.distance, all.closest.distance)) {
    all.closest = answer.closest;
    joined_.closest = obstacle;
  }
  all.widest_gap = std::max(all.widest_gap, answer.widest_gap);
  if (!all.density.input) all.density = answer.density;
  all.work += answer.work;
  for (const Warning& warning : answer.warnings) {
    const auto same = [&](const Warning& known) { return known.text == warning.text; };
    if (std::none_of(all.warnings.begin(), all.warnings.end(), same)) all.warnings.push_back(warning);
  }
  joined_.each.push_back(summaryOf(answer));
}

void JoinedAnswers::add(std::uint32_t obstacle, const std::vector<std::int32_t>& records, const TrajectoryResult& found)
{
  addCollisions(obstacle, found, &records);
  ObstacleAnswer& one = joined_.each.emplace_back();
  one.colliding = found.colliding;
  one.undecided = found.undecided;
}

void JoinedAnswers::setClosest(const DistanceResult& closest, std::int32_t pose)
{
  ObstacleAnswer& one = joined_.each.back();
  one.closest = closest;
  one.closest_pose = pose;
  joined_.all.work += closest.work;
  if (!closest.pair || !isNearer(closest.distance, joined_.all.closest.distance)) return;
  joined_.all.closest = closest;
  joined_.closest = static_cast<std::uint32_t>(joined_.each.size() - 1);
}

ObstaclesAnswer JoinedAnswers::finish(bool moves)
{
  Answer& all = joined_.all;
  TrajectoryResult& found = all.collisions;
  found.colliding = countOf(found.flags, Verdict::colliding);
  found.undecided = countOf(found.flags, Verdict::undecided);
  all.sparse = countOf(found.flags, Verdict::sparse);
  if (joined_.each.size() > 1) summarise(all.distances.a);
  for (auto* const list : {&all.indices.a, &all.indices.undecided_a}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  auto& perhaps = all.indices.undecided_a; // less records that collide with another obstacle
  perhaps.erase(std::remove_if(perhaps.begin(), perhaps.end(),
                               [&](std::int32_t record) {
                                 return std::binary_search(all.indices.a.begin(), all.indices.a.end(), record);
                               }),
                perhaps.end());
  if (!moves)
    for (ObstacleAnswer& one : joined_.each) one.closest_pose = -1;
  return std::move(joined_);
}

void JoinedAnswers::fill(std::size_t poses)
{
  TrajectoryResult& found = joined_.all.collisions;
  if (wanted_.poses) found.poses.resize(poses);
  if (wanted_.flags || wanted_.poses) found.flags.resize(records_, Verdict::free);
  if (wanted_.first_poses) found.first_pose.resize(records_, -1);
  if (!wanted_.contacts) return;
  found.flags.resize(records_, Verdict::free);
  found.distance.resize(records_, std::numeric_limits<float>::quiet_NaN());
  found.first_pose.resize(records_, -1);
  found.closest_pose.resize(records_, -1);
  found.closest_point.resize(records_, kNothing);
  joined_.closest_obstacle.resize(records_, kNothing);
}

ObstacleAnswer JoinedAnswers::summaryOf(const Answer& answer)
{
  ObstacleAnswer one;
  one.colliding = answer.collisions.colliding;
  one.undecided = answer.collisions.undecided;
  one.sparse = answer.sparse;
  one.unseen = answer.unseen.count;
  one.closest = answer.closest;
  const std::vector<std::int32_t>& poses = answer.collisions.closest_pose;
  if (one.closest.pair && one.closest.pair->a < poses.size()) one.closest_pose = poses[one.closest.pair->a];
  for (const auto& [count, verdict] : {std::pair{one.colliding, Verdict::colliding},
                                       {one.undecided, Verdict::undecided},
                                       {one.sparse, Verdict::sparse},
                                       {one.unseen, Verdict::unseen}})
    if (count > 0) one.verdict = graver(one.verdict, verdict);
  one.verdict = graver(one.verdict, answer.any.verdict);
  if (!answer.indices.undecided_a.empty()) one.verdict = graver(one.verdict, Verdict::undecided);
  if (!answer.indices.a.empty()) one.verdict = Verdict::colliding;
  return one;
}

void JoinedAnswers::addCollisions(std::uint32_t obstacle, const TrajectoryResult& more,
                                  const std::vector<std::int32_t>* records)
{
  TrajectoryResult& found = joined_.all.collisions;
  const auto at = [&](std::size_t entry) {
    return records ? static_cast<std::size_t>((*records)[entry]) : entry; // the record of an entry
  };
  const auto grow = [&](auto& all, const auto& one, auto nothing) {
    const std::size_t size = records && !one.empty() ? records_ : one.size();
    if (all.size() < size) all.resize(size, nothing);
  };
  grow(found.flags, more.flags, Verdict::free);
  for (std::size_t i = 0; i < more.flags.size(); ++i) found.flags[at(i)] = graver(found.flags[at(i)], more.flags[i]);
  grow(found.first_pose, more.first_pose, -1);
  for (std::size_t i = 0; i < more.first_pose.size(); ++i)
    found.first_pose[at(i)] = earlier(found.first_pose[at(i)], more.first_pose[i]);
  grow(found.certain_pose, more.certain_pose, -1);
  for (std::size_t i = 0; i < more.certain_pose.size(); ++i)
    found.certain_pose[at(i)] = earlier(found.certain_pose[at(i)], more.certain_pose[i]);
  grow(found.distance, more.distance, std::numeric_limits<float>::quiet_NaN());
  grow(found.closest_pose, more.closest_pose, -1);
  grow(found.closest_point, more.closest_point, kNothing);
  grow(joined_.closest_obstacle, more.distance, kNothing);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  grow(found.interval, more.interval, Interval{unknown, unknown});
  for (std::size_t i = 0; i < more.distance.size(); ++i) {
    const std::size_t record = at(i);
    if (!isNearer(static_cast<double>(more.distance[i]), static_cast<double>(found.distance[record]))) continue;
    found.distance[record] = more.distance[i];
    if (i < more.closest_pose.size()) found.closest_pose[record] = more.closest_pose[i];
    if (i < more.closest_point.size()) found.closest_point[record] = more.closest_point[i];
    if (record < found.interval.size())
      found.interval[record] = i < more.interval.size() ? more.interval[i] : Interval{unknown, unknown};
    joined_.closest_obstacle[record] = obstacle;
  }
  if (found.poses.size() < more.poses.size()) found.poses.resize(more.poses.size());
  for (std::size_t k = 0; k < more.poses.size(); ++k) found.poses[k] += more.poses[k];
  setEarlier(found.first_contact, more.first_contact);
  setEarlier(found.certain_contact, more.certain_contact);
  found.work += more.work;
}

void JoinedAnswers::addDistances(std::uint32_t obstacle, const PointDistances& more,
                                 const std::vector<std::uint8_t>& within)
{
  PointDistances& all = joined_.all.distances.a;
  const bool is_first = all.distance.empty();
  if (is_first) {
    all = more;
    joined_.all.within = within;
    if (!more.distance.empty()) joined_.closest_obstacle.assign(more.distance.size(), kNothing);
  }
  for (std::size_t i = 0; i < more.distance.size(); ++i) {
    if (is_first ? std::isnan(more.distance[i]) : !isNearer(more.distance[i], all.distance[i])) continue;
    joined_.closest_obstacle[i] = obstacle;
    if (is_first) continue;
    all.distance[i] = more.distance[i];
    all.closest_point[i] = more.closest_point[i];
    if (!all.interval.empty()) all.interval[i] = more.interval[i];
    if (!within.empty()) joined_.all.within[i] = within[i];
  }
  if (!is_first) all.work += more.work;
}

void JoinedAnswers::addLists(const CollidingIndices& more)
{
  CollidingIndices& all = joined_.all.indices;
  all.a.insert(all.a.end(), more.a.begin(), more.a.end());
  all.undecided_a.insert(all.undecided_a.end(), more.undecided_a.begin(), more.undecided_a.end());
  all.work += more.work;
}

DistanceResult closestOf(const TrajectoryResult& found)
{
  DistanceResult closest;
  for (std::size_t i = 0; i < found.distance.size(); ++i) {
    const double distance = toldDistance(found, i);
    if (!(distance < closest.distance)) continue;
    closest.distance = distance;
    closest.pair = PointPair{static_cast<std::uint32_t>(i), found.closest_point[i]};
  }
  for (const Interval& interval : found.interval) { // of what solids hold
    if (std::isnan(interval.lower) || !(interval.lower < 0.0)) continue;
    widen(closest.interval, interval);
  }
  return closest;
}

void requirePaths(const Question& question, const std::vector<PlacedShape>& obstacles)
{
  const auto posesOf = [](const PlacedShape& obstacle) { return obstacle.path ? obstacle.path->size() : 0; };
  for (const PlacedShape& obstacle : obstacles) {
    if (obstacle.path && question.path)
      throw InvalidInput(Input::trajectory, obstacle.shape.name(), "has a path, and the question, too",
                         "leave one of them out");
    const std::size_t poses = posesOf(obstacle), others = posesOf(obstacles.front());
    if (poses != others || (obstacle.path && poses == 0))
      throw InvalidInput(Input::trajectory, obstacle.shape.name(),
                         "has a path of " + std::to_string(poses) + " poses, and " + obstacles.front().shape.name() +
                             " of " + std::to_string(others),
                         "give all obstacles as many, one at least, or none a path");
  }
}

void widen(Interval& all, const Interval& one)
{
  all.lower = std::isinf(all.lower) ? one.lower : std::min(all.lower, one.lower);
  all.upper = std::min(all.upper, one.upper);
}

std::pair<DistanceResult, std::int32_t> closestAlong(const Placed& input, const SphereHierarchy& obstacle,
                                                     const std::vector<Eigen::Isometry3d>& poses, double most)
{
  std::pair<DistanceResult, std::int32_t> best{{}, -1};
  DistanceRequest request;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    request.max_distance = std::min(best.first.distance, most);
    DistanceResult found = closestPair(input, {obstacle, poses[k]}, request);
    const Work work = found.work;
    if (found.pair && isNearer(found.distance, best.first.distance)) {
      std::swap(found.work, best.first.work);
      best = {std::move(found), static_cast<std::int32_t>(k)};
    }
    best.first.work += work;
  }
  return best;
}

bool mayAskAny(const Question& question)
{
  return question.wanted.collisions() && !question.path && !question.seen && !question.density &&
         !question.accuracy.stopsEarly();
}

} // namespace pcl_bsh
