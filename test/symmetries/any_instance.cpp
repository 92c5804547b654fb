// SPDX-License-Identifier: BSD-3-Clause
#include "instance.h"

#include "fuzz/changing_cloud.h"

#include <pcl_bsh/geometry/exact_distance.h>

#include <algorithm>

namespace pcl_bsh::symmetries {
namespace {

using test::Random;

Body anyBody(const std::vector<Point3>& points, double unit, Random& random)
{
  Body body;
  body.points = points;
  body.scalar = random.chance(0.5) ? Scalar::float64 : Scalar::float32;
  roundTo(body.scalar, body.points);
  if (random.chance(0.1)) test::spoil(body.points, random);
  const auto lengths = [&] {
    std::vector<float> made(points.size());
    for (float& length : made) length = static_cast<float>(random.chance(0.3) ? 0.0 : unit / 64 * random.integer(0, 8));
    return made;
  };
  const bool told = unit > 0x1p-100 && unit < 0x1p100; // lengths that floats hold
  if (told && random.chance(0.2)) body.radii = lengths();
  if (told && random.chance(0.2)) body.uncertainties = lengths();
  return body;
}

} // namespace

Instance anyInstance(fuzz::Bytes& bytes, const std::string& name)
{
  const fuzz::World world(bytes);
  Random random(bytes.take<std::uint64_t>());
  const double unit = world.unit;
  const auto places = [&] {
    std::vector<Point3> points(
        static_cast<std::size_t>(random.chance(0.2) ? random.integer(0, 3) : random.integer(4, 100)));
    for (Point3& p : points) p = world.place(random);
    return points;
  };
  Instance made;
  made.name = name + " of a " + world.text();
  made.a = anyBody(places(), unit, random);
  made.b = anyBody(places(), unit, random);
  made.a.pose = world.pose(random);
  made.b.pose = world.pose(random);
  for (int i = random.integer(1, 4); i > 0; --i) {
    made.path.push_back(world.pose(random));
    made.relative.push_back(world.pose(random));
  }
  const test::Cloud a = made.a.cloud(), b = made.b.cloud();
  made.clearance = random.chance(0.5) ? test::tiedClearance(a.view(), made.a.pose, b.view(), made.b.pose, random)
                                      : unit / 16 * random.integer(0, 8);
  made.tolerance = unit > 0x1p-90 && unit < 0x1p90 ? unit / 16 : 0.0;
  for (std::size_t i = 1; i < made.path.size(); ++i) // half a turn is refused
    if ((made.path[i - 1].linear().transpose() * made.path[i].linear()).trace() < -0.999) made.tolerance = 0.0;
  addFaces(made, unit, random);
  for (int i = 0; i < 6; ++i) made.queries.push_back(world.place(random));
  made.low = made.high = made.queries.front();
  for (const Point3& query : made.queries)
    for (std::size_t k = 0; k < 3; ++k) {
      made.low[k] = std::min(made.low[k], query[k]);
      made.high[k] = std::max(made.high[k], query[k]);
    }
  made.threads = static_cast<unsigned>(random.integer(1, 3));
  return made;
}

} // namespace pcl_bsh::symmetries
