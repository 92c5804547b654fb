// SPDX-License-Identifier: BSD-3-Clause
#include "statue.h"

#include "noise.h"

#include <algorithm>

namespace pcl_bsh::bench {
namespace {

using Vector = std::array<double, 3>;

constexpr Vector kHalfAxes = {0.55, 0.65, 1.0};
constexpr double kNoise = 0.05; // of the spacing, one standard deviation

Vector cross(const Vector& a, const Vector& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector minus(const Vector& a, const Vector& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double length(const Vector& a)
{
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/// A point of the cube [-1, 1]^3's surface: face 0..5, and two coordinates on it.
Vector onCube(unsigned face, double u, double v)
{
  const double side = face % 2 == 0 ? 1.0 : -1.0;
  switch (face / 2) {
  case 0:
    return {side, u, v};
  case 1:
    return {v, side, u};
  default:
    return {u, v, side};
  }
}

Vector onStatue(unsigned face, double u, double v, std::uint64_t seed)
{
  return bench::onStatue(onCube(face, u, v), seed);
}

} // namespace

/// Each ray from the origin meets the surface once, so it is closed whatever the bumps.
std::array<double, 3> onStatue(std::array<double, 3> p, std::uint64_t seed)
{
  const double r = 1.0 / length(p);
  for (double& x : p) x *= r;
  const double swell = 1.0 + octaveNoise({p[0] + 10, p[1] + 10, p[2] + 10}, 0.8, 0.25, 6, seed);
  for (std::size_t k = 0; k < 3; ++k) p[k] *= kHalfAxes[k] * swell;
  return p;
}

Points statue(std::size_t count, std::uint64_t seed)
{
  if (count == 0) return {};
  Random random(seed);

  // The area of each lattice cell of the cube decides how many points fall into it.
  constexpr std::size_t kLattice = 192;
  constexpr double kStep = 2.0 / kLattice;
  std::vector<double> area;
  double total = 0.0;
  for (unsigned face = 0; face < 6; ++face) {
    for (std::size_t row = 0; row < kLattice; ++row) {
      for (std::size_t column = 0; column < kLattice; ++column) {
        const double u = -1.0 + (static_cast<double>(column) + 0.5) * kStep;
        const double v = -1.0 + (static_cast<double>(row) + 0.5) * kStep;
        const Vector du = minus(onStatue(face, u + kStep / 2, v, seed), onStatue(face, u - kStep / 2, v, seed));
        const Vector dv = minus(onStatue(face, u, v + kStep / 2, seed), onStatue(face, u, v - kStep / 2, seed));
        area.push_back(length(cross(du, dv)));
        total += area.back();
      }
    }
  }

  const double spacing = std::sqrt(total / static_cast<double>(count));
  Points points;
  points.reserve(count);
  double owed = 0.5; // points the area seen so far calls for
  std::size_t cell = 0;
  for (unsigned face = 0; face < 6; ++face) {
    for (std::size_t row = 0; row < kLattice; ++row) {
      for (std::size_t column = 0; column < kLattice; ++column, ++cell) {
        owed += area[cell] / total * static_cast<double>(count);
        const auto here = std::min(count - points.size(), static_cast<std::size_t>(owed));
        owed -= static_cast<double>(here);
        // A jittered lattice inside the cell keeps the spacing even when a cell holds many points.
        const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(here))));
        for (std::size_t i = 0; i < here; ++i) {
          const std::size_t slot = side * side == 0 ? 0 : i * side * side / here;
          const double du = (static_cast<double>(slot % side) + random.uniform(0.1, 0.9)) / static_cast<double>(side);
          const double dv = (static_cast<double>(slot / side) + random.uniform(0.1, 0.9)) / static_cast<double>(side);
          Vector p = onStatue(face, -1.0 + (static_cast<double>(column) + du) * kStep,
                              -1.0 + (static_cast<double>(row) + dv) * kStep, seed);
          const double stretch = 1.0 + kNoise * spacing * random.bell() / length(p);
          points.push_back({static_cast<float>(p[0] * stretch), static_cast<float>(p[1] * stretch),
                            static_cast<float>(p[2] * stretch)});
        }
      }
    }
  }
  return points;
}

} // namespace pcl_bsh::bench
