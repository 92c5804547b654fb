// SPDX-License-Identifier: BSD-3-Clause
#include "loading.h"

#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/selected_records.h>
#include <pcl_bsh/search/used_vertices.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace pcl_bsh::cli {
namespace {

void requireForSurface(const CollideOptions& options)
{
  const auto refuse = [&](const std::string& option) {
    throw std::invalid_argument(option + ": is about points, and " + options.input.string() +
                                " is a surface: give --vertices-only to ask about its vertices");
  };
  if (!options.clashes.empty()) refuse("--clashes");
  io::requireWritableMesh(options.output);
}

} // namespace

Scan loadInput(const CollideOptions& options, double& seconds)
{
  Step step("Loading " + options.input.string());
  Scan scan;
  const Question& question = options.question;
  const io::SurfaceSettings settings{question.vertices_only};
  io::ReadSettings reading = options.reading.ofInput(options.input);
  reading.beams = question.seen_beyond.has_value();
  scan.shape = io::obstacleOf(options.input,
                              io::readMesh(options.input, settings, &scan.facts, reading, question.threads), settings);
  if (scan.shape.isSurface()) requireForSurface(options);
  const std::string triangles =
      scan.shape.isSurface() ? ", " + counted(scan.shape.triangles()->size(), "triangle") : "";
  seconds += step.done(counted(std::size_t{scan.cloud().width} * scan.cloud().height, "point") + triangles);
  return scan;
}

const SphereHierarchy& build(Shape& shape, const Uncertainty& uncertainty, unsigned threads, double& seconds)
{
  Step step("Sorting " + shape.name() + " into voxels");
  const SphereHierarchy& hierarchy = shape.hierarchy(uncertainty, threads);
  seconds += step.done(counted(hierarchy.statistics().voxels, "voxel"));
  return hierarchy;
}

std::size_t writeSurface(const CollideOptions& options, const Scan& input, const Answer& answer)
{
  const TrajectoryResult& found = answer.collisions;
  io::Mesh mesh{input.cloud(), *input.shape.triangles()};
  std::vector<std::uint8_t> kept(mesh.triangles.size(), 1);
  if (options.keep != Keep::flagged) {
    kept = maskOf(found.flags, options.keep != Keep::colliding);
    mesh.triangles = keptValues(mesh.triangles, kept);
    mesh.vertices = selectedRecords(mesh.vertices, keepUsedVertices(viewOf(mesh.vertices).count, mesh.triangles));
  }
  const auto flags = keptValues(numbersOf(found.flags), kept);
  const std::vector<double>& measured = answer.distances.a.distance;
  const auto distance =
      keptValues(options.distances ? std::vector<float>(measured.begin(), measured.end()) : found.distance, kept);
  const auto first = keptValues(found.first_pose, kept), closest = keptValues(found.closest_pose, kept);
  std::vector<io::FaceField> fields;
  if (options.keep == Keep::flagged || options.moves()) fields.push_back({collision_field_name, &flags});
  if (!distance.empty()) fields.push_back({distance_field_name, &distance});
  if (options.moves() && !found.distance.empty()) {
    fields.push_back({first_pose_field_name, &first});
    fields.push_back({closest_pose_field_name, &closest});
  }
  io::writeMesh(options.output, mesh.vertices, mesh.triangles, fields, input.facts.viewpoint);
  return mesh.triangles.size();
}

} // namespace pcl_bsh::cli
