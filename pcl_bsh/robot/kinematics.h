// SPDX-License-Identifier: BSD-3-Clause
// Where a robot's bodies are, how fast they move along a line in joint space, and how wrong doubles may be about that.
//
// A body is links that fixed joints hold together. Exact here is real arithmetic on the bodies' numbers as doubles have
// them. A turn is I + sin(q) K + (1 - cos(q)) K^2, and K is the cross product with the axis.
//
// **Rounding.** Let u = 2^-53. Norms are those of Frobenius: sqrt(3) of a rotation, sqrt(2) of K and of K^2.
//   - A product of two 3 x 3 matrices errs by 3 u times their norms: O K by 7.4 u, O K^2 by 21 u.
//   - Sine and cosine err by 2 u, 1 - cos by 3 u, the sum of the three terms by 18 u: a joint's matrix by 76 u.
//   - Its product with the body's before errs by 9 u more: the k-th body's rotation errs by at most 85 k u.
//   - A position adds R o, which errs by (85 k + 8) u |o|, and 2 u of the reach for sums.
//   - A joint that slides adds one such o, as long as its limits let it be.
// After n bodies a point x errs by at most (87 n + 10) u (sum |o| + |x|). Terms of u^2 are below one u of that.
// kForwardRoundings (n + 1) is more.
//
// A joint's value at a time of a line errs by at most 16 u (|q0| + |q1|). This pays for a mimicked joint's product and
// sum, and for the remainder by a turn. A point moves by so much times its greatest distance from the axis.
//
// **Motion.** Let c be a point and a_j the axis of joint j through o_j. Then dc/dq_j is a_j x (c - o_j), at most r_j,
// the greatest distance from the axis. Where j slides it is a_j, and r_j is 1. For i <= j, the second derivative is a_i
// x dc/dq_j where i turns, and 0 where i slides. Let s be the slopes of a line:
//
//   |c''| <= A = sum_j r_j |s_j| ([j turns] |s_j| + 2 sum_(i < j, i turns) |s_i|)
//
//   |c(m + t) - c(m)| <= |c'(m)| |t| + A t^2 / 2
//
// Sums are over the chain from the body that is taken to be at rest.
//
// **Distances from axes.** All that a point can reach beyond joint j lies in a cylinder about j's axis. A turn leaves
// it as it is. Let d be its direction seen from the joint before, p0 and p1 the middles of its ends, r its radius. It
// is at most max |p_i across the axis a| + r from a, and its heights are those of p_i, more or less r |a x d|.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/robot/robot.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::robots {

/// Bodies of a robot that has been checked. Const methods may run in several threads at once.
class Kinematics {
public:
  /// How a body moves in an instant: a point at x by turn * x + shift, each second of a line that takes one.
  struct Twist {
    Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();
    Eigen::Vector3d at(const Eigen::Vector3d& x) const { return turn.cross(x) + shift; } ///< of a point at x
  };
  /// A rotation, then a translation.
  struct Pose {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    /** A point. */ Eigen::Vector3d operator*(const Eigen::Vector3d& x) const
    {
      return rotation.col(0) * x.x() + rotation.col(1) * x.y() + rotation.col(2) * x.z() + translation;
    }
    /** First the other. */ Pose operator*(const Pose& other) const
    {
      return {rotation * other.rotation, *this * other.translation};
    }
    /** The same. */ Eigen::Isometry3d isometry() const
    {
      Eigen::Isometry3d all = Eigen::Isometry3d::Identity();
      all.linear() = rotation;
      all.translation() = translation;
      return all;
    }
    /** The way back. */ Pose inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
  };

  /// A joint that moves, and the links that hang on it, up to the next such joints. Body 0 stands still.
  struct Body {
    std::size_t link = 0;                  ///< its first
    std::size_t parent = 0;                ///< a body
    std::size_t variable = 0;              ///< of a state
    double multiplier = 1.0, offset = 0.0; ///< its value is multiplier * variable + offset
    Joint::Kind kind = Joint::Kind::fixed; ///< fixed: body 0 alone
    Pose origin;                           ///< T_parent_body at 0
    Eigen::Matrix3d sine, versine;         ///< origin's rotation times K and K^2
    Eigen::Vector3d axis, origin_axis;     ///< in its own frame, and in its parent's
    double lower = 0.0, upper = 0.0;       ///< limits of a joint that slides
    double reach = 0.0;                    ///< a point x of its frame is at most this plus |x| from the robot's root
  };

  /// @throws InvalidInput naming the link or joint. Parents come before their children, poses are rigid within 1e-12,
  ///   axes of length 1, limits an interval. Sliding joints have finite limits. Mimicked joints exist, without a cycle.
  ///   Paddings are finite and >= 0, sizes of shapes above 0
  explicit Kinematics(const Robot& robot);

  const std::vector<Body>& bodies() const noexcept { return bodies_; }          ///< parents first
  std::size_t variables() const noexcept { return links_of_variables_.size(); } ///< values of a state
  /// The link that a value of a state moves.
  std::size_t linkOfVariable(std::size_t variable) const { return links_of_variables_[variable]; }
  std::size_t bodyOf(std::size_t link) const { return body_of_link_[link]; }             ///< that a link is part of
  const Eigen::Isometry3d& inBody(std::size_t link) const { return T_body_link_[link]; } ///< T_body_link

  /// Poses of the bodies [0, count), from that of body 0.
  void poses(const RobotState& state, const Pose& base, std::size_t count, std::vector<Pose>& poses) const;

  /// T_root_link of every link. @pre a state of the right size
  std::vector<Eigen::Isometry3d> linkPoses(const RobotState& state) const;

  /// Twists of the bodies [0, count) at these poses, where variables change by these slopes.
  void twists(const RobotState& slopes, const std::vector<Pose>& poses, std::size_t count,
              std::vector<Twist>& twists) const;

  /// Returns for each body on the chain to `body`, the last, how far a point of `body` can be from its axis; 1 where it
  /// slides.
  /// @param spread how far the point is from `center`, in the body's frame
  std::vector<double> axisDistances(std::size_t body, const Eigen::Vector3d& center, double spread) const;

  /// The bodies of the chain, in the order of axisDistances().
  std::vector<std::size_t> chain(std::size_t body) const;

  /// Returns an upper bound of how far a computed point is from the exact one.
  /// @param largest values of joints are at most these
  /// @param extent how far the point is from its body's origin
  /// @param base how far body 0 is from the origin
  double error(const RobotState& largest, double extent, double base) const;

private:
  std::vector<Body> bodies_;
  std::vector<std::size_t> body_of_link_, links_of_variables_;
  std::vector<Eigen::Isometry3d> T_body_link_;
  std::size_t depth_ = 0; ///< bodies of the longest chain
};

/// T_root_link of every link. @throws InvalidInput as Kinematics and Robot::requireValues() do
std::vector<Eigen::Isometry3d> linkPoses(const Robot& robot, const JointValues& values);

/// Returns the pairs of links that are compared with each other: not a link and its parent, nor links of one body, nor
/// disabled pairs. The lower number comes first. @throws InvalidInput for a disabled pair of links that are not there
std::vector<std::array<std::size_t, 2>> comparedLinks(const Robot& robot, const Kinematics& kinematics);

/// Roundings of each joint of a chain that Kinematics::error() counts.
inline constexpr double kForwardRoundings = 128.0;

} // namespace pcl_bsh::robots
PCL_BSH_EXPORT_END
