// SPDX-License-Identifier: BSD-3-Clause
#include "link_body.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace pcl_bsh::self_filter {
namespace {

double distance(const Box& box, const Eigen::Vector3d& p)
{
  return (p.cwiseAbs() - 0.5 * box.size).cwiseMax(0.0).norm();
}

double distance(const Cylinder& tube, const Eigen::Vector3d& p)
{
  const double out = p.head<2>().norm() - tube.radius, over = std::abs(p.z()) - tube.length / 2;
  return std::hypot(std::max(out, 0.0), std::max(over, 0.0));
}

double distance(const Sphere& ball, const Eigen::Vector3d& p)
{
  return std::max(p.norm() - ball.radius, 0.0);
}

Rod around(const Box& box)
{
  Rod rod;
  rod.half_length = 0.5 * box.size.maxCoeff(&rod.axis);
  rod.radius = 0.5 * std::hypot(box.size[(rod.axis + 1) % 3], box.size[(rod.axis + 2) % 3]);
  return rod;
}

Rod around(const Cylinder& tube)
{
  return {2, tube.radius, tube.length / 2};
}

Rod around(const Sphere& ball)
{
  return {2, ball.radius, 0.0};
}

void require(double size, const char* what)
{
  constexpr double most = 1e30;
  if (!(size > 0.0 && size <= most))
    throw std::runtime_error(std::string(what) + " of size " + std::to_string(size) + ": give one above 0" +
                             (size > most ? ", and at most 1e30 m" : ""));
}

void requireSizes(const Box& box)
{
  for (int k = 0; k < 3; ++k) require(box.size[k], "a box");
}

void requireSizes(const Cylinder& tube)
{
  for (const double size : {tube.radius, tube.length}) require(size, "a cylinder");
}

void requireSizes(const Sphere& ball)
{
  require(ball.radius, "a sphere");
}

} // namespace

double distanceTo(const Solid& solid, const Eigen::Vector3d& point)
{
  return std::visit([&](const auto& form) { return distance(form, point); }, solid);
}

Rod rodAround(const Solid& solid)
{
  return std::visit([](const auto& form) { return around(form); }, solid);
}

void requireSize(const Solid& solid)
{
  std::visit([](const auto& form) { requireSizes(form); }, solid);
}

} // namespace pcl_bsh::self_filter
