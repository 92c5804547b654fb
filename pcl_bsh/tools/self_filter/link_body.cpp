// SPDX-License-Identifier: BSD-3-Clause
#include "link_body.h"

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/io/files/file_error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <variant>

namespace pcl_bsh::self_filter {

namespace {

void addSolid(LinkBody& body, const Solid& solid, const Eigen::Isometry3d& T_link_solid)
{
  requireSize(solid);
  body.solids.push_back({solid, T_link_solid.inverse()});
  // Balls along a rod, about as long as they are wide: one ball about all of a slender solid would hold much else.
  constexpr double most = 64;
  const Rod rod = rodAround(solid);
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
  constexpr double any = 1.0; // nothing of a mesh is round
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
