// SPDX-License-Identifier: BSD-3-Clause
#include "surface_input.h"

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/selected_records.h>
#include <pcl_bsh/filters/used_vertices.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/search/cloud_view.h>

#include <utility>

namespace pcl_bsh::cli {

SurfaceCover coverInput(const std::filesystem::path& file, const PointsView& vertices,
                        const std::vector<Triangle>& triangles, const io::SurfaceSettings& settings, double clearance,
                        const std::function<bool(double)>& progress, std::vector<std::string>& warnings)
{
  std::vector<std::string> remarks;
  io::SurfaceSettings asked_about = settings;
  asked_about.triangles_apart = true;
  try {
    SurfaceCover cover = io::coverMesh(vertices, triangles, asked_about, clearance, progress, remarks);
    for (const std::string& remark : remarks) warnings.push_back(file.string() + ": " + remark);
    return cover;
  }
  catch (const InvalidInput& error) {
    throw files::FileError(file, error.wrong(), error.remedy());
  }
}

void requireForSurface(const CollideOptions& options)
{
  const auto refuse = [&](const std::string& option) {
    throw std::invalid_argument(option + ": is about points, and " + options.input.string() +
                                " is a surface: give --vertices-only to ask about its vertices");
  };
  if (!options.clashes.empty()) refuse("--clashes");
  if (options.distances) refuse("--distances");
  if (!options.input_uncertainty.field.empty()) refuse("--uncertainty: " + options.input_uncertainty.field);
  if (options.density) refuse("--density");
  io::requireWritableMesh(options.output);
}

std::size_t writeSurface(const CollideOptions& options, io::Mesh mesh, const io::Viewpoint& viewpoint,
                         const TrajectoryResult& found)
{
  std::vector<std::uint8_t> kept(mesh.triangles.size(), 1);
  if (options.keep != Keep::flagged)
    for (std::size_t t = 0; t < kept.size(); ++t) kept[t] = (found.flags[t] != 0) == (options.keep == Keep::colliding);
  mesh.triangles = keptValues(mesh.triangles, kept);
  if (options.keep != Keep::flagged) {
    const pcl::Indices vertices = keepUsedVertices(viewOf(mesh.vertices).count, mesh.triangles);
    mesh.vertices = selectedRecords(mesh.vertices, vertices);
  }
  const auto flags = keptValues(found.flags, kept);
  const auto distance = keptValues(found.distance, kept);
  const auto first = keptValues(found.first_pose, kept), closest = keptValues(found.closest_pose, kept);
  std::vector<io::FaceField> fields;
  if (options.keep == Keep::flagged || options.moves()) fields.push_back({collision_field_name, &flags});
  if (options.moves() && !found.distance.empty()) {
    fields.push_back({distance_field_name, &distance});
    fields.push_back({first_pose_field_name, &first});
    fields.push_back({closest_pose_field_name, &closest});
  }
  io::writeMesh(options.output, mesh.vertices, mesh.triangles, fields, viewpoint);
  return mesh.triangles.size();
}

} // namespace pcl_bsh::cli
