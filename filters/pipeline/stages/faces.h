// SPDX-License-Identifier: BSD-3-Clause
// The triangles of a cloud in a pipeline: sets properties of them, and keeps some of them.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_cloud.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::pipeline {

/// Adds a property, or replaces the one of that name.
template <typename Value>
void setFaceProperty(StageCloud& mesh, const std::string& name, std::vector<Value>&& values)
{
  for (FaceProperty& property : mesh.face_properties) {
    if (property.name != name) continue;
    property.values = std::move(values);
    return;
  }
  mesh.face_properties.push_back({name, std::move(values)});
}

/// The triangles whose flag is not 0, their properties, and the vertices that they use, in the order they had.
/// @pre the mesh has triangles, and there is one flag each
StageCloudPtr keptFaces(const StageCloud& mesh, const std::vector<std::uint8_t>& kept);

} // namespace pcl_bsh::pipeline
