// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/geometry/rounding.h>
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

double apart(const Point3& p, const Point3& q)
{
  const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
  const double squared = x * x + y * y + z * z;
  return std::isnormal(squared) ? std::sqrt(squared) : std::hypot(x, y, z); // squares leave the range of doubles early
}

/// The middle of the smallest ball: that of the longest side where the triangle is not acute, else its circumcentre.
Point3 middleOf(const std::array<Point3, 3>& corners)
{
  const double a = apart(corners[1], corners[2]), b = apart(corners[2], corners[0]), c = apart(corners[0], corners[1]);
  const double longest = std::max({a, b, c});
  // Shares of the longest side, so that no square overflows.
  const double unit = longest > 0.0 ? 1.0 / longest : 0.0;
  const double aa = a * unit * a * unit, bb = b * unit * b * unit, cc = c * unit * c * unit;
  std::array<double, 3> weights = {aa * (bb + cc - aa), bb * (cc + aa - bb), cc * (aa + bb - cc)};
  if (!(std::min({weights[0], weights[1], weights[2]}) > 0.0)) {
    weights = {1.0, 1.0, 1.0};
    weights[a == longest ? 0 : b == longest ? 1 : 2] = 0.0; // the corner that faces it
  }
  Point3 middle;
  const double sum = weights[0] + weights[1] + weights[2];
  for (std::size_t k = 0; k < 3; ++k)
    middle[k] =
        corners[0][k] * (weights[0] / sum) + corners[1][k] * (weights[1] / sum) + corners[2][k] * (weights[2] / sum);
  return middle;
}

template <class Coordinate>
Coordinate rounded(double x)
{
  if constexpr (std::is_same_v<Coordinate, float>)
    return roundToFloat(x);
  else
    return x;
}

/// How far a middle may be from its triangle, as a share of the largest coordinate: a sum of corners, whose weights add
/// up to 1 within a few roundings, on each axis, then rounded to a coordinate.
template <class Coordinate>
inline constexpr double kOffMiddle = 2 * ((std::is_same_v<Coordinate, float> ? kFloatUnit : 0.0) + 16 * kDoubleUnit);

/// The balls of all triangles, and what their view refers to.
template <class Coordinate>
struct Balls {
  TrianglesView triangles;
  std::vector<std::array<Coordinate, 3>> centers;
  std::vector<float> radii;
};

template <class Coordinate>
PointsView ballsOf(const TrianglesView& triangles, Scalar scalar)
{
  auto balls = std::make_shared<Balls<Coordinate>>();
  balls->triangles = triangles;
  balls->centers.resize(triangles.count);
  balls->radii.resize(triangles.count);
  double largest = 0.0;
  for (std::size_t i = 0; i < triangles.count; ++i) {
    const std::array<Point3, 3> corners = triangles.triangle(static_cast<std::uint32_t>(i));
    std::array<Coordinate, 3>& center = balls->centers[i];
    if (!std::all_of(corners.begin(), corners.end(), isFinite)) {
      center.fill(std::numeric_limits<Coordinate>::quiet_NaN());
      continue;
    }
    const Point3 middle = middleOf(corners);
    for (std::size_t k = 0; k < 3; ++k) center[k] = rounded<Coordinate>(middle[k]);
    const Point3 stored = {double{center[0]}, double{center[1]}, double{center[2]}};
    double radius = 0.0;
    for (const Point3& corner : corners) {
      radius = std::max(radius, apart(stored, corner));
      for (const double x : corner) largest = std::max(largest, std::abs(x));
    }
    balls->radii[i] = roundUp(radius * (1.0 + kFewDoubleRoundings));
    if (!std::isfinite(balls->radii[i]))
      throw InvalidInput(Input::surface, kName, "triangle " + std::to_string(i) + " is too large for a float32 radius",
                         "give coordinates below 1e38")
          .withIndex(i);
  }
  PointsView view;
  view.data = balls->centers.data();
  view.count = triangles.count;
  view.stride = 3 * sizeof(Coordinate);
  view.offset = {0, sizeof(Coordinate), 2 * sizeof(Coordinate)};
  view.scalar = scalar;
  view.radii = balls->radii.data();
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
