// SPDX-License-Identifier: BSD-3-Clause
// A robot at an instant and about it: what is certainly free for some time, what collides, what has to be looked at
// again.
//
// A ball is free for a time h if its gap is above the sum of the clearance, its way in that time (kinematics.h) and the
// error of doubles. Others are split into the balls that they hold; then the time is halved.
#pragma once

#include <pcl_bsh/base/pulse.h>
#include <pcl_bsh/robot/gaps.h>
#include <pcl_bsh/robot/robot_world.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh::robots {

/// To be had by a ScratchLease.
struct MotionScratch {
  /// Balls and pairs [begin, end) of the lists, at the instant m and for the time h before and after it.
  struct Task {
    double m, h;
    std::size_t ball_begin, ball_end, pair_begin, pair_end, bodies;
  };

  /// The bound A of a ball's acceleration (kinematics.h), seen from a body: computed once a motion.
  struct Bend {
    std::uint64_t motion = 0;
    double bend = 0.0;
  };

  RobotState from, slopes, largest, values;
  Gaps::Poses poses;
  std::vector<Kinematics::Twist> twists;
  std::vector<double> turning, bend; ///< of bodies: sums and terms of A (kinematics.h)
  std::vector<std::uint32_t> balls, open_balls;
  std::vector<LinkPair> pairs, open_pairs;
  std::vector<Task> tasks;
  std::vector<Bend> bends;  ///< of each ball, from each body
  std::uint64_t motion = 0; ///< number of the current motion

  std::size_t bytes() const noexcept
  {
    return sizeof(Kinematics::Pose) * (poses.capacity() + twists.capacity()) + 4 * balls.capacity() +
           sizeof(LinkPair) * pairs.capacity() + sizeof(Task) * tasks.capacity() + sizeof(Bend) * bends.capacity();
  }
};

class MotionSearch {
public:
  /// @pre states that Gaps::requireState() lets pass
  MotionSearch(const Gaps& gaps, const RobotState& from, const RobotState& to, MotionScratch& scratch);

  /// Checks the start alone.
  StateCheck atStart();

  /// Checks the whole motion, breadth first: collisions are found soon.
  MotionCheck all();

  /// Returns up to which fraction the motion is certainly free.
  double lastValid();

  /// Adds the balls that hold each piece at all instants [m - h, m + h].
  void addSwept(double m, double h, std::vector<SweptBall>& swept);

private:
  using Task = MotionScratch::Task;
  /// open: to be asked again for shorter times; parted: to be asked again of the balls that a ball holds.
  enum class Outcome : std::uint8_t { free, parted, open, colliding, undecided };

  Task roots(double m, double h);
  Outcome assess(const Task& task, Task& open);
  void place(const Task& task);
  Outcome ofBall(std::uint32_t index, double h);
  Outcome ofPair(const LinkPair& pair, double h);
  Outcome outcomeOf(const Interval& gap, double clearance, double moved) const;
  template <class GapOf>
  Outcome outcomeBy(const GapOf& gapOf, double clearance, double moved) const;
  bool isFreeUntilEnd(const Task& task);

  double bendOf(std::uint32_t index, std::size_t rest);
  double way(std::uint32_t index, const Eigen::Vector3d& center, std::size_t rest, double h);

  const Gaps& gaps_;
  MotionScratch& s_;
  double error_ = 0.0, speed_ = 0.0; ///< error of gaps; speed of the fastest place, at most
  double valid_ = 0.0;
  Meeting meeting_; ///< of the last outcome that is colliding or undecided
  Pulse pulse_;
};

} // namespace pcl_bsh::robots
