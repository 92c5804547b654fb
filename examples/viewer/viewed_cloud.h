// SPDX-License-Identifier: BSD-3-Clause
// One cloud that the viewer shows, with its hierarchy.
#pragma once

#include <pcl_bsh/filters/cloud_files/obstacle.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::view {

struct ViewedCloud {
  /// A scan is drawn in grey and marked in orange, an obstacle in blue and yellow.
  enum class Role { scan, obstacle };

  std::string name;   ///< for titles
  std::string legend; ///< clouds of the same role may share an entry
  Role role = Role::scan;
  std::filesystem::path file;
  std::shared_ptr<const pcl::PCLPointCloud2> cloud; ///< as it was read; none where fields are not shown
  std::optional<io::Obstacle> surface; ///< where it has faces: these are drawn, and queries are asked of its balls
  std::shared_ptr<SphereHierarchy> hierarchy;

  const PointsView& points() const { return hierarchy->view(); }

  /// A field's values, one per record; none where the cloud has no such field, or one of several values.
  std::optional<std::vector<float>> field(const std::string& field_name) const;

  /// Red, green, blue, per record; none where the cloud has no colours.
  std::optional<std::vector<std::array<unsigned char, 3>>> colors() const;
};

} // namespace pcl_bsh::view
