// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/surface/surface_cover.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/coordinate_spacing.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/surface/charts.h>
#include <pcl_bsh/surface/hexagons.h>
#include <pcl_bsh/surface/piece_ball.h>
#include <pcl_bsh/surface/unite.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {

namespace {

using namespace surface;

constexpr double kMostBalls = 2147483647.0;
/// The area of a hexagon whose corners lie on the unit circle.
const double kHexagon = 1.5 * std::sqrt(3.0);

/// Roundings from a vertex to a piece and to a ball, all at the extent of the mesh: three of a vertex and its place in
/// the plane, at most nine cuts of seven each, a tenth of that for a plane's axes that are not quite orthonormal, and
/// twice that for what pieces overlap.
constexpr double kExtentError = 512 * kDoubleUnit;
constexpr double kPlaceError = 2 * kDoubleUnit; ///< of a centre in the caller's frame
constexpr double kLeastTolerance = 64;          ///< in errors: then rounding takes a thirtieth of the room
/// A radius is rounded up to a float.
constexpr double kRadiusMargin = 0x1p-22;

[[noreturn]] void refuse(std::string wrong, std::string remedy, double value)
{
  throw InvalidInput(Input::surface, "surface", std::move(wrong), std::move(remedy)).withValue(value);
}

void checkTriangles(const PointsView& vertices, const std::vector<Triangle>& triangles)
{
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t record : triangles[t]) {
      const bool exists = record < vertices.count;
      if (exists && isFinite(vertices.point(record))) continue;
      const std::string wrong = exists ? plainText("vertex ", record, " of triangle ", t, " is not finite")
                                       : plainText("triangle ", t, " names vertex ", record, " of ", vertices.count);
      throw InvalidInput(Input::surface, "surface", wrong, "leave the triangle out, or mend the mesh").withIndex(t);
    }
  }
}

Mesh meshOf(const PointsView& vertices, const std::vector<Triangle>& triangles, double tolerance)
{
  if (!(tolerance >= std::numeric_limits<float>::min() && tolerance <= 0.5 * std::numeric_limits<float>::max())) {
    refuse(plainText("tolerance ", tolerance, " is not a length above 0"),
           "give the length by which balls may stick out", tolerance);
  }
  checkTriangles(vertices, triangles);
  Mesh mesh{triangles, Vector3d::Zero(), {}};
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  const auto at = [&](std::uint32_t record) {
    const Point3 p = vertices.point(record);
    return Vector3d(p[0], p[1], p[2]);
  };
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t record : triangle) {
      const Vector3d p = at(record);
      low = low.cwiseMin(p), high = high.cwiseMax(p);
      mesh.magnitude = std::max(mesh.magnitude, p.cwiseAbs().maxCoeff());
    }
  }
  if (!triangles.empty()) mesh.middle = 0.5 * low + 0.5 * high;
  mesh.vertices.assign(vertices.count, Vector3d::Zero());
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t record : triangle) mesh.vertices[record] = at(record) - mesh.middle;
  for (const Vector3d& p : mesh.vertices) mesh.extent = std::max(mesh.extent, p.cwiseAbs().maxCoeff());
  mesh.error = kExtentError * mesh.extent + kPlaceError * mesh.magnitude;
  if (!(tolerance >= kLeastTolerance * mesh.error)) {
    refuse(plainText("tolerance ", tolerance, " is too small for coordinates up to ", mesh.magnitude),
           plainText("give at least ", kLeastTolerance * mesh.error, ", or move the mesh to the origin"), tolerance);
  }
  mesh.room = tolerance * (1 - kRadiusMargin) - 2 * mesh.error;
  return mesh;
}

void checkCount(const Mesh& mesh, double area, double tolerance)
{
  double border = 0.0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners c = mesh.corners(t);
    border += (c[1] - c[0]).norm() + (c[2] - c[1]).norm() + (c[0] - c[2]).norm();
  }
  const double balls = area / (kHexagon * mesh.room * mesh.room) + border / (2 * mesh.room);
  if (balls <= kMostBalls) return;
  const double enough = tolerance * std::max(std::sqrt(balls / kMostBalls), balls / kMostBalls);
  refuse(plainText("tolerance ", tolerance, " would take some ", balls, " balls, and 2147483647 are possible"),
         plainText("give at least ", enough), tolerance);
}

class Covering {
public:
  Covering(const Mesh& mesh, const SurfaceRequest& request)
  : mesh_(mesh),
    request_(request),
    progress_(request.progress)
  {
    cover_.tolerance = request.tolerance;
    cover_.triangle_count = mesh.triangles.size();
    cover_.triangles_apart = request.triangles_apart;
  }

  SurfaceCover operator()()
  {
    std::vector<double> areas(mesh_.triangles.size());
    for (std::uint32_t t = 0; t < areas.size(); ++t) cover_.area += areas[t] = areaOf(mesh_.corners(t));
    checkCount(mesh_, cover_.area, request_.tolerance);
    progress_.begin(0.9, mesh_.triangles.size());
    if (request_.triangles_apart) {
      for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        addChart(chartOf(mesh_, t));
        addPatches();
      }
    }
    else {
      for (const Chart& chart : growCharts(mesh_, areas)) addChart(chart);
      unite(mesh_, corners_, patches_);
      addPatches();
    }
    progress_.end();
    return std::move(cover_);
  }

private:
  void addChart(const Chart& chart)
  {
    Division division = divide(mesh_, chart, corners_);
    for (const WholeHexagon& hexagon : division.whole) addBall(hexagon.center, hexagon.radius, hexagon.triangle);
    for (Patch& patch : division.patches) {
      fitBall(corners_, patch);
      if (patch.radius <= mesh_.room) {
        patches_.push_back(std::move(patch));
      }
      else { // a chart that folds over itself or has a hole here, or a triangle that stands on its plane
        for (const Piece& piece : patch.pieces) halveUntilHeld(mesh_, piece, corners_, patches_);
      }
    }
    progress_.tick(division.whole.size() + 8 * division.patches.size(), chart.triangles.size());
  }

  void addPatches()
  {
    for (const Patch& patch : patches_) addBall(patch.center, patch.radius, patch.triangle);
    patches_.clear();
    corners_.clear();
  }

  void addBall(const Vector3d& center, double radius, std::uint32_t triangle)
  {
    const Vector3d place = mesh_.middle + center;
    cover_.centers.push_back({place.x(), place.y(), place.z()});
    cover_.radii.push_back(roundUp(radius + mesh_.error));
    cover_.triangles.push_back(triangle);
  }

  const Mesh& mesh_;
  const SurfaceRequest& request_;
  Progress progress_;
  SurfaceCover cover_;
  std::vector<Vector3d> corners_; ///< of the patches' pieces
  std::vector<Patch> patches_;
};

/// Those that are finite.
std::size_t looseVertices(const PointsView& vertices, const std::vector<Triangle>& triangles)
{
  std::vector<bool> named(vertices.count, false);
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t record : triangle) named[record] = true;
  std::size_t loose = 0;
  for (std::uint32_t i = 0; i < vertices.count; ++i)
    if (!named[i] && isFinite(vertices.point(i))) ++loose;
  return loose;
}

} // namespace

PointsView SurfaceCover::view() const noexcept
{
  PointsView balls = viewOf(centers.empty() ? nullptr : centers[0].data(), centers.size());
  balls.radii = radii.data();
  return balls;
}

double SurfaceCover::hexagonalOptimum() const noexcept
{
  return area / (kHexagon * tolerance * tolerance);
}

SurfaceCover coverSurface(const PointsView& vertices, const std::vector<Triangle>& triangles,
                          const SurfaceRequest& request)
{
  const DefaultFloatEnvironment environment;
  const Mesh mesh = meshOf(vertices, triangles, request.tolerance);
  SurfaceCover cover = Covering(mesh, request)();
  cover.loose = looseVertices(vertices, triangles);
  if (vertices.scalar == Scalar::float32) cover.coordinate_spacing = float32Spacing(mesh.magnitude);
  return cover;
}

} // namespace pcl_bsh
