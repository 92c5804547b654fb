// SPDX-License-Identifier: BSD-3-Clause
// The states of a robot as a space of OMPL.
//
//   ompl::geometric::SimpleSetup setup(std::make_shared<pcl_bsh::ompl::JointSpace>(arm));
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/robot/robot.h>

#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace pcl_bsh::ompl {

/// A dimension for each value of a robot's state, between the limits of its joint. Continuous joints go the shorter
/// way, as motions of robots::RobotWorld do, and their values are within half a turn of 0.
class JointSpace : public ::ompl::base::RealVectorStateSpace {
public:
  /// @throws InvalidInput (Input::motion) naming the joint whose limits are not finite, or leave it no way
  explicit JointSpace(const robots::Robot& robot)
  {
    for (const std::size_t link : robots::variablesOf(robot)) {
      const robots::Joint& joint = *robot.links[link].joint;
      continuous_.push_back(joint.kind == robots::Joint::Kind::continuous);
      const double lower = continuous_.back() ? -kHalfTurn : joint.lower;
      const double upper = continuous_.back() ? kHalfTurn : joint.upper;
      if (!std::isfinite(lower) || !std::isfinite(upper) || !(lower < upper))
        throw InvalidInput(Input::motion, "joint '" + joint.name + "'", "has no finite limits with a way between them",
                           "give it a lower limit and a greater upper one, or make it fixed");
      addDimension(joint.name, lower, upper);
    }
  }

  /// Rad and m are counted alike.
  double distance(const ::ompl::base::State* a, const ::ompl::base::State* b) const override
  {
    double squares = 0.0;
    for (unsigned i = 0; i < dimension_; ++i) {
      const double way = wayOf(i, valueOf(a, i), valueOf(b, i));
      squares += way * way;
    }
    return std::sqrt(squares);
  }

  void interpolate(const ::ompl::base::State* from, const ::ompl::base::State* to, double t,
                   ::ompl::base::State* state) const override
  {
    for (unsigned i = 0; i < dimension_; ++i) {
      const double begin = valueOf(from, i);
      state->as<StateType>()->values[i] = wrapped(i, begin + t * wayOf(i, begin, valueOf(to, i)));
    }
  }

  void enforceBounds(::ompl::base::State* state) const override
  {
    for (unsigned i = 0; i < dimension_; ++i) state->as<StateType>()->values[i] = wrapped(i, valueOf(state, i));
    RealVectorStateSpace::enforceBounds(state);
  }

private:
  static constexpr double kHalfTurn = 3.14159265358979323846; // C++17 has no name for it

  static double valueOf(const ::ompl::base::State* state, unsigned i) { return state->as<StateType>()->values[i]; }
  double wrapped(unsigned i, double value) const
  {
    return continuous_[i] ? std::remainder(value, 2.0 * kHalfTurn) : value;
  }
  double wayOf(unsigned i, double from, double to) const { return wrapped(i, to - from); }

  std::vector<bool> continuous_;
};

} // namespace pcl_bsh::ompl
