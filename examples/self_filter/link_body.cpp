// SPDX-License-Identifier: BSD-3-Clause
#include "self_filter/link_body.h"

#include "self_filter/shape_surface.h"

#include <pcl_bsh/files/file_error.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <variant>

namespace pcl_bsh::self_filter {

namespace {

/// The least float that is not smaller.
float roundedUp(double length)
{
  const auto nearest = static_cast<float>(length);
  return nearest < length ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

void addShape(LinkBody& body, const Shape& shape, double tolerance)
{
  if (const auto* ball = std::get_if<Sphere>(&shape.form)) {
    requireSize(ball->radius, "a sphere");
    const Eigen::Vector3d center = shape.pose.translation();
    body.centers.push_back({center.x(), center.y(), center.z()});
    body.radii.push_back(roundedUp(ball->radius));
    return;
  }
  const double sagitta = tolerance / 4;
  const Surface surface = surfaceOf(shape, sagitta);
  // A cylinder's prism lies within it, so that balls which hold the prism must be larger to hold the cylinder.
  const double beyond = std::holds_alternative<Cylinder>(shape.form) ? sagitta : 0.0;
  SurfaceRequest request;
  request.tolerance = tolerance - beyond;
  const SurfaceCover cover =
      coverSurface(viewOf(surface.vertices[0].data(), surface.vertices.size()), surface.triangles, request);
  body.centers.insert(body.centers.end(), cover.centers.begin(), cover.centers.end());
  for (const float radius : cover.radii) body.radii.push_back(roundedUp(radius + beyond));
}

} // namespace

PointsView LinkBody::view() const
{
  PointsView view = viewOf(centers.empty() ? nullptr : centers[0].data(), centers.size());
  view.radii = radii.data();
  return view;
}

LinkBody bodyOf(const Link& link, double tolerance)
{
  LinkBody body;
  for (const Shape& shape : link.shapes) {
    try {
      addShape(body, shape, tolerance);
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
