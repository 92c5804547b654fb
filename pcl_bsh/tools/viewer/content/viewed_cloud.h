// SPDX-License-Identifier: BSD-3-Clause
// One cloud that the viewer shows, with its hierarchy.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::viewer {

/// How many obstacles with names a picture names, for want of room.
inline constexpr std::size_t most_named = 12;

struct ViewedCloud {
  /// A scan is drawn in grey and marked in orange, an obstacle in blue and yellow.
  enum class Role { scan, obstacle };

  std::string name;   ///< for titles
  std::string legend; ///< clouds of the same role may share an entry
  Role role = Role::scan;
  std::size_t number = 0; ///< of obstacles that have names: each has its own colour
  std::filesystem::path file;
  std::shared_ptr<const pcl::PCLPointCloud2> cloud; ///< as it was read; none where fields are not shown
  std::optional<io::Obstacle> surface;              ///< where it has faces: these are drawn, and asked about
  std::vector<io::FaceValues> face_values;          ///< as they were read; none where fields are not shown
  std::shared_ptr<SphereHierarchy> hierarchy;       ///< null where nothing is asked
  PointsView records;                               ///< the points, where the hierarchy is null

  const PointsView& points() const { return hierarchy ? hierarchy->view() : records; } ///< of a surface, its triangles

  /// Parts that are coloured and picked: points or, for a surface, triangles.
  bool hasTriangles() const { return surface.has_value(); }
  std::size_t parts() const { return points().count; }
  const char* partName() const { return hasTriangles() ? "triangle" : "point"; }

  /// The part's place; for a triangle, its middle.
  Point3 placeOf(std::uint32_t part) const;

  /// The corners of a triangle, or three times a point. @param pose of the cloud
  Triangle3 cornersOf(std::uint32_t part, const Eigen::Isometry3d& pose) const;

  /// A field's values, one per part; none where the cloud has no such field, or one of several values. For triangles:
  /// the property of its faces or, without one, the mean of the field at the corners.
  std::optional<std::vector<float>> field(const std::string& field_name) const;

  /// A result of each part, as a field has it; for triangles, only a property of their faces.
  std::optional<std::vector<float>> result(const std::string& field_name) const;

  /// Red, green, blue, per part; none where the cloud has no colours.
  std::optional<std::vector<std::array<unsigned char, 3>>> colors() const;

private:
  std::optional<std::vector<float>> fieldOfRecords(const std::string& field_name) const;
  std::optional<std::vector<std::array<unsigned char, 3>>> colorsOfRecords() const;
};

} // namespace pcl_bsh::viewer
