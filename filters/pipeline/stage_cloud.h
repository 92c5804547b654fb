// SPDX-License-Identifier: BSD-3-Clause
// Clouds that go from stage to stage.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::io {
struct LasHeader;
}

namespace pcl_bsh::pipeline {

/// A result for each triangle of a mesh.
struct FaceProperty {
  std::string name;
  std::variant<std::vector<std::uint8_t>, std::vector<std::int32_t>, std::vector<float>> values; ///< one per triangle
};

/// A cloud with all its fields, and the facts of its file. The viewpoint says where the sensor stood, tx ty tz qw qx
/// qy qz, as in a PCD file. The header of a LAS file (scale, offset, coordinate system) is kept by writers.las. A
/// mesh has its triangles. A stage that removes, adds or reorders records leaves the triangles out, and the pipeline
/// warns.
struct StageCloud {
  pcl::PCLPointCloud2 cloud;
  std::array<double, 7> viewpoint = {0, 0, 0, 1, 0, 0, 0};
  std::shared_ptr<const io::LasHeader> las_header = nullptr;
  /// Viewpoints of each scan's sensor, for clouds whose field `scan` numbers them from 0; or of the only one.
  std::vector<std::array<double, 7>> scanners = {};
  std::shared_ptr<const std::vector<Triangle>> triangles = nullptr; ///< corners are records of `cloud`; null: no mesh
  std::vector<FaceProperty> face_properties = {};                   ///< empty where it is no mesh
  /// Why the points alone say less than their file: it joins them by lines, edges ... and has no faces. Otherwise
  /// empty.
  std::string corners_alone = {};
  std::string coordinate_system = {}; ///< as a LAS or E57 file names it; else empty
  std::string system_definition = {}; ///< its codes or WKT; empty where it is not known, and once points are moved
};

/// Several stages may read one cloud, so it does not change.
using StageCloudPtr = std::shared_ptr<const StageCloud>;
/// Input of a stage: one cloud for each input.
using StageClouds = std::vector<StageCloudPtr>;

/// The fields of a cloud, without its points.
using CloudHeader = pcl::PCLPointCloud2;

/// The cloud itself, to be changed in place, when this is the only pointer to it; otherwise a copy.
std::shared_ptr<StageCloud> ownCloud(StageCloudPtr&& cloud);

/// A cloud with the fields of this one and what its file said, but without points and triangles.
std::shared_ptr<StageCloud> emptyLike(const StageCloud& cloud);

} // namespace pcl_bsh::pipeline
PCL_BSH_EXPORT_END
