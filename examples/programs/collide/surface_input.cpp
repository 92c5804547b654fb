// SPDX-License-Identifier: BSD-3-Clause
#include "surface_input.h"

#include <pcl_bsh/files/file_error.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_bsh::cli {
namespace {

std::size_t count(const std::vector<std::uint8_t>& flags, Verdict verdict)
{
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), flagOf(verdict)));
}

/// A value of each triangle that is kept.
template <typename Value>
std::vector<Value> keptOf(const std::vector<Value>& values, const std::vector<std::uint8_t>& kept)
{
  std::vector<Value> chosen;
  for (std::size_t t = 0; t < values.size(); ++t)
    if (kept[t]) chosen.push_back(values[t]);
  return chosen;
}

} // namespace

SurfaceCover coverInput(const std::filesystem::path& file, const PointsView& vertices,
                        const std::vector<Triangle>& triangles, const io::SurfaceSettings& settings, double clearance,
                        const std::function<bool(double)>& progress)
{
  SurfaceRequest request;
  request.tolerance =
      settings.tolerance ? *settings.tolerance : io::usualTolerance(vertices, triangles, clearance).tolerance;
  request.triangles_apart = true;
  request.progress = progress;
  try {
    return coverSurface(vertices, triangles, request);
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

TrajectoryResult ofTriangles(const SurfaceCover& cover, TrajectoryResult balls)
{
  TrajectoryResult found;
  found.flags = triangleVerdicts(cover, balls.flags);
  found.colliding = count(found.flags, Verdict::colliding);
  found.undecided = count(found.flags, Verdict::undecided);
  if (!balls.distance.empty()) {
    const std::vector<std::uint32_t> nearest = nearestBalls(cover, balls.distance, balls.closest_pose);
    found.distance = ofBalls(nearest, balls.distance, std::numeric_limits<float>::quiet_NaN());
    for (float& distance : found.distance)
      if (distance < 0.0f) distance = 0.0f; // keeps NaN
    if (!balls.closest_pose.empty()) found.closest_pose = ofBalls(nearest, balls.closest_pose, -1);
    if (!balls.closest_point.empty())
      found.closest_point = ofBalls(nearest, balls.closest_point, TrajectoryResult::kNoPoint);
  }
  if (!balls.first_pose.empty()) found.first_pose = triangleFirstPoses(cover, balls.first_pose);
  if (!balls.certain_pose.empty()) found.certain_pose = triangleFirstPoses(cover, balls.certain_pose);
  found.first_contact = balls.first_contact;
  found.certain_contact = balls.certain_contact;
  found.work = balls.work;
  return found;
}

std::size_t writeSurface(const CollideOptions& options, io::Mesh mesh, const io::Viewpoint& viewpoint,
                         const TrajectoryResult& found)
{
  std::vector<std::uint8_t> kept(mesh.triangles.size(), 1);
  if (options.keep != Keep::flagged)
    for (std::size_t t = 0; t < kept.size(); ++t) kept[t] = (found.flags[t] != 0) == (options.keep == Keep::colliding);
  mesh.triangles = keptOf(mesh.triangles, kept);
  const auto flags = keptOf(found.flags, kept);
  const auto distance = keptOf(found.distance, kept);
  const auto first = keptOf(found.first_pose, kept), closest = keptOf(found.closest_pose, kept);
  std::vector<io::FaceField> fields;
  if (options.keep == Keep::flagged || options.moves()) fields.push_back({collision_field_name, &flags});
  if (options.moves() && !found.distance.empty()) {
    fields.push_back({distance_field_name, &distance});
    fields.push_back({first_pose_field_name, &first});
    fields.push_back({closest_pose_field_name, &closest});
  }
  io::writeMesh(options.output, mesh, fields, viewpoint);
  return mesh.triangles.size();
}

} // namespace pcl_bsh::cli
