// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/faces.h>
#include <pcl_bsh/filters/selected_records.h>
#include <pcl_bsh/filters/used_vertices.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/search/cloud_view.h>

#include <limits>
#include <memory>
#include <tuple>

namespace pcl_bsh::pipeline {

TrajectoryResult ofVertices(const std::vector<Triangle>& triangles, std::size_t vertices,
                            const TrajectoryResult& of_triangles)
{
  TrajectoryResult found;
  found.flags.resize(vertices, Verdict::free);
  const bool measured = !of_triangles.distance.empty();
  if (measured) {
    found.distance.resize(vertices, std::numeric_limits<float>::quiet_NaN());
    found.first_pose.resize(vertices, -1);
    found.closest_pose.resize(vertices, -1);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t vertex : triangles[t]) {
      found.flags[vertex] = graver(found.flags[vertex], of_triangles.flags[t]);
      if (!measured || of_triangles.first_pose[t] < 0) continue;
      std::int32_t& first = found.first_pose[vertex];
      const bool is_first = first < 0;
      if (is_first || of_triangles.first_pose[t] < first) first = of_triangles.first_pose[t];
      const auto near = std::tuple(of_triangles.distance[t], of_triangles.closest_pose[t]);
      if (is_first || near < std::tuple(found.distance[vertex], found.closest_pose[vertex]))
        std::tie(found.distance[vertex], found.closest_pose[vertex]) = near;
    }
  }
  return found;
}

StageCloudPtr keptFaces(const StageCloud& mesh, const std::vector<std::uint8_t>& kept)
{
  auto triangles = std::make_shared<std::vector<Triangle>>(keptValues(*mesh.triangles, kept));
  const pcl::Indices vertices = keepUsedVertices(viewOf(mesh.cloud).count, *triangles);
  auto output =
      std::make_shared<StageCloud>(StageCloud{selectedRecords(mesh.cloud, vertices), mesh.viewpoint, mesh.las_header});
  output->triangles = std::move(triangles);
  for (const FaceProperty& property : mesh.face_properties) {
    std::visit(
        [&](const auto& values) {
          output->face_properties.push_back({property.name, keptValues(values, kept)});
        },
        property.values);
  }
  return output;
}

} // namespace pcl_bsh::pipeline
