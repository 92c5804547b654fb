// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/scenes/scene_clouds.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace pcl_bsh::io {
namespace {

using Place = Eigen::Vector3d;

std::vector<Place> placesOf(const std::vector<float>& xyz)
{
  std::vector<Place> places;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) places.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  return places;
}

double nearest(const std::vector<Place>& places, const Place& at)
{
  double least = std::numeric_limits<double>::infinity();
  for (const Place& place : places) least = std::min(least, (place - at).norm());
  return least;
}

TEST(ShapePoints, LieOnTheirSurfaces)
{
  const auto each = [](const std::vector<float>& xyz, const auto& check) {
    ASSERT_GT(xyz.size(), 30u);
    for (std::size_t i = 0; i < xyz.size(); i += 3) check(Eigen::Vector3d(xyz[i], xyz[i + 1], xyz[i + 2]));
  };
  each(shapePoints("sphere", {2, 2, 2}, 0.3), [](const Eigen::Vector3d& p) { EXPECT_NEAR(p.norm(), 2, 1e-5); });
  each(shapePoints("box", {1, 2, 3}, 0.3), [](const Eigen::Vector3d& p) {
    const Eigen::Array3d inside = Eigen::Array3d(0.5, 1, 1.5) - p.array().abs();
    EXPECT_NEAR(inside.minCoeff(), 0, 1e-5);
  });
  each(shapePoints("cylinder", {1, 2, 0}, 0.3),
       [](const Eigen::Vector3d& p) { EXPECT_NEAR(std::min(1 - p.head<2>().norm(), 1 - std::abs(p.z())), 0, 1e-5); });
  each(shapePoints("sphere", {1e30, 0, 0}, 5e29), [](const Eigen::Vector3d& p) { EXPECT_NEAR(p.norm(), 1e30, 1e24); });
  each(shapePoints("sphere", {1e-30, 0, 0}, 5e-31),
       [](const Eigen::Vector3d& p) { EXPECT_NEAR(p.norm(), 1e-30, 1e-36); });
  for (const char* shape : {"sphere", "box", "cylinder"}) {
    const auto count = static_cast<double>(shapePoints(shape, {1, 2, 3}, 0.1).size() / 3);
    EXPECT_LE(count, 2 * shapePointCount(shape, {1, 2, 3}, 0.1));
  }
}

/// As many above as below, and the nearest to either pole as near.
TEST(ShapePoints, OfASphereAreEvenlySpread)
{
  double sum = 0.0, low = 0.0, high = 0.0;
  for (const Place& place : placesOf(shapePoints("sphere", {2, 2, 2}, 0.3))) {
    sum += place.z();
    low = std::min(low, place.z()), high = std::max(high, place.z());
  }
  EXPECT_NEAR(sum, 0.0, 1e-3);
  EXPECT_NEAR(low, -high, 1e-5);
}

/// No place of a surface is far from all points: nothing passes between them that is larger than the spacing.
TEST(ShapePoints, CoverTheirSurfaces)
{
  constexpr double pi = 3.14159265358979323846, spacing = 0.1;
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto covers = [&](const std::string& shape, const Place& size, const std::function<Place()>& anywhere) {
    SCOPED_TRACE(shape);
    const std::vector<Place> places = placesOf(shapePoints(shape, size, spacing));
    for (int i = 0; i < 400; ++i) {
      const Place at = anywhere();
      EXPECT_LE(nearest(places, at), 0.95 * spacing) << at.transpose();
    }
  };
  covers("sphere", {0.7, 0.7, 0.7},
         [&] { return Place(0.7 * Place(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized()); });
  covers("box", {0.5, 1, 1.5}, [&] {
    Place at(uniform(-0.25, 0.25), uniform(-0.5, 0.5), uniform(-0.75, 0.75));
    const int face = static_cast<int>(uniform(0, 3));
    at[face] = (uniform(-1, 1) < 0 ? -0.25 : 0.25) * (face + 1);
    return at;
  });
  const auto mantle = [&] {
    const double angle = uniform(0, 2 * pi);
    return Place(0.6 * std::cos(angle), 0.6 * std::sin(angle), uniform(-0.45, 0.45));
  };
  covers("cylinder", {0.6, 0.9, 1}, mantle);
  covers("cylinder", {0.6, 0.9, 0}, [&] {
    if (uniform(0, 1) < 0.5) return mantle();
    const double r = 0.6 * std::sqrt(uniform(0, 1)), angle = uniform(0, 2 * pi);
    return Place(r * std::cos(angle), r * std::sin(angle), uniform(-1, 1) < 0 ? -0.45 : 0.45);
  });
}

/// They are no more than the spacing asks for: no two are much nearer than that, and their number is what was told.
TEST(ShapePoints, AreNoMoreThanTheSpacingAsksFor)
{
  constexpr double spacing = 0.1;
  const std::vector<Place> ball = placesOf(shapePoints("sphere", {0.7, 0.7, 0.7}, spacing));
  for (std::size_t i = 0; i < ball.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) ASSERT_GT((ball[i] - ball[j]).norm(), 0.5 * spacing) << i << ' ' << j;
  EXPECT_EQ(shapePoints("box", {0.5, 1, 1.5}, 0.5).size() / 3, 2u * 3 * 4) << "all of 1 x 2 x 3 cells' corners";
  EXPECT_EQ(shapePoints("box", {1.5, 1.5, 1.5}, 0.5).size() / 3, 64u - 8) << "but those inside";
  for (const char* shape : {"sphere", "box", "cylinder"}) {
    const Place size(20, 30, 0);
    const Place sides = shape[0] == 'b' ? Place(20, 30, 40) : size;
    const auto count = static_cast<double>(shapePoints(shape, sides, 0.5).size() / 3);
    EXPECT_LE(count, shapePointCount(shape, sides, 0.5)) << shape;
    EXPECT_GE(count, 0.75 * shapePointCount(shape, sides, 0.5)) << shape;
  }
}

TEST(ShapePoints, OfAnOpenCylinderHasNoLids)
{
  const std::vector<Place> open = placesOf(shapePoints("cylinder", {1, 2, 1}, 0.25));
  for (const Place& place : open) EXPECT_NEAR(place.head<2>().norm(), 1, 1e-6);
  EXPECT_EQ(open.size(), 26u * 9) << "rings of 26, a quarter apart";
  const std::vector<Place> closed = placesOf(shapePoints("cylinder", {1, 2, 0}, 0.25));
  std::size_t within = 0;
  for (const Place& place : closed) within += place.head<2>().norm() < 0.99 ? 1u : 0u;
  EXPECT_EQ(closed.size(), open.size() + within) << "the rims are the mantle's";
  EXPECT_EQ(within, 2u * (1 + 7 + 13 + 19)) << "rings of a quarter's radius more each, in both lids";
}

/// A larger shape would have too many points to be made.
TEST(ShapePoints, AreAsManyAsToldBefore)
{
  constexpr double pi = 3.14159265358979323846;
  EXPECT_DOUBLE_EQ(shapePointCount("sphere", {1, 2, 3}, 1), 4 * pi * 9);
  EXPECT_DOUBLE_EQ(shapePointCount("box", {1, 2, 3}, 1), 2 * (3 * 4 + 4 * 5 + 3 * 5));
  EXPECT_DOUBLE_EQ(shapePointCount("cylinder", {1, 2, 3}, 1), 2 * pi * 3 * (4 + 3));
  EXPECT_DOUBLE_EQ(shapePointCount("box", {1, 2, 3}, 0.5), 2 * (4 * 6 + 6 * 8 + 4 * 8));
}

} // namespace
} // namespace pcl_bsh::io
