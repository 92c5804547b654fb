// SPDX-License-Identifier: BSD-3-Clause
// A robot among obstacles: whether it is free, how far from them it is, and whether a motion is free at each instant.
//
//   RobotWorld world(arm, {&scan}, {0.01});  // 1 cm from all points of a SphereHierarchy
//   world.checkState(state).verdict;         // free: farther than that
//
//   world.checkMotion(from, to).verdict;     // at each instant of the line in joint space
//   world.clearance(state).gap;              // and between which two
//
// Answers hold for exact arithmetic on the given numbers (kinematics.h). A state is undecided where it is within
// rounding of the clearance. A motion is undecided only where its least gap is within the tolerance of the clearance.
// Where places of points (PointsView) or values of joints are uncertain, free and colliding hold for all of these: what
// is neither is undecided, too.
// Boxes, cylinders, capsules and spheres are solid, and meshes are surfaces: two that cross are at 0 from each other,
// which is undecided where the clearance is 0. Obstacles are in one frame, the world's.
// Points may have radii; at clearance 0 without radii, a finger passes between points.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/robot/kinematics.h>
#include <pcl_bsh/robot/robot.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::robots {
/// Lengths that a world is asked with.
struct WorldOptions {
  double clearance = 0.0;      ///< from obstacles, m, finite and >= 0: what is no farther collides
  double self_clearance = 0.0; ///< of links from each other, m, finite and >= 0
  double tolerance = 1e-4;     ///< m, > 0: see above
  bool with_self = true;       ///< whether links are held against each other
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity(); ///< T_world_root
  /// How far each value of a state may be from the joint's true one, rad or m, finite and >= 0; empty: not at all.
  std::vector<double> joint_uncertainties = {};
};

/// Two things that are nearest to each other, or collide.
struct Meeting {
  std::size_t link = 0, shape = 0;            ///< of the robot
  std::optional<std::size_t> other_link = {}; ///< where the robot meets itself
  std::size_t other_shape = 0, obstacle = 0;  ///< else one of the obstacles, and
  std::uint32_t record = kNothing;            ///< the record of its view
};
/// The verdict of a state.
struct StateCheck {
  Verdict verdict = Verdict::free;
  std::optional<Meeting> meeting; ///< what collides, or is undecided
};
/// The verdict of a motion.
struct MotionCheck {
  Verdict verdict = Verdict::free;
  double fraction = 1.0;          ///< where it collides, or is undecided; 1 where it is free
  std::optional<Meeting> meeting; ///< what collides there, or is undecided
  double last_valid = 1.0; ///< the motion is certainly free up to here; 0 unless that was asked for, or it is free
};
/// How far a state is from all that it may meet.
struct ClearanceResult {
  Interval gap;                   ///< the least one, less all radii and paddings; negative inside of solids. Where two
                                  ///< solids meet, its lower end may be minus infinity
  std::optional<Meeting> meeting; ///< none: nothing is for certain within the limit
};

/// Holds a shape of a robot for some time.
struct SweptBall {
  Eigen::Vector3d center; ///< in the world, m
  double radius = 0.0;    ///< with the link's padding, m
};

/// Const methods may run in several threads at once. Robots and options are copied, hierarchies borrowed.
class RobotWorld {
public:
  /// @throws InvalidInput as Kinematics does; for options without meaning; for a mesh that was not read
  RobotWorld(const Robot& robot, const std::vector<const SphereHierarchy*>& obstacles,
             const WorldOptions& options = {});
  ~RobotWorld();
  RobotWorld(RobotWorld&&) noexcept;
  RobotWorld& operator=(RobotWorld&&) noexcept;

  const Robot& robot() const noexcept;           ///< with what is attached
  const Kinematics& kinematics() const noexcept; ///< of the robot with what is attached
  const WorldOptions& options() const noexcept;  ///< as given, with the base of now

  /// Other obstacles; or the same, after a HierarchyUpdate or a refit has changed them. They stand where they are
  /// given.
  void setObstacles(const std::vector<const SphereHierarchy*>& obstacles);
  /// Other obstacles at these poses. @throws InvalidInput as setObstaclePoses() does; then nothing has changed
  void setObstacles(const std::vector<const SphereHierarchy*>& obstacles,
                    const std::vector<Eigen::Isometry3d>& T_world_obstacle);
  /// Moves obstacles; no hierarchy is built anew. @throws InvalidInput for a pose that is not rigid within 1e-12
  /// @param T_world_obstacle one for each
  void setObstaclePoses(const std::vector<Eigen::Isometry3d>& T_world_obstacle);
  /// Moves the whole robot.
  void setBase(const Eigen::Isometry3d& T_world_root);

  /// Adds a link that moves with another one. It is compared neither with that nor with links of `ignored`. Its name
  /// must be new.
  void attach(const std::string& name, std::size_t link, std::vector<Shape> shapes,
              const std::vector<std::size_t>& ignored = {});
  void detach(const std::string& name); ///< @throws InvalidInput for a name that is not attached

  /// @throws InvalidInput (Input::motion) naming the joint, for a state of another size, a value that is not finite or
  ///   out of its joint's limits
  StateCheck checkState(const RobotState& state) const;

  /// The line in joint space: continuous joints go the shorter way. @throws as checkState() does
  /// @param with_last_valid also look for the first instant that is not free
  MotionCheck checkMotion(const RobotState& from, const RobotState& to, bool with_last_valid = false) const;

  /// The least gap, of obstacles and, with WorldOptions::with_self, of links. @throws as checkState() does
  /// @param limit gaps beyond it are not looked for: then the gap is from that to infinity
  ClearanceResult clearance(const RobotState& state, double limit = std::numeric_limits<double>::infinity()) const;

  /// Balls, one for each shape and part of a motion, that hold the robot at each instant of it, wherever uncertain
  /// joints are. The shorter parts are, the smaller are balls. @throws as checkState() does
  std::vector<SweptBall> sweptBalls(const RobotState& from, const RobotState& to, std::size_t parts = 4) const;

  /// Many states at once, each as checkState() does it.
  /// @throws InvalidInput as checkState() does, naming the first wrong one, and for an accuracy other than exact;
  ///   Cancelled
  std::vector<StateCheck> checkStates(const std::vector<RobotState>& states, const Effort& effort = {}) const;
  /// A line in joint space.
  struct Motion {
    RobotState from, to;
  };
  /// Many motions at once, each as checkMotion() does it. @throws as checkStates() does
  std::vector<MotionCheck> checkMotions(const std::vector<Motion>& motions, bool with_last_valid = false,
                                        const Effort& effort = {}) const;
  /// Many clearances at once, each as clearance() tells it. @throws as checkStates() does
  std::vector<ClearanceResult> clearances(const std::vector<RobotState>& states,
                                          double limit = std::numeric_limits<double>::infinity(),
                                          const Effort& effort = {}) const;

private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

} // namespace pcl_bsh::robots
PCL_BSH_EXPORT_END
