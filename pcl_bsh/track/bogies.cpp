// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/bogies.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

Eigen::Vector3d vectorOf(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

/// How far along the axis the other pivot is, which is behind (`direction` -1) or ahead (1).
double alongToPivot(const Axis& axis, double pivots, double from, double direction)
{
  const auto refuse = [&](const std::string& wrong, double value) {
    throw InvalidInput(Input::trajectory, "vehicle", wrong, "give a place where both pivots stand on the axis")
        .withValue(value);
  };
  if (!(pivots > 0.0 && std::isfinite(pivots))) refuse(plainText("its pivots are ", pivots, " apart"), pivots);
  if (!(from >= 0.0 && from <= axis.length()))
    refuse(plainText("a pivot is at distance ", from, ", not on an axis ", axis.length(), " long"), from);
  const Eigen::Vector3d at = vectorOf(axis.frame(from).origin);
  const auto tooFar = [&](double t) {
    return (vectorOf(axis.frame(from + direction * t).origin) - at).norm() - pivots;
  };
  const double most = direction > 0.0 ? axis.length() - from : from;
  double near = 0.0, far = std::min(pivots, most), at_near = -pivots;
  while (tooFar(far) < 0.0 && far < most && far < 4.0 * pivots) far = std::min(most, far + 0.1 * pivots);
  double at_far = tooFar(far);
  if (at_far < -1e-9)
    refuse(plainText("its other pivot, ", pivots, " from that at distance ", from, ", is not on the axis"), from);
  for (int step = 0, side = 0; step < 100 && far - near > 1e-13; ++step) { // false position with halved ends (Illinois)
    const double t = std::clamp((near * at_far - far * at_near) / (at_far - at_near), near, far);
    const double value = tooFar(t);
    if (std::abs(value) <= 1e-14) return t;
    const bool beyond = value > 0.0;
    (beyond ? far : near) = t;
    (beyond ? at_far : at_near) = value;
    if (side == (beyond ? 1 : -1)) (beyond ? at_near : at_far) *= 0.5;
    side = beyond ? 1 : -1;
  }
  return at_far < -at_near ? far : near;
}

} // namespace

double rearPivotOf(const Axis& axis, double pivots, double front)
{
  return front - alongToPivot(axis, pivots, front, -1.0);
}

double frontPivotOf(const Axis& axis, double pivots, double rear)
{
  return rear + alongToPivot(axis, pivots, rear, 1.0);
}

Eigen::Isometry3d poseOnPivots(const Axis& axis, double pivots, double front)
{
  const AxisFrame first = axis.frame(front), second = axis.frame(rearPivotOf(axis, pivots, front));
  const Eigen::Vector3d behind = vectorOf(second.origin), ahead = vectorOf(first.origin) - behind;
  Eigen::Matrix3d turned;
  turned.col(0) = ahead.normalized();
  turned.col(1) = (vectorOf(first.up) + vectorOf(second.up)).cross(turned.col(0)).normalized();
  turned.col(2) = turned.col(0).cross(turned.col(1));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = turned;
  pose.translation() = behind + 0.5 * ahead;
  return pose;
}

std::vector<Eigen::Isometry3d> posesAlong(const Axis& axis, double pivots, double first, double last, double step)
{
  const double count = std::floor((last - first) / step);
  if (!(step > 0.0 && last >= first && count < 1e7))
    throw InvalidInput(Input::trajectory, "poses",
                       plainText("from distance ", first, " to ", last, " by steps of ", step),
                       "give distances that rise, and a step above 0");
  std::vector<Eigen::Isometry3d> poses;
  for (double i = 0; i <= count; ++i) poses.push_back(poseOnPivots(axis, pivots, first + i * step));
  if (first + count * step < last) poses.push_back(poseOnPivots(axis, pivots, last));
  return poses;
}

} // namespace pcl_bsh
