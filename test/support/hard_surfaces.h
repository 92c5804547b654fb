// SPDX-License-Identifier: BSD-3-Clause
// The catalogue of test/hard_cases/surfaces: surfaces and solids that other tools answer wrongly, or not at all, with
// the answers of exact arithmetic.
#pragma once

#include "support/off_mesh.h"
#include "support/pcd_points.h"

#include <nlohmann/json.hpp>

#include <Eigen/Geometry>

#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::test {

inline const std::string hard_surfaces_folder = PCL_BSH_SOURCE_DIR "/test/hard_cases/surfaces/";

/// The cases, as in run_surfaces.py.
inline std::vector<nlohmann::json> hardSurfaces()
{
  std::ifstream file(hard_surfaces_folder + "cases.json");
  const nlohmann::json all = nlohmann::json::parse(file);
  return {all.at("cases").begin(), all.at("cases").end()};
}

/// The mesh of one. @throws std::exception where a file is missing
inline OffMesh meshOf(const nlohmann::json& told)
{
  return readOffMesh(hard_surfaces_folder + told.at("mesh").get<std::string>());
}

/// The pose of the mesh, into the input's frame.
inline Eigen::Isometry3d poseOf(const nlohmann::json& told)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (told.contains("pose"))
    for (Eigen::Index i = 0; i < 12; ++i) pose.matrix()(i / 4, i % 4) = told.at("pose").at(static_cast<std::size_t>(i));
  return pose;
}

/// The input that is compared with the mesh: points or triangles.
struct HardInput {
  std::vector<Point3> points;
  std::optional<OffMesh> mesh;

  explicit HardInput(const nlohmann::json& told)
  {
    if (told.contains("other"))
      mesh = readOffMesh(hard_surfaces_folder + told.at("other").get<std::string>());
    else
      points = readPcdPoints(hard_surfaces_folder + told.at("points").get<std::string>()).points;
  }

  PointsView view() const { return mesh ? viewOf(mesh->view()) : viewOf(points.front().data(), points.size()); }
};

} // namespace pcl_bsh::test
