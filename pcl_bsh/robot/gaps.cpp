// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/robot/convex_distance.h>
#include <pcl_bsh/robot/gaps.h>
#include <pcl_bsh/robot/outward.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace pcl_bsh::robots {

namespace {

constexpr std::size_t kCoarse = 8, kFine = 48; ///< cubes of a field along an edge

Kinematics::Pose operator*(const Kinematics::Pose& a, const Kinematics::Pose& b)
{
  return {a.rotation * b.rotation, a * b.translation};
}

Eigen::Isometry3d isometry(const Kinematics::Pose& pose)
{
  Eigen::Isometry3d all = Eigen::Isometry3d::Identity();
  all.linear() = pose.rotation;
  all.translation() = pose.translation;
  return all;
}

void require(double length, const char* name, bool above_zero)
{
  if (std::isfinite(length) && (above_zero ? length > 0.0 : length >= 0.0)) return;
  throw InvalidInput(Input::clearance, name, "is " + std::to_string(length),
                     above_zero ? "give one that is finite and above 0" : "give one that is finite and >= 0")
      .withValue(length);
}

WorldOptions checked(const WorldOptions& options)
{
  require(options.clearance, "clearance", false);
  require(options.self_clearance, "self_clearance", false);
  require(options.tolerance, "tolerance", true);
  const Eigen::Matrix3d r = options.base.linear();
  if (!(options.base.matrix().allFinite() && (r.transpose() * r - Eigen::Matrix3d::Identity()).norm() <= 1e-12))
    throw InvalidInput(Input::pose, "base", "is not rigid within 1e-12", "normalise its rotation");
  return options;
}

Interval less(Interval gap, double length)
{
  return {gap.lower - length, gap.upper - length};
}

Interval ofMeshes(const SphereHierarchy& a, const Kinematics::Pose& pose_a, const SphereHierarchy& b,
                  const Kinematics::Pose& pose_b, double limit, std::uint32_t* record = nullptr)
{
  DistanceRequest request;
  request.max_distance = std::max(limit, 0.0);
  const DistanceResult found = closestPair({a, isometry(pose_a)}, {b, isometry(pose_b)}, request);
  if (!found.pair) return {std::min(limit, request.max_distance), kInfinity};
  if (record) *record = found.pair->b;
  return found.interval;
}

} // namespace

Gaps::Gaps(Robot robot_given, std::vector<Obstacle> obstacles_given, const WorldOptions& options_given)
: robot(std::move(robot_given)),
  options(checked(options_given)),
  kinematics(robot),
  base{options.base.linear(), options.base.translation()},
  parts(robot, kinematics),
  obstacles(std::move(obstacles_given))
{
  double reach = parts.extent;
  for (const Kinematics::Body& body : kinematics.bodies()) reach = std::max(reach, body.reach + parts.extent);
  reach = std::max(reach, 1e-30);
  coarse_.emplace(obstacles, base.translation, reach, kCoarse, reach);
  fine_.emplace(obstacles, base.translation, reach, kFine, 0.25 * reach);
}

Gap Gaps::meshToObstacle(const Piece& piece, const Kinematics::Pose& pose, const Obstacle& obstacle, double limit) const
{
  Gap gap;
  static_cast<Interval&>(gap) = ofMeshes(*piece.surface, pose, obstacle.hierarchy(), {}, limit, &gap.record);
  return gap;
}

Gap Gaps::toObstacles(const Ball& ball, const Poses& poses, double limit, std::size_t& which) const
{
  const Piece& piece = parts.pieces[ball.piece];
  const Kinematics::Pose pose = poses[ball.body] * piece.pose;
  const double padded = limit + ball.padding;
  Gap best{{padded, kInfinity}};
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const double within = std::min(padded, best.upper);
    const Gap gap =
        piece.solid ? obstacles[i].gap(*piece.solid, pose, within) : meshToObstacle(piece, pose, obstacles[i], within);
    best.lower = std::min(best.lower, gap.lower);
    if (!(gap.upper < best.upper)) continue;
    best.upper = gap.upper;
    best.record = gap.record;
    which = i;
  }
  static_cast<Interval&>(best) = less(best, ball.padding);
  return best;
}

Interval Gaps::between(const Ball& a, const Ball& b, const Poses& poses, double limit) const
{
  const Piece &piece_a = parts.pieces[a.piece], &piece_b = parts.pieces[b.piece];
  const Kinematics::Pose pose_a = poses[a.body] * piece_a.pose, pose_b = poses[b.body] * piece_b.pose;
  const double padding = a.padding + b.padding, padded = limit + padding;
  if (piece_a.solid && piece_b.solid) {
    const double round = roundness(*piece_a.solid) + roundness(*piece_b.solid);
    const auto reachOf = [](const Solid& solid, const Kinematics::Pose& pose) {
      return [&](const Eigen::Vector3d& direction) {
        return Eigen::Vector3d(pose * support(solid, pose.rotation.transpose() * direction));
      };
    };
    return less(convexDistance(reachOf(*piece_a.solid, pose_a), reachOf(*piece_b.solid, pose_b), padded + round),
                round + padding);
  }
  if (!piece_a.solid && !piece_b.solid)
    return less(ofMeshes(*piece_a.surface, pose_a, *piece_b.surface, pose_b, padded), padding);
  const bool first = piece_a.solid.has_value();
  const Kinematics::Pose &of_solid = first ? pose_a : pose_b, &of_mesh = first ? pose_b : pose_a;
  const Kinematics::Pose inverse{of_mesh.rotation.transpose(), -(of_mesh.rotation.transpose() * of_mesh.translation)};
  const Obstacle mesh(first ? *piece_b.surface : *piece_a.surface);
  return less(mesh.gap(first ? *piece_a.solid : *piece_b.solid, inverse * of_solid, padded), padding);
}

Meeting Gaps::meetingOf(const Ball& ball, std::size_t obstacle, std::uint32_t record) const
{
  const Piece& piece = parts.pieces[ball.piece];
  return {piece.link, piece.shape, std::nullopt, 0, obstacle, record};
}

Meeting Gaps::meetingOf(const Ball& a, const Ball& b) const
{
  const Piece &one = parts.pieces[a.piece], &other = parts.pieces[b.piece];
  return {one.link, one.shape, other.link, other.shape, 0, kNothing};
}

double Gaps::error(const RobotState& largest) const
{
  // For coordinates in the world, which are turned into a shape's frame.
  constexpr double kOfGaps = 0x1p-45;
  const double away = base.translation.norm();
  double reach = 0.0;
  for (const Kinematics::Body& body : kinematics.bodies()) reach = std::max(reach, body.reach);
  return kinematics.error(largest, parts.extent, away) +
         kOfGaps * (away + 2.0 * (reach + parts.extent) + options.clearance + options.self_clearance);
}

void Gaps::requireState(const RobotState& state, const char* several, std::size_t number) const
{
  const auto name = [&] { return several ? several + (" " + std::to_string(number)) : "state"; };
  if (state.size() != kinematics.variables())
    throw InvalidInput(Input::motion, name(), "has " + std::to_string(state.size()) + " values",
                       "give one for each of the " + std::to_string(kinematics.variables()) + " joints of " +
                           robot.name)
        .withValue(static_cast<double>(state.size()));
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Joint& joint = *robot.links[kinematics.linkOfVariable(i)].joint;
    const bool bounded = joint.kind != Joint::Kind::continuous;
    if (std::isfinite(state[i]) && (!bounded || (state[i] >= joint.lower && state[i] <= joint.upper))) continue;
    throw InvalidInput(Input::motion, (several ? name() + ": joint '" : "joint '") + joint.name + "'",
                       "has the value " + std::to_string(state[i]),
                       bounded ? "its limits are " + std::to_string(joint.lower) + " to " + std::to_string(joint.upper)
                               : "give a finite one")
        .withValue(state[i])
        .withIndex(several ? number : i);
  }
}

} // namespace pcl_bsh::robots
