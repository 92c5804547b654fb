// SPDX-License-Identifier: BSD-3-Clause
// The catalogues of hard cases as instances that symmetries transform.
#pragma once

#include "instance.h"
#include "support/hard_cases.h"
#include "support/hard_surfaces.h"

#include <algorithm>
#include <vector>

namespace pcl_bsh::symmetries {

/// At most fifty, in their order.
inline std::vector<Point3> someOf(const std::vector<Point3>& points)
{
  std::vector<Point3> some;
  const std::size_t step = (points.size() + 49) / 50;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

inline Instance instanceOf(const hard_cases::HardCase& c)
{
  Instance instance;
  instance.name = c.name;
  instance.a = {someOf(c.a), {}, {}, c.scalar, c.pose_a};
  instance.b = {someOf(c.b), {}, {}, c.scalar, c.pose_b};
  for (Body* body : {&instance.a, &instance.b}) roundTo(body->scalar, body->points);
  instance.clearance = c.clearance;
  instance.path = instance.relative = {c.pose_b, Eigen::Isometry3d::Identity()};
  if (!c.b.empty()) instance.queries = {c.b.front(), c.b.back()};
  instance.high = {c.clearance, c.clearance, c.clearance};
  return instance;
}

/// Instances of the catalogue of surfaces whose meshes are small enough to be asked about many times. Each has points
/// or the corners of another mesh, and the mesh as a surface; where it closes, as a solid, too.
inline std::vector<Instance> instancesOfHardSurfaces()
{
  std::vector<Instance> instances;
  for (const nlohmann::json& told : test::hardSurfaces()) {
    const test::OffMesh mesh = test::meshOf(told);
    if (told.contains("open_edges") || mesh.triangles.size() > 100) continue;
    const test::HardInput input(told);
    Instance instance;
    instance.name = told.at("name");
    instance.a = {someOf(input.mesh ? input.mesh->vertices : input.points), {}, {}, Scalar::float64};
    instance.b = {mesh.vertices, {}, {}, Scalar::float64, test::poseOf(told)};
    instance.clearance = told.at("clearance");
    instance.faces = mesh.triangles;
    if (told.contains("labels")) instance.shell = mesh.triangles;
    instance.path = instance.relative = {instance.b.pose, Eigen::Isometry3d::Identity()};
    instances.push_back(instance);
  }
  return instances;
}

} // namespace pcl_bsh::symmetries
