// SPDX-License-Identifier: BSD-3-Clause
// The clouds of a scene: what its document says of each, and points made on shapes.
#pragma once

#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/scenes/scene_file.h>

#include <optional>

namespace pcl_bsh::io {

/// Reads the number `key` of an object; `value` stays where there is no such number.
void read(const JsonReader& object, const char* key, std::optional<double>& value);

/// The file that a text names. @param folder of relative names
std::filesystem::path existingFile(const JsonReader& reader, const std::filesystem::path& folder);

CloudSource cloudFrom(const JsonReader& reader, const std::string& name, const std::filesystem::path& folder);

/// x y z of points about `spacing` apart on the surface of a shape around the origin. "sphere": radius size.x. "box":
/// edges size. "cylinder": radius size.x, height size.y, along z; with size.z > 0 without its lids.
std::vector<float> shapePoints(const std::string& shape, const Eigen::Vector3d& size, double spacing);

/// The number of points that shapePoints() makes, at most.
double shapePointCount(const std::string& shape, const Eigen::Vector3d& size, double spacing);

} // namespace pcl_bsh::io
