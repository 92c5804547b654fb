// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/obstacles.h>

#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/question/joined_answers.h>
#include <pcl_bsh/question/options.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pcl_bsh {
namespace {

/// Refuses what has no meaning for several obstacles.
void requireSeveral(const Question& question, std::size_t obstacles)
{
  if (obstacles < 2) return;
  const Wanted& wanted = question.wanted;
  if (wanted.both_ways || wanted.obstacle_flags || wanted.obstacle_indices)
    throw InvalidInput(Input::points, "obstacles", "are several, and records of the obstacle are asked for",
                       "ask about one at a time");
  if (wanted.within && wanted.distances && question.max_distance.value_or(question.limits.most) < question.limits.most)
    throw InvalidOption("max_distance", "is below the limits, and obstacles are several",
                        "give no less than the limits");
}

/// Returns the wanted answers without those about collisions.
Wanted withoutCollisions(Wanted wanted)
{
  wanted.flags = wanted.obstacle_flags = wanted.any = wanted.indices = wanted.obstacle_indices = false;
  wanted.contacts = wanted.poses = wanted.first_poses = false;
  return wanted;
}

/// The progress of one of several equal parts: it never falls from one to the next.
std::function<bool(double)> progressOfPart(const std::function<bool(double)>& progress, std::size_t part,
                                           std::size_t parts)
{
  if (!progress) return nullptr;
  return [progress, part, parts](double done) {
    return progress((static_cast<double>(part) + done) / static_cast<double>(parts));
  };
}

/// Asks about one obstacle, whose records are not told where it is free.
Answer askOrSpare(const Question& question, Shape& input, Shape& obstacle)
{
  if (!mayAskAny(question)) return ask(question, input, obstacle);
  Question any = question;
  any.wanted = {};
  any.wanted.any = true;
  any.progress = progressOfPart(question.progress, 0, 2);
  const Answer found = ask(any, input, obstacle);
  Question rest = question;
  rest.progress = progressOfPart(question.progress, 1, 2);
  if (found.any.verdict == Verdict::free) rest.wanted = withoutCollisions(question.wanted);
  Answer answer = ask(rest, input, obstacle);
  answer.work += found.work;
  return answer;
}

/// closestAlong() of what the question is about.
std::pair<DistanceResult, std::int32_t> closestOf(const Question& question, Shape& input, Shape& obstacle)
{
  const Placed a(input.hierarchy(question.uncertaintyOfInput(), question.threads), question.pose_of_input);
  return closestAlong(a, obstacle.hierarchy(question.uncertaintyOfObstacle(), question.threads), question.poses());
}

} // namespace

Question questionOf(const Question& question, const PlacedShape& obstacle)
{
  Question one = question;
  if (!obstacle.pose.matrix().isIdentity(0.0)) {
    const auto place = [&](Eigen::Isometry3d& pose) {
      pose = pose.matrix().isIdentity(0.0) ? obstacle.pose : pose * obstacle.pose;
    };
    place(one.pose);
    if (one.path) std::for_each(one.path->begin(), one.path->end(), place);
  }
  if (obstacle.path) one.path = obstacle.path;
  if (obstacle.clearance) one.clearance = obstacle.clearance;
  if (obstacle.solid) one.solid = *obstacle.solid;
  if (obstacle.uncertainty) one.obstacle_uncertainty = *obstacle.uncertainty;
  if (obstacle.uncertainty && !obstacle.uncertainty->pose.isZero()) one.pose_uncertainty = obstacle.uncertainty->pose;
  return one;
}

ObstaclesAnswer ask(const Question& question, Shape& input, std::vector<PlacedShape>& obstacles, const AnswerOf& told)
{
  if (obstacles.empty()) throw InvalidInput(Input::points, "obstacles", "there are none", "give one at least");
  const Wanted& wanted = question.wanted;
  requireSeveral(question, obstacles.size());
  requirePaths(question, obstacles);
  const std::optional<std::vector<Eigen::Isometry3d>>& path = question.path ? question.path : obstacles.front().path;
  const std::size_t records = input.hierarchy(question.uncertaintyOfInput(), question.threads).view().count;
  JoinedAnswers joined(records, wanted);
  for (std::uint32_t i = 0; i < obstacles.size(); ++i) {
    if (obstacles[i].ignores_input) {
      joined.skip();
      continue;
    }
    Question one = questionOf(question, obstacles[i]);
    one.progress = progressOfPart(question.progress, i, obstacles.size());
    Answer answer =
        obstacles.size() == 1 ? ask(one, input, obstacles[i].shape) : askOrSpare(one, input, obstacles[i].shape);
    joined.add(i, answer);
    if (wanted.closest && !answer.closest.pair) {
      const auto [closest, pose] = closestOf(one, input, obstacles[i].shape);
      joined.setClosest(closest, pose);
    }
    if (told) told(i, one, answer);
  }
  joined.fill(path ? path->size() : 1);
  return joined.finish(path.has_value());
}

} // namespace pcl_bsh
