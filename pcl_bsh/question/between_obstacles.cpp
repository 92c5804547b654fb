// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/obstacles.h>

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/clashes/near_boxes.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/question/joined_answers.h>
#include <pcl_bsh/question/overlap.h>
#include <pcl_bsh/scene/pairs/object_boxes.h>

#include <algorithm>
#include <utility>

namespace pcl_bsh {
namespace {

using Numbers = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Numbers> allPairs(std::uint32_t obstacles)
{
  std::vector<Numbers> all;
  for (std::uint32_t i = 0; i < obstacles; ++i)
    for (std::uint32_t k = i + 1; k < obstacles; ++k) all.emplace_back(i, k);
  return all;
}

/// Pairs whose boxes of all poses come within the greater of their clearances, in order: all others are free.
/// @param shapes whose hierarchies are built. @param questions about each
std::vector<Numbers> nearPairs(const std::vector<Shape>& shapes, const std::vector<Question>& questions)
{
  std::vector<std::uint32_t> numbers; // of obstacles with finite records
  std::vector<Extent> boxes;
  for (std::uint32_t i = 0; i < shapes.size(); ++i) {
    const Box3 shape = boxOf(shapes[i].hierarchy());
    if (shape.empty()) continue;
    Box3 box;
    for (const Eigen::Isometry3d& pose : questions[i].poses()) box.merge(moved(shape, pose));
    numbers.push_back(i);
    boxes.push_back({{box.low.x(), box.low.y(), box.low.z()}, {box.high.x(), box.high.y(), box.high.z()}});
  }
  NearBoxes tree(boxes);
  std::vector<Numbers> near;
  for (std::size_t b = 0; b < boxes.size(); ++b)
    tree.visitNear(boxes[b], questions[numbers[b]].clearance.value_or(0.0), [&](std::size_t other) {
      if (other != b) near.emplace_back(std::minmax(numbers[b], numbers[other]));
      return false;
    });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

/// Returns the area of an obstacle's surface within another, if that is a solid.
/// @param between the question about both
std::optional<Interval> overlapOf(const Question& between, const DistanceResult& closest, Shape& surface, Shape& solid)
{
  if (!between.solid || !surface.isSurface()) return std::nullopt;
  if (!(closest.distance <= 0.0)) return Interval{0.0, 0.0};
  return areaWithin(between, surface, solid);
}

/// How two obstacles stand to each other. @param one, @param other the questions about each
ObstaclePair pairOf(const Question& question, const Question& one, Shape& first, const Question& other, Shape& second)
{
  Question between;
  between.accuracy = question.accuracy;
  between.threads = question.threads;
  between.pose_of_input = one.pose;
  between.pose = other.pose;
  between.clearance = std::max(one.clearance.value_or(0.0), other.clearance.value_or(0.0));
  between.uncertainty = one.obstacle_uncertainty;
  between.obstacle_uncertainty = other.obstacle_uncertainty;
  between.sigmas = question.sigmas;
  between.ignore_points = between.obstacle_ignore_points = question.obstacle_ignore_points;
  between.input_solid = one.solid;
  between.solid = other.solid;
  between.wanted.any = between.wanted.closest = true;
  const Answer answer = ask(between, first, second);
  ObstaclePair pair{0, 0, *between.clearance, answer.any.verdict, answer.closest};
  if (!question.wanted.overlap) return pair;
  pair.first_within = overlapOf(between, answer.closest, first, second);
  std::swap(between.pose, between.pose_of_input);
  std::swap(between.uncertainty, between.obstacle_uncertainty);
  between.solid = one.solid;
  pair.second_within = overlapOf(between, answer.closest, second, first);
  return pair;
}

/// Adds how they stand at a later pose.
void join(ObstaclePair& all, ObstaclePair&& now)
{
  const bool is_graver = graver(all.verdict, now.verdict) != all.verdict;
  const Verdict verdict = is_graver ? now.verdict : all.verdict;
  const std::int32_t first_pose = is_graver ? now.first_pose : all.first_pose;
  if (now.closest.distance < all.closest.distance) all = std::move(now);
  all.verdict = verdict;
  all.first_pose = first_pose;
}

/// How they stand to each other at all poses of their paths.
ObstaclePair pairAlong(const Question& question, Question one, Shape& first, Question other, Shape& second)
{
  if (!one.path) return pairOf(question, one, first, other, second);
  ObstaclePair all;
  for (std::size_t k = 0; k < one.path->size(); ++k) {
    const Eigen::Isometry3d &of_one = (*one.path)[k], &of_other = (*other.path)[k];
    if (k > 0 && of_one.matrix() == one.pose.matrix() && of_other.matrix() == other.pose.matrix()) continue;
    one.pose = of_one;
    other.pose = of_other;
    ObstaclePair now = pairOf(question, one, first, other, second);
    const auto pose = static_cast<std::int32_t>(k);
    now.first_pose = now.verdict == Verdict::free ? -1 : pose;
    now.closest_pose = now.closest.pair ? pose : -1;
    if (k == 0)
      all = std::move(now);
    else
      join(all, std::move(now));
  }
  return all;
}

} // namespace

std::vector<ObstaclePair> askBetween(const Question& question, const std::vector<PlacedShape>& obstacles,
                                     const std::function<bool(std::uint32_t, std::uint32_t)>& wanted)
{
  Question of_one = question;
  of_one.path.reset();
  requirePaths(of_one, obstacles);
  of_one.pose.setIdentity();
  of_one.pose_uncertainty = {};
  std::vector<Question> questions;
  std::vector<Shape> shapes; // copies, for what is built here is built for other uncertainties
  for (const PlacedShape& obstacle : obstacles) {
    questions.push_back(questionOf(of_one, obstacle));
    shapes.push_back(obstacle.shape);
    shapes.back().ignore(question.obstacle_ignore_points);
    shapes.back().hierarchy(questions.back().uncertaintyOfObstacle(), question.threads);
  }
  const bool tells_free = obstacles.size() <= most_obstacles_with_free_pairs;
  std::vector<Numbers> asked =
      tells_free ? allPairs(static_cast<std::uint32_t>(obstacles.size())) : nearPairs(shapes, questions);
  asked.erase(
      std::remove_if(asked.begin(), asked.end(), [&](const Numbers& pair) { return !wanted(pair.first, pair.second); }),
      asked.end());

  if (asked.size() > 1) of_one.threads = 1; // each pair has one

  std::function<bool(double)> report; // all else is done: this comes last
  if (question.progress) report = [&](double) { return question.progress(1.0); };
  Progress progress(report);
  progress.begin(1.0, asked.size());
  std::vector<ObstaclePair> pairs(asked.size());
  parallelFor(asked.size(), threadCount(question.threads), [&](std::size_t p) {
    if (progress.stopped()) return;
    const std::uint32_t i = asked[p].first, k = asked[p].second;
    Shape first = shapes[i], second = shapes[k]; // copies that share what is built
    pairs[p] = pairAlong(of_one, questions[i], first, questions[k], second);
    pairs[p].first = i;
    pairs[p].second = k;
    progress.step();
  });
  progress.end();
  const auto isUntold = [&](const ObstaclePair& pair) { return !tells_free && pair.verdict == Verdict::free; };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), isUntold), pairs.end());
  return pairs;
}

} // namespace pcl_bsh
