// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/files/file_identity.h>
#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/filters/cloud_files/cloud_file.h>
#include <pcl_bsh/filters/cloud_files/mesh_faces.h>
#include <pcl_bsh/filters/cloud_files/pcd.h>
#include <pcl_bsh/filters/cloud_files/ply.h>
#include <pcl_bsh/filters/cloud_files/records.h>
#include <pcl_bsh/filters/cloud_files/stl.h>
#include <pcl_bsh/filters/cloud_files/text_clouds.h>
#include <pcl_bsh/filters/text_files/file_bytes.h>
#include <pcl_bsh/filters/text_files/small_letters.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <sstream>

namespace pcl_bsh::io {
namespace {

/// Standard output gets PCL's own format.
std::string writtenExtension(const std::filesystem::path& path)
{
  return path == files::standard_stream ? ".pcd" : extensionOf(path);
}

std::string unknown(const std::string& extension)
{
  return extension.empty() ? "has no extension" : "unknown extension '" + extension + "'";
}

pcl::PCLPointCloud2 parse(const std::string& extension, std::string_view file, Viewpoint& viewpoint)
{
  if (extension == ".pcd") return parsePcd(file, viewpoint);
  if (extension == ".ply") return parsePly(file, viewpoint);
  if (extension == ".obj") return parseObj(file);
  if (extension == ".off") return parseOff(file);
  if (extension == ".stl") return parseStl(file, nullptr);
  return parseColumns(file);
}

pcl::PCLPointCloud2 parseHeader(const std::string& extension, std::string_view file)
{
  if (extension == ".pcd") return parsePcdHeader(file);
  if (extension == ".ply") return parsePlyHeader(file);
  if (extension == ".obj") return parseObjHeader(file);
  if (extension == ".off") return parseOffHeader(file);
  if (extension == ".stl") return parseStlHeader(file);
  return parseColumnNames(file);
}

void print(const std::string& extension, std::ostream& out, const pcl::PCLPointCloud2& cloud,
           const Viewpoint& viewpoint)
{
  if (extension == ".pcd") return writePcd(out, cloud, viewpoint);
  if (extension == ".ply") return writePly(out, cloud, viewpoint);
  if (extension == ".obj") return writeObj(out, cloud);
  writeColumns(out, cloud);
}

/// That the points have usable x y z.
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

/// The format of the bytes of a pipe, by their beginning: the name of a pipe says nothing.
std::string extensionByContent(std::string_view file)
{
  const auto begins = [&](std::string_view text) { return file.substr(0, text.size()) == text; };
  if (begins("ply")) return ".ply";
  if (begins("# .PCD") || begins("VERSION") || begins("FIELDS")) return ".pcd";
  if (begins("OFF")) return ".off";
  return ".txt";
}

/// Gives the file's extension and content to `parse`; names the file when that throws.
template <typename Parse>
std::invoke_result_t<Parse, std::string, std::string_view> parsed(const std::filesystem::path& path,
                                                                  const FileBytes& file, Parse&& parse)
{
  constexpr std::array readable = {".pcd", ".ply", ".obj", ".off", ".stl", ".xyz", ".txt"};
  std::string extension = extensionOf(path);
  if (std::find(readable.begin(), readable.end(), extension) == readable.end()) {
    if (!isPipe(path)) {
      throw files::FileError(path, unknown(extension), "give a .pcd, .ply, .obj, .off, .stl, .xyz or .txt file");
    }
    extension = extensionByContent(file.view());
  }
  try {
    return parse(extension, file.view());
  }
  catch (const FormatError& error) {
    throw files::FileError(path, error.what(), error.remedy());
  }
}

pcl::PCLPointCloud2 headerOf(const std::filesystem::path& path, const FileBytes& file)
{
  return parsed(path, file, [](const std::string& extension, std::string_view bytes) {
    pcl::PCLPointCloud2 header = parseHeader(extension, bytes);
    pcl::PCLPointCloud2 fields = header;
    fields.width = fields.height = fields.row_step = 0; // the records are not there
    requireCoordinates(fields);
    return header;
  });
}

} // namespace

pcl::PCLPointCloud2 readCloud(const std::filesystem::path& path, Viewpoint* viewpoint)
{
  return parsed(path, FileBytes(path), [&](const std::string& extension, std::string_view file) {
    Viewpoint stored = no_viewpoint;
    pcl::PCLPointCloud2 cloud = parse(extension, file, stored);
    requireCoordinates(cloud);
    setDense(cloud);
    if (viewpoint != nullptr) *viewpoint = stored;
    return cloud;
  });
}

Mesh readMesh(const std::filesystem::path& path)
{
  return parsed(path, FileBytes(path), [](const std::string& extension, std::string_view file) {
    Mesh mesh;
    Polygons faces;
    Viewpoint ignored = no_viewpoint;
    if (extension == ".stl")
      mesh.vertices = parseStl(file, &mesh.triangles);
    else if (extension == ".ply")
      mesh.vertices = parsePly(file, ignored, &faces);
    else
      mesh.vertices = parse(extension, file, ignored);
    if (extension == ".obj") faces = parseObjFaces(file);
    if (extension == ".off") faces = parseOffFaces(file);
    requireCoordinates(mesh.vertices);
    setDense(mesh.vertices);
    for (const Triangle& triangle : trianglesOf(faces, viewOf(mesh.vertices))) mesh.triangles.push_back(triangle);
    return mesh;
  });
}

pcl::PCLPointCloud2 readCloudHeader(const std::filesystem::path& path)
{
  if (isPipe(path)) {
    throw files::FileError(path, "is a pipe, whose header and points cannot be read one after the other",
                           "save the cloud to a file first");
  }
  constexpr std::size_t usual = std::size_t{1} << 16;
  const FileBytes beginning(path, usual);
  try {
    return headerOf(path, beginning);
  }
  catch (const files::FileError&) {
    if (beginning.isWhole()) throw;
  }
  return headerOf(path, FileBytes(path)); // a long header, or other elements before the vertices
}

void requireWritableCloud(const std::filesystem::path& path)
{
  const std::string extension = writtenExtension(path);
  constexpr std::array writable = {".pcd", ".ply", ".obj", ".xyz", ".txt"};
  if (std::find(writable.begin(), writable.end(), extension) == writable.end()) {
    throw files::FileError(path, unknown(extension), "write a .pcd, .ply, .obj, .xyz or .txt file");
  }
  files::requireWritable(path);
}

void requireWritableCloud(const std::filesystem::path& path, pcl::PCLPointCloud2 header)
{
  requireWritableCloud(path);
  header.width = 0;
  header.data.clear();
  std::ostringstream nowhere;
  try {
    print(writtenExtension(path), nowhere, header, no_viewpoint);
  }
  catch (const FormatError& error) {
    throw files::FileError(path, error.what(), error.remedy());
  }
}

void writeCloud(const std::filesystem::path& path, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint)
{
  requireWritableCloud(path);
  try {
    files::replaceFile(path, [&](std::ostream& out) { print(writtenExtension(path), out, cloud, viewpoint); });
  }
  catch (const FormatError& error) {
    throw files::FileError(path, error.what(), error.remedy());
  }
}

} // namespace pcl_bsh::io
