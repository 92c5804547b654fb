// SPDX-License-Identifier: BSD-3-Clause
// FCL: oriented boxes over triangles, points as small balls.
#include "surface_peer.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

namespace pcl_bsh::bench {
namespace {

fcl::Transform3d at(const double* p)
{
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.translation() << p[0], p[1], p[2];
  return pose;
}

class Fcl final : public SurfacePeer {
public:
  Fcl(const MeshVertices& vertices, const MeshTriangles& triangles) : SurfacePeer(vertices, triangles)
  {
    std::vector<fcl::Vector3d> places;
    std::vector<fcl::Triangle> corners;
    for (const auto& p : vertices) places.emplace_back(p[0], p[1], p[2]);
    for (const auto& t : triangles) corners.emplace_back(t[0], t[1], t[2]);
    model_.beginModel(static_cast<int>(corners.size()), static_cast<int>(places.size()));
    model_.addSubModel(places, corners);
    model_.endModel();
  }

  bool flag(const double* xyz, std::size_t count, double d, std::uint8_t* out) override
  {
    const fcl::Sphered ball(d);
    const fcl::CollisionRequestd request;
    for (std::size_t i = 0; i < count; ++i) {
      fcl::CollisionResultd result;
      fcl::collide(&model_, fcl::Transform3d::Identity(), &ball, at(xyz + 3 * i), request, result);
      out[i] = result.isCollision() ? 1 : 0;
    }
    return true;
  }

  bool any(const std::array<double, 3>& shift, double d, bool* found) override
  {
    double least = 0.0;
    if (d == 0.0) {
      const fcl::CollisionRequestd request;
      fcl::CollisionResultd result;
      fcl::collide(&model_, fcl::Transform3d::Identity(), &model_, at(shift.data()), request, result);
      *found = result.isCollision();
      return true;
    }
    distance(shift, &least);
    *found = least <= d;
    return true;
  }

  bool distance(const std::array<double, 3>& shift, double* found) override
  {
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    *found = fcl::distance(&model_, fcl::Transform3d::Identity(), &model_, at(shift.data()), request, result);
    if (*found < 0.0) *found = 0.0;
    return true;
  }

private:
  fcl::BVHModel<fcl::OBBRSSd> model_;
};

} // namespace

std::unique_ptr<SurfacePeer> makeFcl(const MeshVertices& vertices, const MeshTriangles& triangles)
{
  return std::make_unique<Fcl>(vertices, triangles);
}

} // namespace pcl_bsh::bench
