// SPDX-License-Identifier: BSD-3-Clause
// Bundles tell how often a ray crosses triangles, and of boxes inside each other few are looked at.
#include <pcl_bsh/solid/bundles.h>

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/triangle/winding.h>
#include <pcl_bsh/solid/columns.h>
#include <pcl_bsh/solid/solid.h>

#include "meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;

/// So many copies of a few triangles, each corner of which is off by as much.
test::ClosedMesh nearCopies(Random& random, int count, double off)
{
  const test::ClosedMesh few = test::latticeMesh(2, 3, static_cast<std::uint64_t>(random.integer(1, 1000)));
  test::ClosedMesh mesh;
  for (int i = 0; i < count; ++i) {
    mesh.add(few, 1.0, {0, 0, 0}, random.chance(0.3));
    for (std::size_t k = mesh.xyz.size() - few.xyz.size(); k < mesh.xyz.size(); ++k)
      mesh.xyz[k] += random.chance(0.3) ? 0.0 : random.uniform(-off, off);
  }
  return mesh;
}

TEST(Bundles, TellCrossingsOfAllPlacesWithinAnError)
{
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  const Winding winding(identity, identity, 2);
  constexpr double offs[] = {0.0, 1e-9, 1e-3, 0.1}, errors[] = {0.0, 1e-9, 1e-3, 0.05}, sizes[] = {1.0, 1e-30, 1e15};
  Random random(1);
  int told = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const double size = random.pick(sizes);
    test::ClosedMesh mesh;
    mesh.add(nearCopies(random, random.integer(1, 20), random.pick(offs)), size);
    const TrianglesView view = mesh.view();
    std::vector<FloatBox> boxes;
    std::vector<std::uint32_t> order(view.count);
    std::iota(order.begin(), order.end(), 0u);
    for (const std::uint32_t i : order) {
      const Triangle3 t = view.triangle(i);
      FloatBox& box = boxes.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [least, most] = std::minmax({t[0][k], t[1][k], t[2][k]});
        box.low[k] = roundDown(least), box.high[k] = roundUp(most);
      }
    }
    const Bundles bundles(
        order.data(), order.data() + order.size(), [&](std::uint32_t i) { return view.triangle(i); }, boxes.data());
    for (int i = 0; i < 20; ++i) {
      Point3 at = random.point([&] { return size * random.uniform(-0.1, 1.1); });
      if (random.chance(0.3)) at[static_cast<std::size_t>(random.integer(0, 2))] = size * random.integer(0, 3) / 3.0;
      const double error = size * random.pick(errors);
      std::vector<std::uint32_t> found;
      std::uint64_t looked_at = 0;
      const int turns = bundles.collect(order.data(), at, error, found, looked_at);
      told += turns != 0;
      std::sort(found.begin(), found.end());
      ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "each once";
      for (int j = 0; j < 3; ++j) {
        Point3 place = at;
        for (double& x : place) x += random.uniform(-0.999, 0.999) * error;
        int others = 0;
        for (std::uint32_t t = 0; t < view.count; ++t) {
          if (std::binary_search(found.begin(), found.end(), t)) continue;
          const Winding::Crossing crossing = winding.crossing(place, view.triangle(t));
          ASSERT_FALSE(crossing.on_surface) << trial;
          others += crossing.turns;
        }
        ASSERT_EQ(others, turns) << trial;
      }
    }
  }
  EXPECT_GT(told, 200);
}

/// Boxes inside each other, from 1 down to an edge, about one middle.
test::ClosedMesh nestedBoxes(int count, double smallest)
{
  test::ClosedMesh mesh;
  for (int i = 0; i < count; ++i) {
    const double edge = 1.0 - (1.0 - smallest) * i / count;
    mesh.add(test::boxMesh(), edge, {-edge / 2, -edge / 2, -edge / 2});
  }
  return mesh;
}

/// Triangles and bundles that are looked at for a place, on the mean.
double lookedAt(const test::ClosedMesh& mesh)
{
  constexpr int kPlaces = 1000;
  const Columns columns(mesh.view());
  Random random(2);
  std::vector<std::uint32_t> several;
  double sum = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const Point3 at = random.point([&] { return random.uniform(-0.6, 0.6); });
    const Columns::Range above = columns.above(columns.seen(at), 0.0, several);
    sum += static_cast<double>(above.size()) + static_cast<double>(above.bundles);
  }
  return sum / kPlaces;
}

TEST(Bundles, OfBoxesInsideEachOtherAreFewHoweverManyThereAre)
{
  EXPECT_LT(lookedAt(nestedBoxes(1000, 0.1)), 200);
  EXPECT_LT(lookedAt(nestedBoxes(4000, 0.1)), 240);
}

TEST(Bundles, OfEqualBoxesAreFewHoweverManyThereAre)
{
  EXPECT_LT(lookedAt(nestedBoxes(1000, 1.0)), 60);
  EXPECT_LT(lookedAt(nestedBoxes(4000, 1.0)), 60);
}

TEST(Bundles, TakeLittleMemory)
{
  const test::ClosedMesh mesh = nestedBoxes(10000, 0.1);
  EXPECT_LT(Solid(mesh.view()).bytes(), 70 * mesh.view().count + 400000);
}

} // namespace
} // namespace pcl_bsh
