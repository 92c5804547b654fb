// SPDX-License-Identifier: BSD-3-Clause
// Lines whose truth is known, by other means than the axis' own: integrals in long double, by Gauss and Legendre.
#pragma once

#include <pcl_bsh/track/axis.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace pcl_bsh::test {

struct TrueFrame {
  long double x, y, heading;
};

/// Position and heading at a distance, from the elements alone.
inline TrueFrame trueFrameAt(const std::vector<PlanElement>& plan, long double distance)
{
  constexpr std::array<long double, 5> nodes = {
      0.0L, 0.538469310105683091036314420700208805L, -0.538469310105683091036314420700208805L,
      0.906179845938663992797626878299392965L, -0.906179845938663992797626878299392965L};
  constexpr std::array<long double, 5> weights = {
      0.568888888888888888888888888888888889L, 0.478628670499366468041291514835638193L,
      0.478628670499366468041291514835638193L, 0.236926885056189087514264040719917363L,
      0.236926885056189087514264040719917363L};
  const AxisStart& start = *plan.front().start;
  TrueFrame at{start.x, start.y, start.heading};
  for (const PlanElement& element : plan) {
    const long double length = std::min<long double>(distance, element.length);
    const long double k = element.curvature_begin,
                      c = (element.curvature_end - k) / static_cast<long double>(element.length);
    const auto headingAt = [&](long double t) { return at.heading - t * (k + 0.5L * c * t); };
    const int steps = 400;
    long double x = 0, y = 0;
    for (int i = 0; i < steps; ++i)
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        const long double t = length / steps * (static_cast<long double>(i) + 0.5L + 0.5L * nodes[n]);
        x += weights[n] * std::cos(headingAt(t));
        y += weights[n] * std::sin(headingAt(t));
      }
    at = {at.x + x * length / (2 * steps), at.y + y * length / (2 * steps), headingAt(length)};
    distance -= length;
    if (distance <= 0) break;
  }
  return at;
}

/// Straight, clothoid, arc to the right, clothoid, straight.
inline std::vector<PlanElement> curve(const AxisStart& start, double radius = 300)
{
  const double k = 1 / radius;
  return {{80, 0, 0, start}, {60, 0, k}, {120, k, k}, {60, k, 0}, {80, 0, 0}};
}

/// An S of two arcs with a radius of 60, and clothoids between them.
inline std::vector<PlanElement> sCurve(const AxisStart& start)
{
  const double k = 1.0 / 60;
  return {{20, 0, 0, start}, {30, 0, k}, {60, k, k}, {60, k, -k}, {60, -k, -k}, {30, -k, 0}, {20, 0, 0}};
}

/// Two straights, 16 apart, and the half circle between them.
inline std::vector<PlanElement> hairpin(const AxisStart& start)
{
  return {{100, 0, 0, start}, {std::numbers::pi * 8, 1.0 / 8, 1.0 / 8}, {100, 0, 0}};
}

} // namespace pcl_bsh::test
