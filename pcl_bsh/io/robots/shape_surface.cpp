// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/robots/surface.h>

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>

namespace pcl_bsh::io {

namespace {

/// The number of sides of the polygon within a circle that is at most `sagitta` away from it.
std::uint32_t sidesOf(double radius, double sagitta)
{
  constexpr double most = 100'000;
  const double sides = std::ceil(std::numbers::pi / std::acos(std::max(0.5, 1.0 - sagitta / radius)));
  if (!(sides <= most))
    throw FormatError("a circle of radius " + std::to_string(radius) + " has too many sides at this tolerance",
                      "give a coarser one");
  return static_cast<std::uint32_t>(sides);
}

Surface triangulated(const robots::Box& box, double)
{
  Surface surface;
  for (int corner = 0; corner < 8; ++corner) {
    const auto at = [&](int axis) { return ((corner >> axis & 1) - 0.5) * box.size[axis]; };
    surface.vertices.push_back({at(0), at(1), at(2)});
  }
  surface.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 5, 1}, {0, 4, 5},
                       {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return surface;
}

Surface triangulated(const robots::Cylinder& tube, double sagitta)
{
  const std::uint32_t sides = sidesOf(tube.radius, sagitta);
  Surface surface;
  surface.vertices = {{0, 0, -tube.length / 2}, {0, 0, tube.length / 2}};
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    for (const double z : {-tube.length / 2, tube.length / 2})
      surface.vertices.push_back({tube.radius * std::cos(angle), tube.radius * std::sin(angle), z});
    const std::uint32_t low = 2 + 2 * i, next = 2 + 2 * ((i + 1) % sides);
    surface.triangles.insert(surface.triangles.end(),
                             {{0, next, low}, {1, low + 1, next + 1}, {low, next, next + 1}, {low, next + 1, low + 1}});
  }
  return surface;
}

Surface triangulated(const robots::Sphere& ball, double sagitta)
{
  const std::uint32_t sides = sidesOf(ball.radius, sagitta / 2); // two circles' sagittas
  const std::uint32_t rows = (sides + 1) / 2 | 1;                // odd: a capsule's tube is between the middle ones
  Surface surface;
  for (std::uint32_t row = 0; row <= rows; ++row)
    for (std::uint32_t side = 0; side < sides; ++side) {
      const double tilt = std::numbers::pi * row / rows, turn = 2 * std::numbers::pi * side / sides;
      const double across = row % rows == 0 ? 0.0 : ball.radius * std::sin(tilt); // a pole is one place: it closes
      surface.vertices.push_back({across * std::cos(turn), across * std::sin(turn), ball.radius * std::cos(tilt)});
    }
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t a = row * sides + side, b = row * sides + (side + 1) % sides;
      if (row + 1 < rows) surface.triangles.push_back({a, a + sides, b + sides});
      if (row > 0) surface.triangles.push_back({a, b + sides, b});
    }
  return surface;
}

/// Two halves of a ball and a tube between them: the upper rows of the ball are moved up, and the lower ones down.
Surface triangulated(const robots::Capsule& pill, double sagitta)
{
  Surface surface = triangulated(robots::Sphere{pill.radius}, sagitta);
  for (Point3& p : surface.vertices) p[2] += std::copysign(pill.length / 2, p[2]);
  return surface;
}

Surface triangulated(const robots::Mesh& mesh, double)
{
  Surface surface = readSurface(mesh.path);
  if (surface.triangles.empty()) throw files::FileError(mesh.path, "has no faces", "give a mesh");
  for (Point3& p : surface.vertices)
    for (std::size_t k = 0; k < 3; ++k) p[k] *= mesh.scale[static_cast<Eigen::Index>(k)];
  return surface;
}

} // namespace

void Surface::add(const Surface& more)
{
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles) triangles.push_back({first + a, first + b, first + c});
}

PointsView Surface::view() const
{
  const PointsView corners = viewOf(vertices.empty() ? nullptr : vertices[0].data(), vertices.size());
  return viewOf(TrianglesView{corners, triangles.empty() ? nullptr : triangles[0].data(), triangles.size()});
}

Surface surfaceOf(const robots::Shape& shape, double sagitta)
{
  Surface surface = std::visit([&](const auto& form) { return triangulated(form, sagitta); }, shape.form);
  for (Point3& p : surface.vertices) {
    const Eigen::Vector3d moved = shape.pose * Eigen::Vector3d(p[0], p[1], p[2]);
    p = {moved.x(), moved.y(), moved.z()};
  }
  return surface;
}

} // namespace pcl_bsh::io
