// SPDX-License-Identifier: BSD-3-Clause
#include "link_body.h"

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/io/files/file_error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>

namespace pcl_bsh::self_filter {

namespace {

/// A cylinder about an axis of the solid's frame, centred, that encloses it. A sphere has the length 0: all of it is
/// within the radius of the centre.
struct Rod {
  int axis = 2;
  double radius = 0.0, half_length = 0.0; ///< m
};

Rod rodAround(const Box& box)
{
  Rod rod;
  rod.half_length = 0.5 * box.size.maxCoeff(&rod.axis);
  rod.radius = 0.5 * std::hypot(box.size[(rod.axis + 1) % 3], box.size[(rod.axis + 2) % 3]);
  return rod;
}

Rod rodAround(const Cylinder& tube)
{
  return {2, tube.radius, tube.length / 2};
}

Rod rodAround(const Sphere& ball)
{
  return {2, ball.radius, 0.0};
}

Rod rodAround(const Capsule& pill)
{
  return {2, pill.radius, enclosingRadius(pill)};
}

/// @throws std::runtime_error for a size that is not finite, not above 0, or beyond what a float holds
void requireSize(const Solid& solid)
{
  constexpr double most = 1e30;
  constexpr const char* names[] = {"a box", "a cylinder", "a sphere", "a capsule"};
  for (const double size : sizesOf(solid))
    if (!(size > 0.0 && size <= most))
      throw std::runtime_error(std::string(names[solid.index()]) + " of size " + std::to_string(size) +
                               ": give one above 0" + (size > most ? ", and at most 1e30 m" : ""));
}

void addSolid(LinkBody& body, const Solid& solid, const Eigen::Isometry3d& T_link_solid)
{
  requireSize(solid);
  body.solids.push_back({solid, T_link_solid.inverse()});
  // Balls along a rod, about as long as they are wide: one ball about all of a slender solid would hold much else.
  constexpr double most = 64;
  const Rod rod = std::visit([](const auto& form) { return rodAround(form); }, solid);
  const double count = std::clamp(std::ceil(rod.half_length / rod.radius), 1.0, most);
  constexpr double roundings = 0x1p-40; // of the centres
  const double radius = std::hypot(rod.radius, rod.half_length / count) +
                        roundings * (rod.radius + rod.half_length + T_link_solid.translation().lpNorm<1>());
  for (double i = 0; i < count; ++i) {
    const Eigen::Vector3d center =
        T_link_solid * (((2 * i + 1) / count - 1) * rod.half_length * Eigen::Vector3d::Unit(rod.axis));
    body.enclosing.centers.push_back({center.x(), center.y(), center.z()});
    body.enclosing.radii.push_back(roundUp(radius));
  }
}

void addShape(LinkBody& body, const Shape& shape)
{
  constexpr double any = 1.0; // meshes have no round parts
  std::visit(
      [&](const auto& form) {
        if constexpr (std::is_constructible_v<Solid, decltype(form)>)
          addSolid(body, form, shape.pose);
        else {
          const std::size_t first = body.surface.triangles.size();
          body.surface.add(surfaceOf(shape, any));
          body.meshes.push_back({form.path, first, body.surface.triangles.size() - first});
        }
      },
      shape.form);
}

} // namespace

PointsView Balls::view() const
{
  PointsView view = viewOf(centers.empty() ? nullptr : centers[0].data(), centers.size());
  view.radii = radii.data();
  return view;
}

TrianglesView LinkBody::trianglesOf(const Mesh& mesh) const
{
  return {viewOf(surface.vertices.front().data(), surface.vertices.size()), surface.triangles[mesh.first].data(),
          mesh.count};
}

bool LinkBody::hasWithin(double padding, const Eigen::Vector3d& point) const
{
  return std::any_of(solids.begin(), solids.end(), [&](const PlacedSolid& placed) {
    constexpr double roundings = 0x1p-48; // of the numbers that a distance is made of
    const double size = point.lpNorm<1>() + placed.T_solid_link.translation().lpNorm<1>() + padding;
    return signedDistance(placed.solid, placed.T_solid_link * point) <= padding + roundings * size;
  });
}

LinkBody bodyOf(const Link& link)
{
  LinkBody body;
  for (const Shape& shape : link.shapes) {
    try {
      addShape(body, shape);
    }
    catch (const files::FileError&) {
      throw;
    }
    catch (const std::exception& error) {
      throw std::runtime_error("link '" + link.name + "': " + error.what());
    }
  }
  return body;
}

} // namespace pcl_bsh::self_filter
