// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/pose_path.h>

#include <pcl_bsh/geometry/compensated_sum.h>
#include <pcl_bsh/query/trajectory.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pcl_bsh {
namespace {

constexpr double kRounding = 0x1p-45; ///< of the bounds below: a few dozen operations in double
constexpr double kMostPoses = 0x1p24; ///< of a swept path: some 5 GB

double distance(const Point3& a, const Point3& b)
{
  return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

double excess(const Eigen::Matrix3d& rotation)
{
  if (rotation == Eigen::Matrix3d::Identity()) return 0.0;
  const Eigen::Matrix3d e = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  return e.cwiseAbs().rowwise().sum().maxCoeff() + 0x1p-48;
}

} // namespace

Point3 carried(const Eigen::Isometry3d& pose, const Point3& p)
{
  Point3 result;
  for (int i = 0; i < 3; ++i) {
    CompensatedSum sum;
    for (int j = 0; j < 3; ++j) sum.addProduct(pose.matrix()(i, j), p[static_cast<std::size_t>(j)]);
    sum.add(pose.matrix()(i, 3));
    result[static_cast<std::size_t>(i)] = sum.value();
  }
  return result;
}

Eigen::Isometry3d poseBetween(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double fraction,
                              const Point3& pivot)
{
  const Eigen::Vector3d p(pivot[0], pivot[1], pivot[2]);
  const Eigen::Quaterniond first(from.linear()), last(to.linear());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = first.normalized().slerp(fraction, last.normalized()).normalized().toRotationMatrix();
  pose.translation() = (1.0 - fraction) * (from * p) + fraction * (to * p) - pose.linear() * p;
  return pose;
}

PosePath::PosePath(const Eigen::Isometry3d& scan_pose, const std::vector<Eigen::Isometry3d>& model_poses,
                   const Point3& center)
{
  for (std::size_t k = 0; k < model_poses.size(); ++k)
    if (k == 0 || model_poses[k].matrix() != model_poses[k - 1].matrix())
      add(scan_pose, model_poses[k], center, static_cast<std::uint32_t>(k), 0.0);
  if (!poses.empty()) divide(0, static_cast<std::uint32_t>(poses.size() - 1));
}

/// Seen by the model, a point s moves as U(t) = R'(t) (s - c(t)), where R turns by an angle a and the pivot c goes
/// straight by d: |U''| <= a^2 |s - c| + 2 a |d|, so that U bows out by an eighth of that at most.
PosePath::PosePath(const Eigen::Isometry3d& scan_pose, const std::vector<Eigen::Isometry3d>& model_poses,
                   const Point3& center, const Sweep& sweep)
: is_swept(true),
  stray(sweep.stray)
{
  double total = 0.0;
  for (std::size_t k = 0; k < model_poses.size(); ++k) {
    if (k + 1 == model_poses.size()) {
      add(scan_pose, poseBetween(model_poses[k], model_poses[k], 0.0, sweep.pivot), center,
          static_cast<std::uint32_t>(k), 0.0);
      break;
    }
    const Eigen::Isometry3d &from = model_poses[k], &to = model_poses[k + 1];
    const Point3 begin = carried(from, sweep.pivot), end = carried(to, sweep.pivot);
    const Eigen::Quaterniond first(from.linear()), last(to.linear());
    const double angle = first.normalized().angularDistance(last.normalized()) * (1.0 + kRounding) + kRounding;
    const double way = distance(begin, end) * (1.0 + kRounding);
    const double reach = sweep.radius + sweep.reach + way;
    const double cuts =
        std::max(1.0, std::ceil(std::sqrt((angle * angle * reach + 2 * angle * way) / (8 * sweep.stray))));
    total += cuts;
    if (!(total < kMostPoses)) {
      std::ostringstream message;
      message << "tolerance of the swept motion: too small, from pose " << k << " to the next the model turns by "
              << angle << " and moves by " << way << ": give a larger one, or poses that are nearer to each other";
      throw std::invalid_argument(message.str());
    }
    for (double i = 0; i < cuts; ++i) {
      add(scan_pose, poseBetween(from, to, i / cuts, sweep.pivot), center, static_cast<std::uint32_t>(k), i / cuts);
      Bow bow;
      bow.turn = angle * angle / (cuts * cuts) / 8;
      bow.drift = angle / cuts * (way / cuts) / 4;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        bow.from[axis] = begin[axis] + (end[axis] - begin[axis]) * (i / cuts);
        bow.to[axis] = begin[axis] + (end[axis] - begin[axis]) * ((i + 1) / cuts);
      }
      bows_.push_back(bow);
    }
  }
  if (!poses.empty()) divide(0, static_cast<std::uint32_t>(poses.size() - 1));
}

void PosePath::add(const Eigen::Isometry3d& scan_pose, const Eigen::Isometry3d& pose, const Point3& center,
                   std::uint32_t given, double fraction)
{
  const Eigen::Matrix3d back = pose.linear().transpose(), turn = back * scan_pose.linear();
  PathPose& added = poses.emplace_back();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      added.back[static_cast<std::size_t>(3 * i + j)] = back(i, j);
      added.turn[static_cast<std::size_t>(3 * i + j)] = roundToFloat(turn(i, j));
    }
  added.center = carried(pose, center);
  added.given = given;
  added.fraction = fraction;
  for (const double x : added.center) far = std::max(far, std::abs(x));
  skew = std::max(skew, excess(pose.linear()) + excess(scan_pose.linear()));
}

std::uint32_t PosePath::divide(std::uint32_t first, std::uint32_t last)
{
  const auto index = static_cast<std::uint32_t>(intervals.size());
  intervals.emplace_back();
  intervals[index].first = first;
  intervals[index].last = last;
  bound(intervals[index]);
  // Between two poses the way is straight by definition; when swept, its bow is as small as it needs to be.
  if (last - first < 2) return index;
  const std::uint32_t middle = first + (last - first) / 2;
  const std::uint32_t left = divide(first, middle);
  const std::uint32_t right = divide(is_swept ? middle : middle + 1, last);
  intervals[index].left = left;
  intervals[index].right = right;
  return index;
}

void PosePath::bound(PathInterval& interval) const
{
  const std::uint32_t first = interval.first, last = interval.last;
  const Point3& pivot = interval.pivot = poses[first + (last - first) / 2].center;
  const PathPose &from = poses[first], &to = poses[last];
  const Point3 from_seen = from.see(pivot), to_seen = to.see(pivot);
  double drift = 0.0, turn = 0.0, extent = distance(from.center, pivot) + distance(to.center, pivot);
  for (std::uint32_t k = first + 1; k < last; ++k) {
    const double t = static_cast<double>(k - first) / (last - first);
    double squared = 0.0;
    for (std::size_t i = 0; i < 9; ++i) {
      const double difference = poses[k].back[i] - ((1.0 - t) * from.back[i] + t * to.back[i]);
      squared += difference * difference;
    }
    turn = std::max(turn, squared);
    const Point3 seen = poses[k].see(pivot);
    squared = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double difference = seen[i] - ((1.0 - t) * from_seen[i] + t * to_seen[i]);
      squared += difference * difference;
    }
    drift = std::max(drift, squared);
    extent = std::max(extent, distance(poses[k].center, pivot));
  }
  interval.turn = std::sqrt(turn) * (1.0 + kRounding) + (last > first ? kRounding : 0.0);
  interval.drift = std::sqrt(drift) * (1.0 + kRounding) + kRounding * extent;
  if (!is_swept || first == last) return;
  double bow_drift = 0.0, bow_turn = 0.0;
  for (std::uint32_t k = first; k < last; ++k) {
    const double away = std::max(distance(bows_[k].from, pivot), distance(bows_[k].to, pivot));
    bow_drift = std::max(bow_drift, bows_[k].drift + bows_[k].turn * away);
    bow_turn = std::max(bow_turn, bows_[k].turn);
  }
  interval.drift += bow_drift;
  interval.turn += bow_turn;
}

} // namespace pcl_bsh
