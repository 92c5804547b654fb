// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/robot/motion_search.h>
#include <pcl_bsh/robot/outward.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pcl_bsh::robots {

namespace {

constexpr double kOfTwists = 1e-12; ///< their error, as a share of the greatest speed

/// A ball that goes farther than this many radii waits for shorter times before it is split.
constexpr double kLong = 0.5;

} // namespace

MotionSearch::MotionSearch(const Gaps& gaps, const RobotState& from, const RobotState& to, MotionScratch& scratch)
: gaps_(gaps),
  s_(scratch)
{
  const std::vector<Kinematics::Body>& bodies = gaps.kinematics.bodies();
  s_.from = s_.values = from;
  s_.slopes.resize(from.size());
  s_.largest.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    s_.slopes[i] = gaps.robot.links[gaps.kinematics.linkOfVariable(i)].joint->way(from[i], to[i]);
    s_.largest[i] = std::max(std::abs(from[i]), std::abs(to[i]));
  }
  ++s_.motion;
  s_.bends.resize(std::max(s_.bends.size(), gaps.parts.balls.size() * bodies.size()));
  s_.turning.assign(bodies.size(), 0.0);
  s_.bend.assign(bodies.size(), 0.0);
  double reach = 1.0;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const Kinematics::Body& body = bodies[i];
    const double slope = std::abs(body.multiplier * s_.slopes[body.variable]);
    const double turn = body.kind == Joint::Kind::prismatic ? 0.0 : slope;
    s_.turning[i] = s_.turning[body.parent] + turn;
    s_.bend[i] = slope * (turn + 2.0 * s_.turning[body.parent]);
    reach = std::max(reach, body.reach);
    speed_ += slope;
  }
  speed_ *= kOutward * 2.0 * (reach + gaps.parts.extent);
  error_ = gaps.error(s_.largest) + kOfTwists * speed_;
}

MotionSearch::Task MotionSearch::roots(double m, double h)
{
  s_.balls.clear();
  s_.pairs.clear();
  const std::vector<std::uint32_t>& of_bodies = gaps_.parts.of_bodies;
  for (std::size_t i = of_bodies.size(); i-- > 0;)
    if (of_bodies[i] != kNoPart) s_.balls.push_back(of_bodies[i]);
  if (gaps_.options.with_self) s_.pairs = gaps_.parts.pairs;
  return {m, h, 0, s_.balls.size(), 0, s_.pairs.size(), of_bodies.size()};
}

void MotionSearch::place(const Task& task)
{
  if (task.m > 0.0)
    for (std::size_t i = 0; i < s_.values.size(); ++i) s_.values[i] = s_.from[i] + task.m * s_.slopes[i];
  gaps_.kinematics.poses(s_.values, gaps_.base, task.bodies, s_.poses);
  if (task.h > 0.0) gaps_.kinematics.twists(s_.slopes, s_.poses, task.bodies, s_.twists);
}

double MotionSearch::bendOf(std::uint32_t index, std::size_t rest)
{
  MotionScratch::Bend& known = s_.bends[index * gaps_.kinematics.bodies().size() + rest];
  if (known.motion == s_.motion) return known.bend;
  const Ball& ball = gaps_.parts.balls[index];
  const std::vector<std::size_t>& chain = gaps_.parts.chains[ball.body];
  double bend = 0.0;
  for (std::size_t i = chain.size(); i-- > 0 && chain[i] != rest;) {
    double term = s_.bend[chain[i]];
    if (rest != 0) {
      const Kinematics::Body& body = gaps_.kinematics.bodies()[chain[i]];
      term -= 2.0 * s_.turning[rest] * std::abs(body.multiplier * s_.slopes[body.variable]);
    }
    bend += ball.axis_distances[i] * term;
  }
  known = {s_.motion, bend};
  return bend;
}

/// Returns how far any place of a ball that counts (Ball::spread) goes in the time h at most, seen from the body
/// `rest`.
double MotionSearch::way(std::uint32_t index, const Eigen::Vector3d& center, std::size_t rest, double h)
{
  const Ball& ball = gaps_.parts.balls[index];
  if (h == 0.0 || ball.body == rest) return 0.0;
  Kinematics::Twist twist = s_.twists[ball.body];
  if (rest != 0) {
    twist.turn -= s_.twists[rest].turn;
    twist.shift -= s_.twists[rest].shift;
  }
  double speed = twist.at(center).norm();
  if (ball.spread > 0.0) speed += ball.spread * twist.turn.norm();
  return kOutward * h * (speed + 0.5 * h * bendOf(index, rest));
}

/// @param gap at the instant. @param moved how much it can change in the time about it
MotionSearch::Outcome MotionSearch::outcomeOf(const Interval& gap, double clearance, double moved) const
{
  if (gap.lower > clearance + moved + error_) return Outcome::free;
  if (gap.upper + error_ <= clearance) return Outcome::colliding;
  // Not certainly free now, nor certainly colliding anywhere in the time: shorter times would not tell more.
  const bool stays = gap.lower <= clearance + error_ && gap.upper - moved + error_ > clearance;
  return moved > gaps_.options.tolerance && !stays ? Outcome::open : Outcome::undecided;
}

/// @param gapOf(any) returns the least gap, or any within the limit; its upper end is infinite where nothing is near
template <class GapOf>
MotionSearch::Outcome MotionSearch::outcomeBy(const GapOf& gapOf, double clearance, double moved) const
{
  Outcome outcome = Outcome::undecided;
  for (const bool any : {true, false}) {
    const Interval gap = gapOf(any);
    if (gap.upper == kInfinity) return Outcome::free;
    outcome = outcomeOf(gap, clearance, moved);
    if (outcome == Outcome::open || outcome == Outcome::colliding) break; // others need the least gap
  }
  return outcome;
}

MotionSearch::Outcome MotionSearch::ofBall(std::uint32_t index, double h)
{
  const Ball& ball = gaps_.parts.balls[index];
  const double clearance = gaps_.options.clearance, doubt = gaps_.doubt(ball, 0);
  const Eigen::Vector3d center = gaps_.centerOf(ball, s_.poses);
  const double moved = way(index, center, 0, h), still = ball.radius + clearance + doubt, needed = moved + error_;
  if (gaps_.areBeyond(center, still + needed)) return Outcome::free;
  // Free now, but not certainly for so long: a closer look would not tell more.
  const bool parts = ball.count > 0;
  if (moved > (parts ? kLong * ball.radius : gaps_.options.tolerance) && gaps_.areBeyond(center, still + error_))
    return Outcome::open;
  ObstacleGap gap;
  if (parts && ball.piece != kNoPart && h > 0.0) {
    // A mesh that collides now settles the motion, before the times of its patches are halved.
    gap = gaps_.anyOfMesh(ball, s_.poses, clearance);
    if (gap.record != kNothing && gap.upper + error_ <= clearance) {
      meeting_ = gaps_.meetingOf(ball, gap, true);
      return Outcome::colliding;
    }
  }
  if (parts) return Outcome::parted;
  const Outcome outcome =
      outcomeBy([&](bool any) -> Interval { return gap = gaps_.toObstacles(ball, s_.poses, clearance + needed, any); },
                clearance, moved);
  if (outcome >= Outcome::colliding) meeting_ = gaps_.meetingOf(ball, gap, outcome == Outcome::colliding);
  return outcome;
}

MotionSearch::Outcome MotionSearch::ofPair(const LinkPair& pair, double h)
{
  const Ball &a = gaps_.parts.balls[pair.a], &b = gaps_.parts.balls[pair.b];
  const double clearance = gaps_.options.self_clearance;
  const Eigen::Vector3d center_a = gaps_.centerOf(a, s_.poses), center_b = gaps_.centerOf(b, s_.poses);
  const double moved = way(pair.a, center_a, pair.common, h) + way(pair.b, center_b, pair.common, h);
  const double least = (center_a - center_b).norm() - a.radius - b.radius, needed = clearance + moved + error_;
  const double doubt = gaps_.doubt(a, pair.common) + gaps_.doubt(b, pair.common);
  if (least > needed + doubt) return Outcome::free;
  if (a.piece == kNoPart || b.piece == kNoPart)
    return moved > kLong * (a.radius + b.radius) && least > clearance + doubt + error_ ? Outcome::open
                                                                                       : Outcome::parted;
  const bool is_long = moved > gaps_.options.tolerance;
  const double apart = gaps_.hullsApart(a, b, pair.common, s_.poses, is_long ? clearance + error_ : needed, needed);
  if (apart > needed) return Outcome::free;
  if (is_long && apart > clearance + error_) return Outcome::open;
  const Outcome outcome =
      outcomeBy([&](bool any) { return gaps_.between(a, b, pair.common, s_.poses, needed, any); }, clearance, moved);
  if (outcome >= Outcome::colliding) meeting_ = gaps_.meetingOf(a, b);
  return outcome;
}

/// @param open what is to be looked at again, appended to the lists
MotionSearch::Outcome MotionSearch::assess(const Task& task, Task& open)
{
  place(task);
  pulse_.count(16 + task.ball_end - task.ball_begin + task.pair_end - task.pair_begin);
  const Parts& parts = gaps_.parts;
  open = {task.m, task.h, s_.balls.size(), 0, s_.pairs.size(), 0, 1};
  Outcome worst = Outcome::free;
  s_.open_balls.assign(s_.balls.begin() + static_cast<std::ptrdiff_t>(task.ball_begin),
                       s_.balls.begin() + static_cast<std::ptrdiff_t>(task.ball_end));
  const auto take = [&](Outcome outcome) {
    if (outcome != Outcome::free) worst = std::max(worst, outcome);
    return outcome == Outcome::colliding;
  };
  for (std::size_t i = 0; i < s_.open_balls.size(); ++i) {
    const std::uint32_t index = s_.open_balls[i];
    const Ball& ball = parts.balls[index];
    const Outcome outcome = ofBall(index, task.h);
    if (outcome == Outcome::parted) {
      for (std::uint32_t k = 0; k < ball.count; ++k) s_.open_balls.push_back(ball.first + k);
      continue;
    }
    if (take(outcome)) return outcome;
    if (outcome != Outcome::open) continue;
    s_.balls.push_back(index);
    open.bodies = std::max(open.bodies, ball.body + 1);
  }
  s_.open_pairs.assign(s_.pairs.begin() + static_cast<std::ptrdiff_t>(task.pair_begin),
                       s_.pairs.begin() + static_cast<std::ptrdiff_t>(task.pair_end));
  for (std::size_t i = 0; i < s_.open_pairs.size(); ++i) {
    const LinkPair pair = s_.open_pairs[i];
    const Outcome outcome = ofPair(pair, task.h);
    const Ball &a = parts.balls[pair.a], &b = parts.balls[pair.b];
    if (outcome == Outcome::parted) {
      const bool first = b.piece != kNoPart || (a.piece == kNoPart && a.radius >= b.radius);
      const Ball& split = first ? a : b;
      for (std::uint32_t k = split.first; k < split.first + split.count; ++k)
        s_.open_pairs.push_back({first ? k : pair.a, first ? pair.b : k, pair.common});
      continue;
    }
    if (take(outcome)) return outcome;
    if (outcome != Outcome::open) continue;
    s_.pairs.push_back(pair);
    open.bodies = std::max({open.bodies, a.body + 1, b.body + 1});
  }
  open.ball_end = s_.balls.size();
  open.pair_end = s_.pairs.size();
  return worst;
}

StateCheck MotionSearch::atStart()
{
  Task open;
  const Outcome outcome = assess(roots(0.0, 0.0), open);
  if (outcome == Outcome::free) return {};
  return {outcome == Outcome::colliding ? Verdict::colliding : Verdict::undecided, meeting_};
}

MotionCheck MotionSearch::all()
{
  MotionCheck check;
  s_.tasks.assign(1, roots(0.5, 0.5));
  for (std::size_t i = 0; i < s_.tasks.size(); ++i) {
    const Task task = s_.tasks[i];
    Task open;
    const Outcome outcome = assess(task, open);
    if (outcome == Outcome::colliding) return {Verdict::colliding, task.m, meeting_, 0.0};
    if (outcome == Outcome::undecided && check.verdict == Verdict::free)
      check = {Verdict::undecided, task.m, meeting_, 0.0};
    if (open.ball_begin == open.ball_end && open.pair_begin == open.pair_end) continue;
    open.h = 0.5 * task.h;
    for (const double m : {task.m - open.h, task.m + open.h}) {
      open.m = m;
      s_.tasks.push_back(open);
    }
  }
  return check;
}

bool MotionSearch::isFreeUntilEnd(const Task& task)
{
  const std::size_t balls = s_.balls.size(), pairs = s_.pairs.size();
  Task next;
  const Outcome outcome = assess(task, next);
  const double half = 0.5 * task.h;
  const auto before = [&](Task of) {
    of.m = task.m - half;
    of.h = half;
    return of;
  };
  bool free = outcome == Outcome::free;
  if (free || (outcome >= Outcome::colliding && speed_ * task.h <= gaps_.options.tolerance))
    valid_ = free ? task.m + task.h : task.m - task.h;
  else if (outcome >= Outcome::colliding) {
    s_.balls.resize(balls);
    s_.pairs.resize(pairs);
    isFreeUntilEnd(before(task));
  }
  else {
    free = isFreeUntilEnd(before(next));
    if (free) {
      next.m = task.m + half;
      next.h = half;
      free = isFreeUntilEnd(next);
    }
  }
  s_.balls.resize(balls);
  s_.pairs.resize(pairs);
  return free;
}

void MotionSearch::addSwept(double m, double h, std::vector<SweptBall>& swept)
{
  place(roots(m, h));
  for (std::size_t i = 0; i < s_.balls.size(); ++i) {
    const Ball& ball = gaps_.parts.balls[s_.balls[i]];
    for (std::uint32_t k = 0; k < ball.count; ++k) s_.balls.push_back(ball.first + k);
    if (ball.count > 0) continue;
    const Eigen::Vector3d center = gaps_.centerOf(ball, s_.poses);
    swept.push_back(
        {center, kOutward * (ball.radius + way(s_.balls[i], center, 0, h) + gaps_.doubt(ball, 0) + error_)});
  }
}

double MotionSearch::lastValid()
{
  valid_ = 0.0;
  isFreeUntilEnd(roots(0.5, 0.5));
  return std::clamp(valid_, 0.0, 1.0);
}

} // namespace pcl_bsh::robots
