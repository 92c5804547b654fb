// SPDX-License-Identifier: BSD-3-Clause
#include "instance.h"

#include <algorithm>

namespace pcl_bsh::symmetries {

test::Cloud Body::cloud() const
{
  test::Cloud made(points, {scalar});
  if (!radii.empty()) made.setRadii(radii);
  if (!uncertainties.empty()) made.setUncertainties(0.0, uncertainties);
  return made;
}

void roundTo(Scalar scalar, std::vector<Point3>& points)
{
  if (scalar == Scalar::float64) return;
  for (Point3& p : points)
    for (double& x : p) x = static_cast<double>(static_cast<float>(x));
}

void addFaces(Instance& made, double unit, test::Random& random)
{
  const auto count = static_cast<int>(made.b.points.size());
  if (count < 4 || !(unit > 0x1p-90 && unit < 0x1p90)) return; // lengths that floats hold
  const auto corner = [&] { return static_cast<std::uint32_t>(random.integer(0, count - 1)); };
  for (int i = random.integer(1, 30); i > 0; --i) made.faces.push_back({corner(), corner(), corner()});
  if (!std::all_of(made.b.points.begin(), made.b.points.end(), isFinite)) return;
  for (int i = random.integer(1, 4); i > 0; --i) {
    const std::uint32_t p = corner(), q = corner(), r = corner(), s = corner();
    made.shell.insert(made.shell.end(), {{p, q, r}, {p, s, q}, {q, s, r}, {r, s, p}});
  }
}

} // namespace pcl_bsh::symmetries
