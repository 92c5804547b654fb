// SPDX-License-Identifier: BSD-3-Clause
// Responses to collisions: a moving object stops, slides, or follows the ground.
#include <pcl_bsh/scene/responses/mover.h>
#include <pcl_bsh/scene/swept/swept_object.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <numbers>
#include <string>

namespace pcl_bsh {
namespace {

constexpr double kMostTurns = 1000; // of an object within a step, where its motion matters

/// Where an object is to go.
struct Goal {
  Eigen::Isometry3d pose;
  Eigen::Vector3d turn; ///< of the motion there
};

/// Returns the pose of a body that is turned as the goal, while the centre of its box is still where it is.
Eigen::Isometry3d turnedInPlace(const Body& body, const Goal& goal)
{
  Eigen::Isometry3d pose = goal.pose;
  pose.translation() = body.object.pose * body.center() - goal.pose.linear() * body.center();
  return pose;
}

Eigen::Isometry3d shifted(Eigen::Isometry3d pose, const Eigen::Vector3d& shift)
{
  pose.translation() += shift;
  return pose;
}

/// @return whether the goal was reached
bool moveTo(Mover& mover, const Body& body, const Goal& goal, Response response)
{
  const bool turns = goal.turn != Eigen::Vector3d::Zero() || body.object.pose.linear() != goal.pose.linear();
  if (response == Response::stop && turns) return mover.follow(goal.pose, goal.turn);
  bool reached = true;
  if (turns) {
    reached = mover.follow(turnedInPlace(body, goal), goal.turn);
    if (!reached) {
      const Eigen::Vector3d way = goal.pose * body.center() - mover.center();
      mover.translate(shifted(mover.pose(), way), true);
      return false;
    }
  }
  return mover.translate(goal.pose, response == Response::slide);
}

/// The goal of a body's own motion. @param turning whether the turn is needed
Goal goalOf(const Body& body, double before, double after, bool turning)
{
  const Motion& motion = body.object.motion;
  const double begin = before - body.start_time, end = after - body.start_time;
  const Eigen::Isometry3d to = poseAt(motion, body.start, end);
  Goal goal{to, Eigen::Vector3d::Zero()};
  const Eigen::Isometry3d& now = body.object.pose;
  if (!body.follows_motion) { // the same motion from where it stands
    const Eigen::Isometry3d from = poseAt(motion, body.start, begin);
    goal.pose.translation() = now.translation() + (to.translation() - from.translation());
    goal.pose.linear() = from.linear() == to.linear()
                             ? Eigen::Matrix3d(now.linear())
                             : Eigen::Quaterniond(to.linear() * from.linear().transpose() * now.linear())
                                   .normalized()
                                   .toRotationMatrix();
  }
  if (turning) goal.turn = turnNearestTo(turnOf(motion, begin, end), now.linear(), goal.pose.linear());
  return goal;
}

Eigen::Vector3d sumOfTurns(const std::vector<Leg>& legs)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Leg& leg : legs) sum += leg.turn;
  return sum;
}

} // namespace

void Scene::State::respond(ObjectId object, const Eigen::Isometry3d& target, const Eigen::Vector3d& turn)
{
  Body& body = bodies[object];
  const Response response = options.effects.response;
  EffectCost unused; // moving without a response costs next to nothing
  EffectCost& moving =
      response == Response::none ? unused : cost(response == Response::stop ? Effect::stop : Effect::slide);
  const Eigen::Isometry3d start = body.object.pose;
  const Goal goal{target, turn};

  const bool was_moved = body.isMoved();
  Mover mover(*this, object, moving);
  const Eigen::Vector3d from = mover.center();
  mover.outcome.wanted = (target * body.center() - from).norm();
  bool reached = true;
  if (response == Response::none) {
    setPose(object, target);
    mover.legs.push_back({start, target, body.center(), turn});
  }
  else {
    const Timed timed(moving.seconds);
    reached = moveTo(mover, body, goal, response);
  }

  if (options.effects.gravity && !mover.outcome.stuck) {
    EffectCost& spent = cost(Effect::gravity);
    const Timed timed(spent.seconds);
    const double height = options.effects.gravity->step_height;
    const Eigen::Vector3d down = options.effects.gravity->down.normalized();
    const Eigen::Vector3d wanted = target.translation() - start.translation();
    const auto advance = [&](const Eigen::Vector3d& center) { return (center - from).dot(wanted); };
    const auto drop = [&](Mover& falling, double depth) {
      return !falling.translate(shifted(falling.pose(), depth * down), false) && !falling.outcome.stuck;
    };
    Outcome& outcome = mover.outcome;
    bool lifted_is_better = false;
    if (!reached) {
      // Blocked at this height: it may be a step.
      const Eigen::Isometry3d plain = body.object.pose;
      const Eigen::Vector3d plain_center = mover.center();
      setPose(object, start);
      Mover climber(*this, object, spent);
      climber.translate(shifted(start, -height * down), false);
      const double lifted = (climber.center() - from).norm();
      climber.outcome = Outcome();
      moveTo(climber, body, {shifted(target, -lifted * down), turn}, response);
      const Outcome climbing = climber.outcome;
      const bool grounded = drop(climber, lifted + height);
      lifted_is_better =
          grounded && advance(climber.center()) > advance(plain_center) + options.tolerance * wanted.norm();
      if (lifted_is_better) {
        outcome.touched = climbing.touched;
        outcome.against = climbing.touched ? climbing.against : climber.outcome.against;
        outcome.grounded = true;
        mover.legs = std::move(climber.legs);
      }
      else {
        setPose(object, plain);
      }
    }
    if (!lifted_is_better) {
      Mover faller(*this, object, spent);
      if (response == Response::none) { // it may have walked into a slope
        const Eigen::Isometry3d level = body.object.pose, raised = shifted(level, -height * down);
        setPose(object, raised);
        outcome.grounded = drop(faller, 2 * height);
        outcome.stuck = faller.outcome.stuck;
        if (outcome.stuck) {
          setPose(object, level);
        }
        else {
          mover.legs.push_back({level, raised, body.center(), Eigen::Vector3d::Zero()});
        }
      }
      else {
        outcome.grounded = drop(faller, height);
      }
      mover.legs.insert(mover.legs.end(), faller.legs.begin(), faller.legs.end());
    }
  }
  mover.outcome.object = object;
  mover.outcome.travelled = (mover.center() - from).norm();
  body.turned += sumOfTurns(mover.legs);
  body.detoured = mover.legs.size() > (was_moved ? 0 : 1);
  mover.outcome.legs = std::move(mover.legs);
  result.outcomes.push_back(std::move(mover.outcome));
  place(object);
}

/// Refuses a motion for which the bounds do not hold. @param rounding that positions may have
void Scene::State::checkMotion(const Body& body, const ObjectMotion& motion, double rounding) const
{
  const auto refuse = [&body](const std::string& what) {
    throw InvalidInput(Input::scene, "Scene", "object '" + body.object.name + "' " + what);
  };
  const double turns = motion.angle() / (2.0 * std::numbers::pi);
  if (!(turns <= kMostTurns))
    refuse(plainText("turns ", turns, " times within a step: make steps so short that it turns at most ", kMostTurns,
                     " times"));
  const double found = motion.rounding();
  if (found <= rounding) return;
  refuse(plainText("goes where coordinates round by up to ", found, ": give a tolerance of at least ",
                   options.tolerance * found / rounding, " instead of ", options.tolerance,
                   ", or move the scene nearer to its origin"));
}

/// Checks all objects that are about to move, before any has. A response may lead elsewhere, to coordinates that round
/// by twice as much at most: a query allows for that.
void Scene::State::checkMotions(double before, double after) const
{
  const auto check = [this](const Body& body, const Goal& goal) {
    const double rounding = options.tolerance / 32;
    checkWorld(body.object, goal.pose);
    checkMotion(body, ObjectMotion({body.object.pose, goal.pose, body.center(), goal.turn}, body.box), rounding);
    if (usesSweptMotion(options.effects))
      SweptObject(body, goal.pose, body.turned + goal.turn)
          .eachLeg([&](std::optional<std::uint32_t>, const Leg&, const ObjectMotion& motion) {
            checkMotion(body, motion, rounding);
          });
  };
  // Objects at rest were checked when they came there.
  for (const ObjectId object : moved) check(bodies[object], {bodies[object].object.pose, Eigen::Vector3d::Zero()});
  for (const Body& body : bodies)
    if (!std::holds_alternative<NoMotion>(body.object.motion)) check(body, goalOf(body, before, after, true));
}

void Scene::State::move(double dt)
{
  const bool responding = isResponding(options.effects);
  const bool turning = responding || usesSweptMotion(options.effects); // the motion matters, not only its end
  const double before = time, after = time + dt;
  if (turning) checkMotions(before, after);
  if (responding) prepareGrid();
  for (ObjectId i = 0; i < bodies.size(); ++i) {
    Body& body = bodies[i];
    if (std::holds_alternative<NoMotion>(body.object.motion)) continue;
    const Goal goal = goalOf(body, before, after, turning);
    const bool rests = goal.turn == Eigen::Vector3d::Zero() && goal.pose.matrix() == body.object.pose.matrix();
    if (rests && !options.effects.gravity) continue;
    if (responding) {
      respond(i, goal.pose, goal.turn);
      if (body.object.pose.matrix() != goal.pose.matrix()) body.follows_motion = false;
    }
    else {
      body.detoured = body.isMoved();
      body.turned += goal.turn;
      setPose(i, goal.pose);
    }
  }
  time = after;
}

} // namespace pcl_bsh
