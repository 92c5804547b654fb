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

} // namespace

double rearPivotOf(const Axis& axis, double pivots, double front)
{
  const auto refuse = [&](const std::string& wrong, double value) {
    throw InvalidInput(Input::trajectory, "vehicle", wrong, "give a place where both pivots stand on the axis")
        .withValue(value);
  };
  if (!(pivots > 0.0 && std::isfinite(pivots))) refuse(plainText("its pivots are ", pivots, " apart"), pivots);
  if (!(front >= 0.0 && front <= axis.length()))
    refuse(plainText("its first pivot is at distance ", front, ", not on an axis ", axis.length(), " long"), front);
  const Eigen::Vector3d at = vectorOf(axis.frame(front).origin);
  const auto tooFar = [&](double distance) { return (at - vectorOf(axis.frame(distance).origin)).norm() - pivots; };
  double high = front, low = std::max(0.0, front - pivots);
  while (tooFar(low) < 0.0 && low > 0.0 && front - low < 4.0 * pivots) low = std::max(0.0, low - 0.1 * pivots);
  if (tooFar(low) < -1e-9)
    refuse(plainText("its second pivot, ", pivots, " behind the first at distance ", front, ", is not on the axis"),
           front);
  double below = tooFar(low), above = -pivots; // false position with halved ends (Illinois)
  for (int step = 0, side = 0; step < 100 && high - low > 1e-13; ++step) {
    const double at_zero = std::clamp((low * above - high * below) / (above - below), low, high);
    const double value = tooFar(at_zero);
    if (std::abs(value) <= 1e-14) return at_zero;
    if (value > 0.0) {
      low = at_zero;
      below = value;
      if (side > 0) above *= 0.5;
      side = 1;
    }
    else {
      high = at_zero;
      above = value;
      if (side < 0) below *= 0.5;
      side = -1;
    }
  }
  return below < -above ? low : high;
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
