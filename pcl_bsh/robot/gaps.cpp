// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/triangle/triangle_distance.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/pairs/any_at_places.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/robot/convex_distance.h>
#include <pcl_bsh/robot/gaps.h>
#include <pcl_bsh/robot/outward.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace pcl_bsh::robots {

namespace {

void require(double length, const char* name, bool above_zero)
{
  if (std::isfinite(length) && (above_zero ? length > 0.0 : length >= 0.0)) return;
  throw InvalidInput(Input::clearance, name, "is " + std::to_string(length),
                     above_zero ? "give one that is finite and above 0" : "give one that is finite and >= 0")
      .withValue(length);
}

void requirePose(const Eigen::Isometry3d& pose, const std::string& name)
{
  if (!isRigid(pose, kRigid))
    throw InvalidInput(Input::pose, name, "is not rigid within 1e-12", "normalise its rotation");
}

WorldOptions checked(const WorldOptions& options)
{
  require(options.clearance, "clearance", false);
  require(options.self_clearance, "self_clearance", false);
  require(options.tolerance, "tolerance", true);
  requirePose(options.base, "base");
  return options;
}

/// @param doubt how far either bound may be off
Interval less(const Interval& gap, double length, double doubt = 0.0)
{
  return {gap.lower - length - doubt, gap.upper - length + doubt};
}

double uncertaintyOf(const SphereHierarchy& cloud, std::uint32_t record)
{
  return cloud.view().uncertainty + cloud.view().ownUncertainty(record);
}

const std::vector<double>& checkedUncertainties(const std::vector<double>& of_joints, const Kinematics& kinematics,
                                                const Robot& robot)
{
  if (!of_joints.empty() && of_joints.size() != kinematics.variables())
    throw InvalidInput(Input::uncertainty, "joint_uncertainties", "are " + std::to_string(of_joints.size()),
                       "give one for each of the " + std::to_string(kinematics.variables()) + " joints of " +
                           robot.name + ", or none")
        .withValue(static_cast<double>(of_joints.size()));
  for (std::size_t i = 0; i < of_joints.size(); ++i)
    if (!(of_joints[i] >= 0.0 && std::isfinite(of_joints[i])))
      throw InvalidInput(Input::uncertainty, "joint_uncertainties",
                         "has " + std::to_string(of_joints[i]) + " for joint '" +
                             robot.links[kinematics.linkOfVariable(i)].joint->name + "'",
                         "give an angle or a length that is finite and >= 0")
          .withValue(of_joints[i])
          .withIndex(i);
  return of_joints;
}

/// Returns a lower bound of how far an edge of a that pierces b moves until it pierces b no more: until it meets b's
/// rim, or one of its ends meets b. It is 0 where no edge of a pierces b.
double pierced(const TriangleDistance& distance, const Triangle3& a, const Triangle3& b)
{
  double best = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Triangle3 edge = {a[i], a[(i + 1) % 3], a[(i + 1) % 3]};
    if (distance.compare(edge, b, 0.0) > 0) continue;
    double least = kInfinity;
    const auto take = [&](const TriangleDistance::Enclosure& of) {
      least = std::min(least, std::isfinite(of.high) ? of.low : 0.0);
    };
    for (std::size_t k = 0; k < 3 && least > best; ++k)
      take(distance.enclose(edge, Triangle3{b[k], b[(k + 1) % 3], b[(k + 1) % 3]}));
    for (std::size_t k = 0; k < 2 && least > best; ++k) take(distance.enclose(edge[k], b));
    best = std::max(best, least);
  }
  return best;
}

/// The row of the corner that is farthest along a direction.
Eigen::Index farthest(const Eigen::MatrixX3d& corners, const Eigen::Vector3d& along)
{
  // First the maximum, then its row: a search for both would compare number by number.
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostCorners, 1> heights(corners.rows());
  heights = corners.col(0) * along.x() + corners.col(1) * along.y() + corners.col(2) * along.z();
  const auto most = std::find(heights.begin(), heights.end() - 1, heights.maxCoeff());
  return most - heights.begin();
}

/// Returns the records whose measured places are nearest, or any two within the limit, and their distance.
DistanceResult pairWithin(const Placed& a, const Placed& b, double limit, bool any)
{
  if (!any) {
    DistanceRequest request;
    request.max_distance = limit;
    return closestPair(a, b, request);
  }
  DistanceResult found;
  found.pair = anyCollisionAt(a, b, {limit}, MeantPlaces::measured).pair;
  if (!found.pair) return found;
  found.distance = RecordDistance(a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose).gap(*found.pair);
  found.interval = {found.distance * (1.0 - 0x1p-52), found.distance * (1.0 + 0x1p-52)};
  return found;
}

Interval ofMeshes(const SphereHierarchy& a, const Kinematics::Pose& pose_a, const SphereHierarchy& b,
                  const Kinematics::Pose& pose_b, double limit, bool any)
{
  const double uncertain = a.storage().uncertainty.most + b.storage().uncertainty.most;
  DistanceResult found =
      pairWithin({a, pose_a.isometry()}, {b, pose_b.isometry()}, std::max(limit + uncertain, 0.0), any);
  if (!found.pair) return {limit, kInfinity};
  const PointsView &view_a = a.view(), &view_b = b.view();
  if (found.interval.upper == 0.0 && view_a.triangles && view_b.triangles) {
    const Triangle3 one = view_a.triangles->triangle(found.pair->a), other = view_b.triangles->triangle(found.pair->b);
    const double depth = std::max(pierced(TriangleDistance(pose_a.isometry(), pose_b.isometry()), one, other),
                                  pierced(TriangleDistance(pose_b.isometry(), pose_a.isometry()), other, one));
    found.interval.upper = -depth;
  }
  return {found.interval.lower - uncertain,
          found.interval.upper + uncertaintyOf(a, found.pair->a) + uncertaintyOf(b, found.pair->b)};
}

} // namespace

Gaps::Gaps(Robot robot_given, std::vector<Obstacle> obstacles_given, const WorldOptions& options_given)
: robot(std::move(robot_given)),
  options(checked(options_given)),
  kinematics(robot),
  base{options.base.linear(), options.base.translation()},
  parts(robot, kinematics, checkedUncertainties(options.joint_uncertainties, kinematics, robot)),
  obstacles_(std::move(obstacles_given))
{
}

void Gaps::setObstacles(std::vector<Obstacle> placed, const std::vector<Eigen::Isometry3d>& T_world_obstacle)
{
  if (T_world_obstacle.size() != placed.size())
    throw InvalidInput(Input::pose, "obstacles", "get " + std::to_string(T_world_obstacle.size()) + " poses",
                       "give one for each of the " + std::to_string(placed.size()));
  for (std::size_t i = 0; i < placed.size(); ++i) {
    requirePose(T_world_obstacle[i], "pose of obstacle " + std::to_string(i));
    placed[i].pose = {T_world_obstacle[i].linear(), T_world_obstacle[i].translation()};
  }
  setObstacles(std::move(placed));
}

double Gaps::doubt(const Ball& ball, std::size_t rest) const
{
  if (ball.doubts.empty() || ball.body == rest) return 0.0;
  const std::vector<std::size_t>& chain = parts.chains[ball.body];
  const auto first = rest == 0 ? chain.begin() : std::find(chain.begin(), chain.end(), rest) + 1;
  return ball.doubts[static_cast<std::size_t>(first - chain.begin())];
}

ObstacleGap Gaps::toObstacles(const Ball& ball, const Poses& poses, double limit, bool any) const
{
  const Piece& piece = parts.pieces[ball.piece];
  const Kinematics::Pose pose = poses[ball.body] * piece.pose;
  const double off = doubt(ball, 0), padded = limit + ball.padding + off;
  ObstacleGap best{{{padded, kInfinity}}};
  const auto patch = [&]() -> Patch {
    const std::uint32_t* const records = parts.records.data() + ball.record;
    return {*piece.surface, records, records + ball.records, centerOf(ball, poses), ball.spread};
  };
  for (std::size_t i = 0; i < obstacles().size(); ++i) {
    const double within = std::min(padded, best.upper);
    const Gap gap =
        piece.solid ? obstacles_[i].gap(*piece.solid, pose, within) : obstacles_[i].gap(patch(), pose, within, any);
    if (gap.record == kNothing) continue;
    if (gap.lower < best.lower || best.possible == kNothing) {
      best.lower = std::min(best.lower, gap.lower);
      best.possible = gap.possible;
      best.of_possible = i;
    }
    if (gap.upper < best.upper || best.record == kNothing) {
      best.upper = std::min(best.upper, gap.upper);
      best.record = gap.record;
      best.of_record = i;
    }
    if (any && !piece.solid) break;
  }
  static_cast<Interval&>(best) = less(best, ball.padding, off);
  return best;
}

ObstacleGap Gaps::anyOfMesh(const Ball& ball, const Poses& poses, double limit) const
{
  const Piece& piece = parts.pieces[ball.piece];
  const Placed mesh(*piece.surface, (poses[ball.body] * piece.pose).isometry());
  const double off = doubt(ball, 0);
  for (std::size_t i = 0; i < obstacles().size(); ++i) {
    const SphereHierarchy& of = obstacles_[i].hierarchy();
    const DistanceResult found =
        pairWithin({of, obstacles_[i].pose.isometry()}, mesh, limit + ball.padding + off, true);
    if (!found.pair) continue;
    const auto [a, b] = *found.pair;
    return {{less(found.interval, ball.padding, off + uncertaintyOf(of, a) + uncertaintyOf(*piece.surface, b)), a, a},
            i,
            i};
  }
  return {};
}

double Gaps::hullsApart(const Ball& a, const Ball& b, std::size_t common, const Poses& poses, double least,
                        double enough) const
{
  const Piece &piece_a = parts.pieces[a.piece], &piece_b = parts.pieces[b.piece];
  if (piece_a.corners.rows() == 0 || piece_b.corners.rows() == 0) return -kInfinity;
  const auto reachOf = [](const Eigen::MatrixX3d& corners, const Kinematics::Pose& pose) {
    return [&](const Eigen::Vector3d& direction) {
      const Eigen::Vector3d along = pose.rotation.transpose() * direction;
      return pose * corners.row(farthest(corners, along)).transpose();
    };
  };
  const Kinematics::Pose pose_a = poses[a.body] * piece_a.pose, pose_b = poses[b.body] * piece_b.pose;
  const double less = a.padding + b.padding + doubt(a, common) + doubt(b, common) +
                      piece_a.surface->storage().uncertainty.most + piece_b.surface->storage().uncertainty.most;
  return convexDistance(
             reachOf(piece_a.corners, pose_a), reachOf(piece_b.corners, pose_b),
             [&](const Interval& bounds) {
               return bounds.lower > enough + less ||
                      (bounds.upper <= enough + less && (bounds.lower > least + less || bounds.upper <= least + less));
             },
             centerOf(a, poses) - centerOf(b, poses))
             .lower -
         less;
}

Interval Gaps::between(const Ball& a, const Ball& b, std::size_t common, const Poses& poses, double limit,
                       bool any) const
{
  const double off = doubt(a, common) + doubt(b, common);
  if (a.is_sphere && b.is_sphere) {
    const double apart = (centerOf(a, poses) - centerOf(b, poses)).norm();
    return less({apart, apart}, a.radius + b.radius, off);
  }
  const Piece &piece_a = parts.pieces[a.piece], &piece_b = parts.pieces[b.piece];
  const Kinematics::Pose pose_a = poses[a.body] * piece_a.pose, pose_b = poses[b.body] * piece_b.pose;
  const double padding = a.padding + b.padding, padded = limit + padding + off;
  if (piece_a.solid && piece_b.solid) {
    const double round = roundness(*piece_a.solid) + roundness(*piece_b.solid);
    const auto reachOf = [](const Solid& solid, const Kinematics::Pose& pose) {
      return [&](const Eigen::Vector3d& direction) {
        return Eigen::Vector3d(pose * support(solid, pose.rotation.transpose() * direction));
      };
    };
    return less(convexDistance(
                    reachOf(*piece_a.solid, pose_a), reachOf(*piece_b.solid, pose_b),
                    [&](const Interval& bounds) { return bounds.lower > padded + round; },
                    centerOf(a, poses) - centerOf(b, poses)),
                round + padding, off);
  }
  if (!piece_a.solid && !piece_b.solid)
    return less(ofMeshes(*piece_a.surface, pose_a, *piece_b.surface, pose_b, padded, any), padding, off);
  const bool first = piece_a.solid.has_value();
  const Kinematics::Pose &of_solid = first ? pose_a : pose_b, &of_mesh = first ? pose_b : pose_a;
  Obstacle mesh(first ? *piece_b.surface : *piece_a.surface);
  mesh.pose = of_mesh;
  return less(mesh.gap(first ? *piece_a.solid : *piece_b.solid, of_solid, padded), padding, off);
}

Meeting Gaps::meetingOf(const Ball& ball, const ObstacleGap& gap, bool for_certain) const
{
  const Piece& piece = parts.pieces[ball.piece];
  return {piece.link,
          piece.shape,
          std::nullopt,
          0,
          for_certain ? gap.of_record : gap.of_possible,
          for_certain ? gap.record : gap.possible};
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
  double reach = 0.0, of_obstacles = 0.0;
  for (const Kinematics::Body& body : kinematics.bodies()) reach = std::max(reach, body.reach);
  for (const Obstacle& obstacle : obstacles()) {
    const double placed = obstacle.pose.translation.norm();
    double error = kOfGaps * (placed + obstacle.mostUncertain());
    // The transpose of a rotation that is rigid only within kRigid, and lengths in the obstacle's frame.
    if (!obstacle.pose.rotation.isIdentity(0.0))
      error += 4.0 * kRigid * (away + reach + parts.extent + placed + options.clearance);
    of_obstacles = std::max(of_obstacles, error);
  }
  return kinematics.error(largest, parts.extent, away) + of_obstacles +
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
