// SPDX-License-Identifier: BSD-3-Clause
#include "link_body.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace pcl_bsh::self_filter {
namespace {

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

Rod around(const Capsule& pill)
{
  return {2, pill.radius, enclosingRadius(pill)};
}

} // namespace

Rod rodAround(const Solid& solid)
{
  return std::visit([](const auto& form) { return around(form); }, solid);
}

void requireSize(const Solid& solid)
{
  constexpr double most = 1e30;
  constexpr const char* names[] = {"a box", "a cylinder", "a sphere", "a capsule"};
  for (const double size : sizesOf(solid))
    if (!(size > 0.0 && size <= most))
      throw std::runtime_error(std::string(names[solid.index()]) + " of size " + std::to_string(size) +
                               ": give one above 0" + (size > most ? ", and at most 1e30 m" : ""));
}

} // namespace pcl_bsh::self_filter
