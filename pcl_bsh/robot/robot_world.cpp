// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/robot/motion_search.h>
#include <pcl_bsh/robot/robot_world.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace pcl_bsh::robots {

namespace {

std::vector<Obstacle> obstaclesOf(const std::vector<const SphereHierarchy*>& hierarchies)
{
  std::vector<Obstacle> obstacles;
  for (const SphereHierarchy* hierarchy : hierarchies) obstacles.emplace_back(*hierarchy);
  return obstacles;
}

/// Returns answer(i) for all i below `count`. A thread takes some at a time.
template <class Answer>
auto answerAll(std::size_t count, const Effort& effort, const Answer& answer)
{
  constexpr std::size_t some = 16;
  const std::size_t parts = (count + some - 1) / some;
  std::vector<decltype(answer(0))> answers(count);
  Progress progress(effort.progress);
  progress.begin(1.0, parts);
  parallelFor(parts, threadCount(effort.threads), [&](std::size_t part) {
    if (progress.stopped()) return;
    for (std::size_t i = part * some; i < std::min(count, (part + 1) * some); ++i) answers[i] = answer(i);
    progress.step();
  });
  progress.throwIfStopped();
  progress.end();
  return answers;
}

void requireStates(const Gaps& gaps, const std::vector<RobotState>& states, const Effort& effort)
{
  checkExact(effort);
  for (std::size_t i = 0; i < states.size(); ++i) gaps.requireState(states[i], "state", i);
}

void requireLimit(double limit)
{
  if (std::isnan(limit))
    throw InvalidInput(Input::max_distance, "limit", "is not a number", "give a length, or infinity");
}

/// Finds the least gap of a state: of balls against obstacles, and of pairs of links.
class LeastGap {
public:
  LeastGap(const Gaps& gaps, const RobotState& state, double limit) : gaps_(gaps), limit_(limit)
  {
    best_.gap = {limit, limit};
    gaps.kinematics.poses(state, gaps.base, gaps.kinematics.bodies().size(), poses_);
    for (const std::uint32_t ball : gaps.parts.of_bodies)
      if (ball != kNoPart) ofBall(gaps.parts.balls[ball]);
    if (gaps.options.with_self)
      for (const LinkPair& pair : gaps.parts.pairs)
        ofPair(gaps.parts.balls[pair.a], gaps.parts.balls[pair.b], pair.common);
  }

  ClearanceResult result(double error) const
  {
    ClearanceResult result = best_;
    result.gap.lower -= error;
    result.gap.upper = best_.meeting ? best_.gap.upper + error : std::numeric_limits<double>::infinity();
    return result;
  }

private:
  void take(const Interval& gap, const Meeting& meeting)
  {
    if (!(gap.lower <= best_.gap.upper)) return;
    best_.gap.lower = std::min(best_.gap.lower, gap.lower);
    if (!(gap.upper <= limit_) || (best_.meeting && gap.upper >= best_.gap.upper)) return;
    best_.gap.upper = gap.upper;
    best_.meeting = meeting;
  }

  void ofBall(const Ball& ball)
  {
    const double reach = best_.gap.upper + ball.radius + gaps_.doubt(ball, 0);
    if (gaps_.areBeyond(gaps_.centerOf(ball, poses_), reach)) return;
    for (std::uint32_t i = 0; i < ball.count; ++i) ofBall(gaps_.parts.balls[ball.first + i]);
    if (ball.count > 0) return;
    const ObstacleGap gap = gaps_.toObstacles(ball, poses_, best_.gap.upper);
    if (gap.record != kNothing) take(gap, gaps_.meetingOf(ball, gap, true));
  }

  void ofPair(const Ball& a, const Ball& b, std::size_t common)
  {
    const double least = (gaps_.centerOf(a, poses_) - gaps_.centerOf(b, poses_)).norm() - a.radius - b.radius;
    if (least > best_.gap.upper + gaps_.doubt(a, common) + gaps_.doubt(b, common)) return;
    if (a.piece == kNoPart)
      for (std::uint32_t i = 0; i < a.count; ++i) ofPair(gaps_.parts.balls[a.first + i], b, common);
    else if (b.piece == kNoPart)
      for (std::uint32_t i = 0; i < b.count; ++i) ofPair(a, gaps_.parts.balls[b.first + i], common);
    else
      take(gaps_.between(a, b, common, poses_, best_.gap.upper), gaps_.meetingOf(a, b));
  }

  const Gaps& gaps_;
  const double limit_;
  Gaps::Poses poses_;
  ClearanceResult best_;
};

StateCheck checkOf(const Gaps& gaps, const RobotState& state)
{
  const ScratchLease<MotionScratch> scratch;
  return MotionSearch(gaps, state, state, *scratch).atStart();
}

MotionCheck checkOf(const Gaps& gaps, const RobotState& from, const RobotState& to, bool with_last_valid)
{
  const ScratchLease<MotionScratch> scratch;
  MotionSearch search(gaps, from, to, *scratch);
  MotionCheck check = search.all();
  if (with_last_valid && check.verdict != Verdict::free) check.last_valid = search.lastValid();
  return check;
}

ClearanceResult clearanceOf(const Gaps& gaps, const RobotState& state, double limit)
{
  RobotState largest = state;
  for (double& value : largest) value = std::abs(value);
  return LeastGap(gaps, state, limit).result(gaps.error(largest));
}

} // namespace

class RobotWorld::Inside : public Gaps {
public:
  using Gaps::Gaps;
};

RobotWorld::RobotWorld(const Robot& robot, const std::vector<const SphereHierarchy*>& obstacles,
                       const WorldOptions& options)
: inside_(std::make_unique<Inside>(robot, obstaclesOf(obstacles), options))
{
}

RobotWorld::~RobotWorld() = default;
RobotWorld::RobotWorld(RobotWorld&&) noexcept = default;
RobotWorld& RobotWorld::operator=(RobotWorld&&) noexcept = default;

const Robot& RobotWorld::robot() const noexcept
{
  return inside_->robot;
}

const Kinematics& RobotWorld::kinematics() const noexcept
{
  return inside_->kinematics;
}

const WorldOptions& RobotWorld::options() const noexcept
{
  return inside_->options;
}

void RobotWorld::setObstacles(const std::vector<const SphereHierarchy*>& obstacles)
{
  inside_->setObstacles(obstaclesOf(obstacles));
}

void RobotWorld::setObstacles(const std::vector<const SphereHierarchy*>& obstacles,
                              const std::vector<Eigen::Isometry3d>& T_world_obstacle)
{
  inside_->setObstacles(obstaclesOf(obstacles), T_world_obstacle);
}

void RobotWorld::setObstaclePoses(const std::vector<Eigen::Isometry3d>& T_world_obstacle)
{
  inside_->setObstacles(inside_->obstacles(), T_world_obstacle);
}

void RobotWorld::setBase(const Eigen::Isometry3d& T_world_root)
{
  WorldOptions options = this->options();
  options.base = T_world_root;
  inside_ = std::make_unique<Inside>(robot(), inside_->obstacles(), options);
}

void RobotWorld::attach(const std::string& name, std::size_t link, std::vector<Shape> shapes,
                        const std::vector<std::size_t>& ignored)
{
  Robot robot = this->robot();
  const bool is_new =
      std::none_of(robot.links.begin(), robot.links.end(), [&](const Link& l) { return l.name == name; });
  if (!is_new || link >= robot.links.size())
    throw InvalidInput(Input::scene, "attached '" + name + "'",
                       is_new ? "hangs on a link that " + robot.name + " has not" : "has the name of a link",
                       is_new ? "name a link by its number" : "give another name");
  Joint joint;
  joint.name = name;
  joint.parent = link;
  for (const std::size_t other : ignored) robot.disabled_pairs.push_back({robot.links.size(), other});
  robot.links.push_back({name, std::move(shapes), joint});
  inside_ = std::make_unique<Inside>(robot, inside_->obstacles(), options());
}

void RobotWorld::detach(const std::string& name)
{
  Robot robot = this->robot();
  const std::size_t link = robot.linkNamed(name);
  const auto hangs = [&](const Link& other) { return other.joint && other.joint->parent == link; };
  const std::optional<Joint>& joint = robot.links[link].joint;
  if (!joint || joint->name != name || std::any_of(robot.links.begin(), robot.links.end(), hangs))
    throw InvalidInput(Input::scene, "link '" + name + "'", "is not attached, or carries another",
                       "name what attach() added last");
  robot.links.erase(robot.links.begin() + static_cast<std::ptrdiff_t>(link));
  for (Link& other : robot.links)
    if (other.joint && other.joint->parent > link) --other.joint->parent;
  std::erase_if(robot.disabled_pairs, [&](const auto& pair) { return pair[0] == link || pair[1] == link; });
  for (auto& pair : robot.disabled_pairs)
    for (std::size_t& of : pair) of -= of > link ? 1 : 0;
  inside_ = std::make_unique<Inside>(robot, inside_->obstacles(), options());
}

StateCheck RobotWorld::checkState(const RobotState& state) const
{
  const DefaultFloatEnvironment environment;
  inside_->requireState(state);
  return checkOf(*inside_, state);
}

MotionCheck RobotWorld::checkMotion(const RobotState& from, const RobotState& to, bool with_last_valid) const
{
  const DefaultFloatEnvironment environment;
  inside_->requireState(from);
  inside_->requireState(to);
  return checkOf(*inside_, from, to, with_last_valid);
}

ClearanceResult RobotWorld::clearance(const RobotState& state, double limit) const
{
  const DefaultFloatEnvironment environment;
  inside_->requireState(state);
  requireLimit(limit);
  return clearanceOf(*inside_, state, limit);
}

std::vector<SweptBall> RobotWorld::sweptBalls(const RobotState& from, const RobotState& to, std::size_t parts) const
{
  const DefaultFloatEnvironment environment;
  inside_->requireState(from);
  inside_->requireState(to);
  const ScratchLease<MotionScratch> scratch;
  MotionSearch search(*inside_, from, to, *scratch);
  std::vector<SweptBall> balls;
  const double h = 0.5 / static_cast<double>(parts);
  for (std::size_t i = 0; i < parts; ++i) search.addSwept((2.0 * static_cast<double>(i) + 1.0) * h, h, balls);
  return balls;
}

std::vector<StateCheck> RobotWorld::checkStates(const std::vector<RobotState>& states, const Effort& effort) const
{
  const DefaultFloatEnvironment environment;
  requireStates(*inside_, states, effort);
  return answerAll(states.size(), effort, [&](std::size_t i) { return checkOf(*inside_, states[i]); });
}

std::vector<MotionCheck> RobotWorld::checkMotions(const std::vector<Motion>& motions, bool with_last_valid,
                                                  const Effort& effort) const
{
  const DefaultFloatEnvironment environment;
  checkExact(effort);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    inside_->requireState(motions[i].from, "motion", i);
    inside_->requireState(motions[i].to, "motion", i);
  }
  return answerAll(motions.size(), effort,
                   [&](std::size_t i) { return checkOf(*inside_, motions[i].from, motions[i].to, with_last_valid); });
}

std::vector<ClearanceResult> RobotWorld::clearances(const std::vector<RobotState>& states, double limit,
                                                    const Effort& effort) const
{
  const DefaultFloatEnvironment environment;
  requireStates(*inside_, states, effort);
  requireLimit(limit);
  return answerAll(states.size(), effort, [&](std::size_t i) { return clearanceOf(*inside_, states[i], limit); });
}

} // namespace pcl_bsh::robots
