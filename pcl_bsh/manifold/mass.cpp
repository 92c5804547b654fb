// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/manifold/mass.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/exact/nearest_double.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <array>
#include <cmath>
#include <string>

namespace pcl_bsh {
namespace {

using Exact3 = std::array<Dyadic, 3>;

/// Integrals of 1, x_k and x_k x_l over a body, times a factor each.
struct Moments {
  Dyadic whole;
  Exact3 first;
  std::array<Exact3, 3> second;         ///< for k <= l
  double of_whole, of_first, of_second; ///< the factors: small integers
};

/// The double nearest to a quotient.
double quotient(Dyadic above, Dyadic below)
{
  if (below.sign() < 0) above = -above, below = -below;
  if (above.sign() == 0) return 0.0;
  const Dyadic::Scaled n = above.scaled(), d = below.scaled();
  const double guess = std::ldexp(n.mantissa / d.mantissa, n.exponent - d.exponent);
  return nearestDouble(guess, [&](const Dyadic& x) { return (above - x * below).sign(); });
}

MassProperties propertiesOf(const Moments& of, double density)
{
  const auto times = [](const Dyadic& x, double factor) { return x * Dyadic(factor); };
  MassProperties made;
  made.mass = quotient(times(of.whole, density), Dyadic(of.of_whole));
  const Dyadic whole = times(of.whole, of.of_first);
  for (std::size_t k = 0; k < 3; ++k)
    made.center[static_cast<int>(k)] = quotient(times(of.first[k], of.of_whole), whole);
  const double squared = of.of_first * of.of_first;
  const Dyadic below = times(of.whole, of.of_second * squared);
  const auto about_center = [&](std::size_t k, std::size_t l) { // times the density and `below`
    return times(times(of.second[k][l] * of.whole, squared) -
                     times(of.first[k] * of.first[l], of.of_whole * of.of_second),
                 density);
  };
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = k; l < 3; ++l) {
      const std::size_t p = (k + 1) % 3, q = (k + 2) % 3;
      const Dyadic above = k == l ? about_center(p, p) + about_center(q, q) : -about_center(k, l);
      const auto row = static_cast<int>(k), column = static_cast<int>(l);
      made.inertia(row, column) = made.inertia(column, row) = quotient(above, below);
    }
  return made;
}

void checkDensity(double density)
{
  if (std::isfinite(density) && density > 0.0) return;
  throw InvalidInput(Input::density, "density", std::to_string(density), "give a finite one above 0")
      .withValue(density);
}

} // namespace

MassProperties massOf(const Solid& solid, double density)
{
  checkDensity(density);
  const DefaultFloatEnvironment environment;
  const TrianglesView& mesh = solid.triangles();
  Moments all{{}, {}, {}, 6, 24, 120};
  for (std::uint32_t t = 0; t < mesh.count; ++t) {
    const auto corners = mesh.triangle(t);
    if (!isFinite(Triangle3(corners))) continue;
    std::array<Exact3, 3> at;
    Exact3 sum;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) sum[k] += at[i][k] = Dyadic(corners[i][k]);
    const auto minor = [&](std::size_t k, std::size_t l) { return at[1][k] * at[2][l] - at[1][l] * at[2][k]; };
    const Dyadic volume = at[0][0] * minor(1, 2) + at[0][1] * minor(2, 0) + at[0][2] * minor(0, 1);
    all.whole += volume; // of the tetrahedron of the triangle and the origin, six times
    for (std::size_t k = 0; k < 3; ++k) {
      all.first[k] += volume * sum[k];
      for (std::size_t l = k; l < 3; ++l) {
        Dyadic products = sum[k] * sum[l];
        for (const Exact3& corner : at) products += corner[k] * corner[l];
        all.second[k][l] += volume * products;
      }
    }
  }
  if (all.whole.sign() == 0)
    throw InvalidInput(Input::surface, "solid", "its volume is 0", "give the mass and the inertia by hand");
  return propertiesOf(all, all.whole.sign() * density); // triangles may be turned inward
}

MassProperties massOf(const PointsView& balls, double density)
{
  checkDensity(density);
  const DefaultFloatEnvironment environment;
  Moments all{{}, {}, {}, 1, 1, 5};
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Point3 p = balls.point(balls.record(i));
    if (!isFinite(p)) continue;
    const Exact3 at = {Dyadic(p[0]), Dyadic(p[1]), Dyadic(p[2])};
    const Dyadic radius(balls.ownRadius(balls.record(i)));
    const Dyadic squared = radius * radius, volume = Dyadic(0x1.0c152382d7366p+2) * radius * squared; // 4 pi / 3
    all.whole += volume;
    for (std::size_t k = 0; k < 3; ++k) {
      all.first[k] += volume * at[k];
      for (std::size_t l = k; l < 3; ++l) {
        Dyadic products = Dyadic(5.0) * at[k] * at[l];
        if (k == l) products += squared;
        all.second[k][l] += volume * products;
      }
    }
  }
  if (all.whole.sign() == 0)
    throw InvalidInput(Input::radius, "balls", "none has a radius above 0", "give radii, or the mass by hand");
  return propertiesOf(all, density);
}

} // namespace pcl_bsh
