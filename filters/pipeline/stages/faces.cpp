// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/faces.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/selected_records.h>
#include <pcl_bsh/search/used_vertices.h>

#include <memory>

namespace pcl_bsh::pipeline {

StageCloudPtr keptFaces(const StageCloud& mesh, const std::vector<std::uint8_t>& kept)
{
  auto triangles = std::make_shared<std::vector<Triangle>>(keptValues(*mesh.triangles, kept));
  const pcl::Indices vertices = keepUsedVertices(viewOf(mesh.cloud).count, *triangles);
  auto output = emptyLike(mesh);
  output->cloud = selectedRecords(mesh.cloud, vertices);
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
