// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/cloud_file.h>
#include <pcl_bsh/filters/io/file_bytes.h>
#include <pcl_bsh/filters/io/pcd.h>
#include <pcl_bsh/filters/io/ply.h>
#include <pcl_bsh/filters/io/records.h>
#include <pcl_bsh/filters/io/replace_file.h>
#include <pcl_bsh/filters/io/text_clouds.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <cctype>

namespace pcl_bsh::io {

namespace {

std::string extensionOf(const std::filesystem::path& path)
{
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string unknown(const std::string& extension)
{
  return extension.empty() ? "has no extension" : "unknown extension '" + extension + "'";
}

pcl::PCLPointCloud2 parse(const std::string& extension, std::string_view file, Viewpoint& viewpoint)
{
  if (extension == ".pcd") return parsePcd(file, viewpoint);
  if (extension == ".ply") return parsePly(file);
  if (extension == ".obj") return parseObj(file);
  if (extension == ".off") return parseOff(file);
  return parseColumns(file);
}

/// The number of the points, and that they have usable x y z.
void requireCoordinates(const pcl::PCLPointCloud2& cloud)
{
  for (const char* axis : {"x", "y", "z"}) {
    const auto is_axis = [&](const pcl::PCLPointField& field) { return field.name == axis; };
    if (std::count_if(cloud.fields.begin(), cloud.fields.end(), is_axis) > 1) {
      throw FormatError("has two fields named '" + std::string(axis) + "'", "rename one");
    }
  }
  try {
    viewOf(cloud);
  }
  catch (const std::invalid_argument& error) {
    throw FormatError(error.what(), "export it with float x y z");
  }
}

} // namespace

pcl::PCLPointCloud2 readCloud(const std::filesystem::path& path, Viewpoint* viewpoint)
{
  constexpr std::array readable = {".pcd", ".ply", ".obj", ".off", ".xyz", ".txt"};
  const std::string extension = extensionOf(path);
  const FileBytes file(path);
  if (std::find(readable.begin(), readable.end(), extension) == readable.end()) {
    throw CloudFileError(path, unknown(extension), "give a .pcd, .ply, .obj, .off, .xyz or .txt file");
  }
  try {
    Viewpoint stored = no_viewpoint;
    pcl::PCLPointCloud2 cloud = parse(extension, file.view(), stored);
    requireCoordinates(cloud);
    setDense(cloud);
    if (viewpoint != nullptr) *viewpoint = stored;
    return cloud;
  }
  catch (const FormatError& error) {
    throw CloudFileError(path, error.what(), error.remedy());
  }
}

void requireWritableCloud(const std::filesystem::path& path)
{
  const std::string extension = extensionOf(path);
  if (extension != ".pcd" && extension != ".ply") {
    throw CloudFileError(path, unknown(extension), "write a .pcd or .ply file");
  }
  requireWritable(path);
}

void writeCloud(const std::filesystem::path& path, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint)
{
  requireWritableCloud(path);
  try {
    replaceFile(path, [&](std::ostream& out) {
      if (extensionOf(path) == ".pcd") {
        writePcd(out, cloud, viewpoint);
      }
      else {
        writePly(out, cloud);
      }
    });
  }
  catch (const FormatError& error) {
    throw CloudFileError(path, error.what(), error.remedy());
  }
}

} // namespace pcl_bsh::io
