// SPDX-License-Identifier: BSD-3-Clause
#include "answers.h"

#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::symmetries {
namespace {

void askPair(const Instance& instance, const Placed& a, const Placed& b, Answers& answers)
{
  const double clearance = instance.clearance;
  answers.any = static_cast<std::uint8_t>(anyCollision(a, b, {clearance, instance.threads}).verdict);
  FlagsRequest flags;
  flags.clearance = clearance;
  flags.flagged = Flagged::both;
  flags.threads = instance.threads;
  const FlagsResult flagged = collisionFlags(a, b, flags);
  answers.flags_a = numbersOf(flagged.a);
  answers.flags_b = numbersOf(flagged.b);
  const CollidingIndices indices = collidingIndices(a, b, flags);
  answers.indices_a = indices.a;
  answers.indices_b = indices.b;
  const DistanceResult closest = closestPair(a, b, {{}, instance.threads});
  answers.closest = closest.distance;
  answers.names.closest = closest.pair;
  for (const Contact& contact : nearestContacts(a, b, {clearance}).contacts)
    answers.contacts.emplace_back(contact.pair, contact.distance);
  std::sort(answers.contacts.begin(), answers.contacts.end());
  PointDistancesRequest all;
  all.threads = instance.threads;
  const SymmetricDistances distances = symmetricDistances(a, b, all);
  answers.distances_a = distances.a.distance;
  answers.distances_b = distances.b.distance;
  answers.names.nearest_a = distances.a.closest_point;
  answers.names.nearest_b = distances.b.closest_point;
  answers.hausdorff = distances.hausdorff;
  answers.names.hausdorff = distances.hausdorff_pair;
  all.max_distance = clearance;
  answers.limited_a = pointDistances(a, b, all).distance;
}

void askOwn(const Instance& instance, const SphereHierarchy& a, Answers& answers)
{
  Neighbors found;
  for (const Point3& query : instance.queries) {
    Answers::Near near;
    radiusSearch(a, query, instance.clearance, found);
    for (std::size_t i = 0; i < found.indices.size(); ++i)
      near.within.emplace_back(found.indices[i], found.squared_distances[i]);
    std::sort(near.within.begin(), near.within.end());
    nearestKSearch(a, query, 5, found);
    near.nearest = found.squared_distances;
    near.any = anyInRadius(a, query, instance.clearance);
    answers.near.push_back(near);
  }
  boxSearch(a, instance.low, instance.high, answers.box);
  const Clusters clusters = euclideanClusters(a, instance.clearance);
  answers.clusters.resize(clusters.of.size());
  std::vector<std::int32_t> first(clusters.sizes.size(), kNothing);
  for (std::size_t i = 0; i < clusters.of.size(); ++i) {
    const std::int32_t cluster = clusters.of[i];
    std::int32_t& smallest = cluster < 0 ? answers.clusters[i] : first[static_cast<std::size_t>(cluster)];
    if (cluster < 0 || smallest < 0) smallest = cluster < 0 ? std::int32_t{kNothing} : static_cast<std::int32_t>(i);
    answers.clusters[i] = smallest;
  }
}

/// Flags, each 1 where it is `verdict`.
std::vector<std::uint8_t> where(const std::vector<Verdict>& flags, Verdict verdict)
{
  std::vector<std::uint8_t> found;
  for (const Verdict flag : flags) found.push_back(flag == verdict);
  return found;
}

void askMotion(const Instance& instance, const Placed& a, const SphereHierarchy& b, Answers& answers)
{
  TrajectoryRequest along;
  MotionsRequest each;
  along.swept = each.swept = instance.tolerance;
  along.threads = each.threads = instance.threads;
  std::vector<PoseMotion> edges;
  for (std::uint32_t i = 1; i < instance.path.size(); ++i) edges.push_back({i - 1, i});
  const auto flags = [&](double clearance) {
    along.clearance = clearance;
    return collideAlong(a, b, instance.path, along).flags;
  };
  const auto verdicts = [&](double clearance) {
    each.clearance = clearance;
    return anyCollisionOnMotions(a, b, instance.path, edges, each).flags;
  };
  const auto told = [&](const auto& ask) {
    const std::vector<Verdict> near = ask(instance.clearance),
                               far = ask(std::nextafter(instance.clearance + instance.tolerance, HUGE_VAL));
    return Answers::Motion{where(near, Verdict::free), where(near, Verdict::colliding), where(far, Verdict::free)};
  };
  answers.swept = told(flags);
  answers.motions = told(verdicts);
}

void askAlong(const Instance& instance, const Placed& a, const SphereHierarchy& b, Answers& answers)
{
  TrajectoryRequest request;
  request.clearance = instance.clearance;
  request.distances = request.first_poses = request.closest_poses = request.pose_summaries = true;
  request.threads = instance.threads;
  const TrajectoryResult along = collideAlong(a, b, instance.path, request);
  answers.path_flags = numbersOf(along.flags);
  answers.path_distances = along.distance;
  answers.first_poses = along.first_pose;
  answers.closest_poses = along.closest_pose;
  answers.names.closest_point = along.closest_point;
  for (const PoseSummary& pose : along.poses) {
    answers.colliding_at.push_back(pose.colliding_points);
    answers.colliding_at.push_back(pose.undecided_points);
    answers.distance_at.push_back(pose.distance);
  }
  answers.any_at = numbersOf(anyCollisionAtPoses(a, b, instance.path, {instance.clearance, instance.threads}).flags);
  answers.closest_at = closestPairAtPoses(a, b, instance.path, {{}, instance.threads}).distances;
}

void askQuestion(const Instance& instance, const PointsView& a, const PointsView& b, Answers& answers)
{
  Shape input("a", a), obstacle("b", b);
  Question question;
  question.pose = instance.relative.front();
  question.clearance = instance.clearance;
  question.limits = {instance.clearance / 2, 2 * instance.clearance};
  question.threads = instance.threads;
  Wanted& wanted = question.wanted;
  wanted.flags = wanted.contacts = wanted.closest = wanted.distances = wanted.both_ways = wanted.within = true;
  const Answer at_one = ask(question, input, obstacle);
  answers.asked_flags = numbersOf(at_one.collisions.flags);
  answers.asked_obstacle_flags = numbersOf(at_one.obstacle_flags);
  answers.asked_within = at_one.within;
  answers.asked_distances = at_one.collisions.distance;
  answers.asked_both_ways = at_one.distances.b.distance;
  answers.asked_closest = at_one.closest.distance;
  question.path = instance.relative;
  wanted.distances = wanted.both_ways = wanted.within = false;
  answers.asked_path_flags = numbersOf(ask(question, input, obstacle).collisions.flags);
}

Answers::Surface askFaces(const Instance& instance, const PointsView& a, const TrianglesView& faces, bool solid)
{
  const auto ask_of = [&](const Eigen::Isometry3d& input, const Eigen::Isometry3d& obstacle, bool along) {
    Question question;
    question.pose_of_input = input;
    question.pose = obstacle;
    question.clearance = instance.clearance;
    question.threads = instance.threads;
    question.wanted.flags = true;
    question.wanted.distances = question.wanted.closest = !along;
    if (along) question.path = instance.path;
    return question;
  };
  Shape points("a", a), surface("b", viewOf(faces));
  Question question = ask_of(instance.a.pose, instance.b.pose, false);
  question.solid = solid;
  Answers::Surface told;
  const Answer at_one = ask(question, points, surface);
  told.flags = numbersOf(at_one.collisions.flags);
  told.distances = at_one.collisions.distance;
  told.closest = at_one.closest.distance;
  question = ask_of(instance.a.pose, instance.b.pose, true);
  question.solid = solid;
  told.path_flags = numbersOf(ask(question, points, surface).collisions.flags);
  const Answer reversed = ask(ask_of(instance.b.pose, instance.a.pose, false), surface, points);
  told.face_flags = numbersOf(reversed.collisions.flags);
  told.face_distances = reversed.collisions.distance;
  return told;
}

// Comparison ------------------------------------------------------------------------------------------------------

template <class Value>
bool same(const Value& l, const Value& r)
{
  if constexpr (std::is_floating_point_v<Value>) return l == r || (std::isnan(l) && std::isnan(r));
  return l == r;
}

bool same(const Answers::Near& l, const Answers::Near& r)
{
  return l.within == r.within && l.any == r.any;
}

template <class Value>
std::string textOf(const Value& value)
{
  if constexpr (std::is_arithmetic_v<Value>) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", static_cast<double>(value));
    return text;
  }
  return "...";
}

std::string textOf(const std::optional<PointPair>& pair)
{
  return pair ? std::to_string(pair->a) + " and " + std::to_string(pair->b) : "none";
}

std::string textOf(const std::pair<PointPair, double>& contact)
{
  return textOf(std::optional(contact.first)) + " at " + textOf(contact.second);
}

/// Keeps the first difference.
class Comparison {
public:
  template <class Value>
  void operator()(const char* what, const Value& expected, const Value& found)
  {
    if (text.empty() && !same(expected, found)) tell(what, textOf(expected), textOf(found));
  }

  template <class Value>
  void operator()(const char* what, const std::vector<Value>& expected, const std::vector<Value>& found)
  {
    if (!text.empty()) return;
    for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i)
      if (!same(expected[i], found[i]))
        return tell(std::string(what) + " of " + std::to_string(i), textOf(expected[i]), textOf(found[i]));
    if (expected.size() != found.size())
      tell(std::string("number of ") + what, std::to_string(expected.size()), std::to_string(found.size()));
  }

  std::string text;

private:
  void tell(const std::string& what, const std::string& expected, const std::string& found)
  {
    text = what + ": " + found + " instead of " + expected;
  }
};

} // namespace

Answers answersOf(const Instance& instance)
{
  const test::Cloud cloud_a = instance.a.cloud(), cloud_b = instance.b.cloud();
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  const Placed placed_a(a, instance.a.pose), placed_b(b, instance.b.pose);
  Answers answers;
  if (instance.tolerance > 0.0) askMotion(instance, placed_a, b, answers);
  askPair(instance, placed_a, placed_b, answers);
  askOwn(instance, a, answers);
  askAlong(instance, placed_a, b, answers);
  askQuestion(instance, cloud_a.view(), cloud_b.view(), answers);
  const test::Cloud vertices(instance.b.points, {instance.b.scalar});
  for (const bool solid : {false, true}) {
    const std::vector<Triangle>& faces = solid ? instance.shell : instance.faces;
    if (faces.empty()) continue;
    (solid ? answers.shell : answers.surface) =
        askFaces(instance, cloud_a.view(), {vertices.view(), faces.front().data(), faces.size()}, solid);
  }
  return answers;
}

std::string firstDifference(const Answers& expected, const Answers& found, const Kept& kept)
{
  Comparison compare;
#define PCL_BSH_COMPARE(member) compare(#member, expected.member, found.member)
  PCL_BSH_COMPARE(any);
  PCL_BSH_COMPARE(flags_a);
  PCL_BSH_COMPARE(flags_b);
  PCL_BSH_COMPARE(indices_a);
  PCL_BSH_COMPARE(indices_b);
  PCL_BSH_COMPARE(closest);
  PCL_BSH_COMPARE(contacts);
  PCL_BSH_COMPARE(distances_a);
  PCL_BSH_COMPARE(distances_b);
  PCL_BSH_COMPARE(limited_a);
  PCL_BSH_COMPARE(hausdorff);
  if (kept.names) {
    PCL_BSH_COMPARE(names.closest);
    PCL_BSH_COMPARE(names.hausdorff);
    PCL_BSH_COMPARE(names.nearest_a);
    PCL_BSH_COMPARE(names.nearest_b);
    if (kept.along) PCL_BSH_COMPARE(names.closest_point);
  }
  if (kept.own) {
    PCL_BSH_COMPARE(near);
    PCL_BSH_COMPARE(box);
    for (std::size_t i = 0; kept.nearest && i < expected.near.size(); ++i) PCL_BSH_COMPARE(near[i].nearest);
    if (kept.nearest) PCL_BSH_COMPARE(clusters);
  }
  if (kept.along) {
    PCL_BSH_COMPARE(path_flags);
    PCL_BSH_COMPARE(path_distances);
    PCL_BSH_COMPARE(first_poses);
    PCL_BSH_COMPARE(closest_poses);
    PCL_BSH_COMPARE(colliding_at);
    PCL_BSH_COMPARE(distance_at);
    PCL_BSH_COMPARE(any_at);
    PCL_BSH_COMPARE(closest_at);
  }
  if (kept.motions) {
    PCL_BSH_COMPARE(motions.free);
    PCL_BSH_COMPARE(motions.hit);
  }
  if (kept.question) {
    PCL_BSH_COMPARE(asked_flags);
    PCL_BSH_COMPARE(asked_obstacle_flags);
    PCL_BSH_COMPARE(asked_within);
    PCL_BSH_COMPARE(asked_path_flags);
    PCL_BSH_COMPARE(asked_distances);
    PCL_BSH_COMPARE(asked_both_ways);
    PCL_BSH_COMPARE(asked_closest);
  }
  if (kept.surface) {
    PCL_BSH_COMPARE(surface.flags);
    PCL_BSH_COMPARE(surface.path_flags);
    PCL_BSH_COMPARE(surface.distances);
    PCL_BSH_COMPARE(surface.face_flags);
    PCL_BSH_COMPARE(surface.face_distances);
    PCL_BSH_COMPARE(surface.closest);
    PCL_BSH_COMPARE(shell.flags);
    PCL_BSH_COMPARE(shell.path_flags);
    PCL_BSH_COMPARE(shell.distances);
    PCL_BSH_COMPARE(shell.face_flags);
    PCL_BSH_COMPARE(shell.face_distances);
    PCL_BSH_COMPARE(shell.closest);
  }
#undef PCL_BSH_COMPARE
  return compare.text;
}

} // namespace pcl_bsh::symmetries
