// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/polygon_triangles.h>

#include "support/random.h"
#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace pcl_bsh {
namespace {

using Outline = std::vector<Eigen::Vector2d>;

/// The triangles of an outline in a plane that no axis lies in.
std::vector<Triangle> cut(const Outline& outline)
{
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Point3> corners;
  for (const Eigen::Vector2d& p : outline) {
    const Eigen::Vector3d placed = turned * Eigen::Vector3d(p.x(), p.y(), 1.0);
    corners.push_back({placed.x(), placed.y(), placed.z()});
  }
  const test::Cloud vertices(corners, {Scalar::float64, 0, 0});
  std::vector<std::uint32_t> all(corners.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<Triangle> triangles;
  addTriangles(vertices.view(), all.data(), all.size(), triangles);
  return triangles;
}

double areaOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c)
{
  return 0.5 * ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
}

/// Positive where it is walked anticlockwise.
double areaOf(const Outline& outline)
{
  double area = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    area += areaOf(Eigen::Vector2d::Zero(), outline[i], outline[(i + 1) % outline.size()]);
  return area;
}

/// Walked anticlockwise, a simple polygon is covered once: all of its triangles are walked anticlockwise, and have its
/// area together. Begun at any corner, and walked the other way.
void expectCovered(const Outline& given, std::size_t starts)
{
  const double area = areaOf(given);
  for (std::size_t start = 0; start < starts; ++start) {
    for (const bool backward : {false, true}) {
      Outline outline;
      for (std::size_t i = 0; i < given.size(); ++i)
        outline.push_back(given[(start + (backward ? given.size() - i : i)) % given.size()]);
      const std::vector<Triangle> triangles = cut(outline);
      EXPECT_EQ(triangles.size(), given.size() - 2);
      double covered = 0.0;
      for (const Triangle& t : triangles) {
        const double one = (backward ? -1 : 1) * areaOf(outline[t[0]], outline[t[1]], outline[t[2]]);
        EXPECT_GE(one, -1e-12 * area);
        covered += std::abs(one);
      }
      EXPECT_NEAR(covered, area, 1e-9 * area) << "from corner " << start << (backward ? ", backward" : "");
    }
  }
}

TEST(PolygonTriangles, CoverAPolygonThatIsNotConvexOnce)
{
  expectCovered({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 6); // a fan of its first corner would cover more
  Outline comb{{20, 0}, {20, -1}, {0, -1}};
  for (int tooth = 0; tooth < 20; ++tooth) {
    comb.emplace_back(tooth + 0.3, tooth % 3 == 0 ? 4.0 : 1.0);
    comb.emplace_back(tooth + 0.6, 0.0);
  }
  if (areaOf(comb) < 0) std::reverse(comb.begin(), comb.end());
  expectCovered(comb, comb.size());
}

TEST(PolygonTriangles, CoverRandomStarsOnce)
{
  test::Random random(5);
  for (int i = 0; i < 300; ++i) {
    const int corners = random.integer(4, 24);
    Outline star;
    for (int k = 0; k < corners; ++k) {
      const double turn = 2 * M_PI * (k + random.uniform(0, 0.9)) / corners, radius = random.uniform(0.02, 1);
      star.emplace_back(radius * std::cos(turn), radius * std::sin(turn));
    }
    expectCovered(star, 3);
  }
}

TEST(PolygonTriangles, CoverAllOfAPolygonThatCrossesItself)
{
  const Outline crossed{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  double covered = 0.0;
  for (const Triangle& t : cut(crossed)) covered += std::abs(areaOf(crossed[t[0]], crossed[t[1]], crossed[t[2]]));
  EXPECT_GE(covered, 0.5);
}

bool operator==(const Triangle& t, const std::array<std::uint32_t, 3>& corners)
{
  return t[0] == corners[0] && t[1] == corners[1] && t[2] == corners[2];
}

void expectFan(const std::vector<Triangle>& triangles, std::size_t corners)
{
  ASSERT_EQ(triangles.size(), corners - 2);
  for (std::uint32_t i = 2; i < corners; ++i)
    EXPECT_TRUE((triangles[i - 2] == std::array<std::uint32_t, 3>{0, i - 1, i})) << i;
}

TEST(PolygonTriangles, AreAFanWhereNoEarIsLeft)
{
  expectFan(cut({{0, 4}, {2, 1}, {0, 0}, {1, 1}, {3, 2}}), 5);
  expectFan(cut({{3, 4}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 4}}), 6);
}

TEST(PolygonTriangles, AreAFanWhereThereIsNoArea)
{
  expectFan(cut({{2, 1}, {2, 1}, {2, 1}, {2, 1}, {2, 1}}), 5);
  const std::vector<float> line = {0, 0, 0, 3, 0, 0, 1, 0, 0, 4, 0, 0, 2, 0, 0, 5, 0, 0}; // to and fro
  const std::vector<std::uint32_t> all = {0, 1, 2, 3, 4, 5};
  std::vector<Triangle> triangles;
  addTriangles(viewOf(line.data(), 6), all.data(), all.size(), triangles);
  expectFan(triangles, 6);
}

TEST(PolygonTriangles, OfOneOrTwoCornersAreNone)
{
  EXPECT_TRUE(cut({{0, 0}}).empty());
  EXPECT_TRUE(cut({{0, 0}, {1, 0}}).empty());
}

} // namespace
} // namespace pcl_bsh
