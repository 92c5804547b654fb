// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/large_buffer.h>
#include <pcl_bsh/geometry/distance_between.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/triangle/vector3.h>
#include <pcl_bsh/hierarchy/triangle_balls.h>
#include <pcl_bsh/hierarchy/view_check.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr auto kName = "triangles";

/// Squares of the sides that face the corners, as shares of the longest one's.
std::array<double, 3> sharesOf(const std::array<Point3, 3>& corners)
{
  std::array<double, 3> sides;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 side = corners[(i + 1) % 3] - corners[(i + 2) % 3];
    sides[i] = dot(side, side);
  }
  double longest = std::max({sides[0], sides[1], sides[2]});
  if (!std::isnormal(longest)) { // squares leave the range of doubles early
    for (std::size_t i = 0; i < 3; ++i) sides[i] = distanceBetween(corners[(i + 1) % 3], corners[(i + 2) % 3]);
    longest = std::max({sides[0], sides[1], sides[2]});
    const double unit = longest > 0.0 ? 1.0 / longest : 0.0;
    for (double& side : sides) side *= side * unit * unit;
    return sides;
  }
  const double unit = 1.0 / longest;
  for (double& side : sides) side *= unit;
  return sides;
}

/// The middle of the smallest ball: that of the longest side where the triangle is not acute, else its circumcentre.
Point3 middleOf(const std::array<Point3, 3>& corners)
{
  const auto [aa, bb, cc] = sharesOf(corners);
  std::array<double, 3> weights = {aa * (bb + cc - aa), bb * (cc + aa - bb), cc * (aa + bb - cc)};
  if (!(std::min({weights[0], weights[1], weights[2]}) > 0x1p-900)) { // nor so thin that shares leave the range
    weights = {1.0, 1.0, 1.0};
    const double longest = std::max({aa, bb, cc});
    weights[aa == longest ? 0 : bb == longest ? 1 : 2] = 0.0; // the corner that faces it
  }
  Point3 middle;
  const double unit = 1.0 / (weights[0] + weights[1] + weights[2]);
  for (double& weight : weights) weight *= unit;
  for (std::size_t k = 0; k < 3; ++k)
    middle[k] = corners[0][k] * weights[0] + corners[1][k] * weights[1] + corners[2][k] * weights[2];
  return middle;
}

/// How far the farthest corner is from a place.
double reachFrom(const Point3& place, const std::array<Point3, 3>& corners)
{
  double most = 0.0;
  for (const Point3& corner : corners) {
    const Point3 way = corner - place;
    most = std::max(most, dot(way, way));
  }
  if (std::isnormal(most)) return std::sqrt(most);
  return std::max(
      {distanceBetween(place, corners[0]), distanceBetween(place, corners[1]), distanceBetween(place, corners[2])});
}

template <class Coordinate>
Coordinate rounded(double x)
{
  if constexpr (std::is_same_v<Coordinate, float>)
    return roundToFloat(x);
  else
    return x;
}

/// How far a middle may be from its triangle, as a share of the largest coordinate. On each axis it is a sum of
/// corners, whose weights add up to 1 within a few roundings, rounded to a coordinate.
template <class Coordinate>
inline constexpr double kOffMiddle = 2 * ((std::is_same_v<Coordinate, float> ? kFloatUnit : 0.0) + 16 * kDoubleUnit);

/// The balls of all triangles, and what their view refers to.
template <class Coordinate>
struct Balls {
  TrianglesView triangles;
  LargeBuffer<std::array<Coordinate, 3>> centers;
  LargeBuffer<float> radii;
};

/// Makes the ball of triangle i. @param largest raised to its largest coordinate
template <class Coordinate>
void ballOf(Balls<Coordinate>& balls, std::size_t i, double& largest)
{
  const std::array<Point3, 3> corners = balls.triangles.triangle(static_cast<std::uint32_t>(i));
  std::array<Coordinate, 3>& center = balls.centers[i];
  if (!std::all_of(corners.begin(), corners.end(), isFinite)) {
    center.fill(std::numeric_limits<Coordinate>::quiet_NaN());
    balls.radii[i] = 0.0f;
    return;
  }
  const Point3 middle = middleOf(corners);
  for (std::size_t k = 0; k < 3; ++k) center[k] = rounded<Coordinate>(middle[k]);
  const Point3 stored = {double{center[0]}, double{center[1]}, double{center[2]}};
  for (const Point3& corner : corners)
    for (const double x : corner) largest = std::max(largest, std::abs(x));
  balls.radii[i] = roundUp(reachFrom(stored, corners) * (1.0 + kFewDoubleRoundings));
  if (!std::isfinite(balls.radii[i]))
    throw InvalidInput(Input::surface, kName, "triangle " + std::to_string(i) + " is too large for a float32 radius",
                       "give coordinates below 1e38")
        .withIndex(i);
}

/// Makes the balls of the triangles from `first` on.
template <class Coordinate>
void eightBallsOf(Balls<Coordinate>& balls, std::size_t first, double& largest)
{
  EightBalls eight;
  for (std::size_t i = 0; i < kBallsTogether; ++i) {
    const std::array<Point3, 3> corners = balls.triangles.triangle(static_cast<std::uint32_t>(first + i));
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 3; ++k) eight.corners[c][k][i] = corners[c][k];
  }
  findEightBalls(eight, std::is_same_v<Coordinate, float>);
  largest = std::max(largest, eight.largest);
  for (std::size_t i = 0; i < kBallsTogether; ++i) {
    for (std::size_t k = 0; k < 3; ++k) balls.centers[first + i][k] = static_cast<Coordinate>(eight.centers[k][i]);
    balls.radii[first + i] = eight.radii[i];
    if (!std::isfinite(eight.radii[i])) ballOf(balls, first + i, largest);
  }
}

template <class Coordinate>
PointsView ballsOf(const TrianglesView& triangles, Scalar scalar)
{
  auto balls = std::make_shared<Balls<Coordinate>>();
  balls->triangles = triangles;
  balls->centers = makeBuffer<std::array<Coordinate, 3>>(triangles.count);
  balls->radii = makeBuffer<float>(triangles.count);
  double largest = 0.0;
  std::size_t i = 0;
  for (; i + kBallsTogether <= triangles.count; i += kBallsTogether) eightBallsOf(*balls, i, largest);
  for (; i < triangles.count; ++i) ballOf(*balls, i, largest);
  PointsView view;
  view.data = balls->centers.get();
  view.count = triangles.count;
  view.stride = 3 * sizeof(Coordinate);
  view.offset = {0, sizeof(Coordinate), 2 * sizeof(Coordinate)};
  view.scalar = scalar;
  view.radii = balls->radii.get();
  view.uncertainty = triangles.vertices.uncertainty;
  view.triangles = &balls->triangles;
  constexpr double vanishing = std::numeric_limits<Coordinate>::denorm_min();
  view.off_middle = kOffMiddle<Coordinate> * largest + 4 * vanishing;
  view.owner = std::move(balls);
  return view;
}

} // namespace

TrianglesView trianglesOf(const PointsView& vertices, std::shared_ptr<const std::vector<Triangle>> triangles)
{
  TrianglesView view{vertices, triangles->empty() ? nullptr : triangles->front().data(), triangles->size()};
  view.vertices.owner = std::make_shared<const std::pair<std::shared_ptr<const void>, std::shared_ptr<const void>>>(
      vertices.owner, std::move(triangles));
  return view;
}

std::size_t looseVertices(const TrianglesView& triangles)
{
  std::vector<bool> named(triangles.vertices.count);
  for (std::size_t i = 0; i < triangles.count; ++i)
    for (const std::uint32_t corner : triangles.cornersOf(static_cast<std::uint32_t>(i))) named[corner] = true;
  std::size_t loose = 0;
  for (std::size_t i = 0; i < named.size(); ++i)
    if (!named[i] && isFinite(triangles.vertices.point(static_cast<std::uint32_t>(i)))) ++loose;
  return loose;
}

PointsView middlesOf(const PointsView& view)
{
  PointsView middles = view;
  middles.triangles = nullptr;
  middles.radii = nullptr;
  middles.off_middle = 0.0;
  return middles;
}

void checkTriangles(const TrianglesView& view)
{
  const auto refuse = [](const std::string& wrong, const std::string& remedy = {}) {
    throw InvalidInput(Input::surface, kName, wrong, remedy);
  };
  checkView("vertices", view.vertices);
  if (view.vertices.indices || view.vertices.radii || view.vertices.uncertainties)
    refuse("the vertices are a subset, or have radii or uncertainties of their own", "give all of them, without");
  if (view.count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    refuse(counted(view.count, "triangle is", "triangles are") + " more than an index can name");
  if (view.count > 0 && !view.corners) refuse("corners are null, of " + counted(view.count, "triangle"));
  if (view.count > 1 && view.stride < 3 * sizeof(std::uint32_t))
    refuse("a stride of " + std::to_string(view.stride) + " bytes puts triangles over each other",
           "give the bytes from one triangle's corners to the next one's");
  for (std::size_t i = 0; i < view.count; ++i)
    for (const std::uint32_t corner : view.cornersOf(static_cast<std::uint32_t>(i)))
      if (corner >= view.vertices.count)
        throw InvalidInput(Input::surface, kName,
                           "triangle " + std::to_string(i) + " names vertex " + std::to_string(corner) + " of " +
                               std::to_string(view.vertices.count))
            .withIndex(i);
}

PointsView viewOf(const TrianglesView& triangles)
{
  checkTriangles(triangles);
  const DefaultFloatEnvironment environment;
  return triangles.vertices.scalar == Scalar::float32 ? ballsOf<float>(triangles, Scalar::float32)
                                                      : ballsOf<double>(triangles, Scalar::float64);
}

} // namespace pcl_bsh
