// SPDX-License-Identifier: BSD-3-Clause
// Validators for planners of OMPL: states and motions of a robot among clouds, certified.
//
//   information->setStateValidityChecker(std::make_shared<pcl_bsh::ompl::StateValidity>(information, world));
//   information->setMotionValidator(std::make_shared<pcl_bsh::ompl::MotionValidity>(information, world));
//
// The space is a JointSpace, or, for robots without continuous joints, another RealVectorStateSpace with a dimension
// for each value of a state. States out of the joints' limits are not valid, nor is any state or motion that is
// undecided. Both may run in several threads at once, while nobody changes the world.
//
// Simplifiers of OMPL cut motions that were certified, at states that are rounded, and do not ask about the parts
// again. PathGeometric::check() certifies a path as a whole.
#pragma once

#include <pcl_bsh/robot/robot_world.h>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <cstddef>
#include <memory>
#include <utility>

namespace pcl_bsh::ompl {

/// The world that planners share.
using World = std::shared_ptr<const robots::RobotWorld>;

/// The values of a state of a RealVectorStateSpace.
inline robots::RobotState valuesOf(const ::ompl::base::State* state, std::size_t count)
{
  const double* const values = state->as<::ompl::base::RealVectorStateSpace::StateType>()->values;
  return {values, values + count};
}

/// Tells whether a state is within the limits of its joints and certainly free.
class StateValidity : public ::ompl::base::StateValidityChecker {
public:
  /// @param information of a space whose dimensions are the world's joints
  StateValidity(const ::ompl::base::SpaceInformationPtr& information, World world)
  : StateValidityChecker(information),
    world_(std::move(world))
  {
    specs_.clearanceComputationType = ::ompl::base::StateValidityCheckerSpecs::EXACT;
  }

  /// May be called by several threads at once.
  bool isValid(const ::ompl::base::State* state) const override
  {
    if (!si_->satisfiesBounds(state)) return false;
    return world_->checkState(valuesOf(state, si_->getStateDimension())).verdict == Verdict::free;
  }

  /// Returns a lower bound of the distance from obstacles and from itself, less the clearance: 0 or less where it
  /// collides.
  double clearance(const ::ompl::base::State* state) const override
  {
    return world_->clearance(valuesOf(state, si_->getStateDimension())).gap.lower - world_->options().clearance;
  }

private:
  World world_;
};

/// Tells whether a motion is certainly free at each instant.
class MotionValidity : public ::ompl::base::MotionValidator {
public:
  /// @param information of a space whose dimensions are the world's joints
  MotionValidity(const ::ompl::base::SpaceInformationPtr& information, World world)
  : MotionValidator(information),
    world_(std::move(world))
  {
  }

  /// May be called by several threads at once.
  bool checkMotion(const ::ompl::base::State* from, const ::ompl::base::State* to) const override
  {
    return counted(check(from, to, false).verdict == Verdict::free);
  }

  /// @param last the last state that is certainly free, and its fraction of the motion
  bool checkMotion(const ::ompl::base::State* from, const ::ompl::base::State* to,
                   std::pair<::ompl::base::State*, double>& last) const override
  {
    const robots::MotionCheck found = check(from, to, true);
    if (counted(found.verdict == Verdict::free)) return true;
    last.second = found.last_valid;
    if (last.first) si_->getStateSpace()->interpolate(from, to, found.last_valid, last.first);
    return false;
  }

private:
  robots::MotionCheck check(const ::ompl::base::State* from, const ::ompl::base::State* to, bool with_last) const
  {
    if (!si_->satisfiesBounds(from)) return {Verdict::colliding, 0.0, {}, 0.0};
    if (!si_->satisfiesBounds(to)) return {Verdict::colliding, 1.0, {}, 0.0};
    const std::size_t count = si_->getStateDimension();
    return world_->checkMotion(valuesOf(from, count), valuesOf(to, count), with_last);
  }

  bool counted(bool valid) const
  {
    ++(valid ? valid_ : invalid_);
    return valid;
  }

  World world_;
};

} // namespace pcl_bsh::ompl
