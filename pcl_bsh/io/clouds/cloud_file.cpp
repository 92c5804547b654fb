// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/conversion.h>
#include <pcl_bsh/io/clouds/coordinates.h>
#include <pcl_bsh/io/clouds/formats.h>
#include <pcl_bsh/io/clouds/las/las.h>
#include <pcl_bsh/io/clouds/lines/scan_text.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>
#include <pcl_bsh/io/clouds/meshes/mesh_faces.h>
#include <pcl_bsh/io/clouds/meshes/stl.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/clouds/ply/ply.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/files/file_identity.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/search/cloud_view.h>

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

/// The contents of a file.
struct Contents {
  pcl::PCLPointCloud2 cloud;
  CloudFacts facts = {};
};

Contents readAll(CloudStream& reader)
{
  return {reader.readAll(), reader.facts()};
}

void requireSettings(const std::string& extension, const ReadSettings& settings)
{
  if (settings.scan && !mayHaveScans(extension))
    throw FormatError("is a " + extension + ", which has no numbered scans",
                      "give a scan of .ptx and .e57 files alone");
  if (settings.columns.empty() || isColumnText(extension)) return;
  throw FormatError("is a " + extension + ", which names its fields itself",
                    "give names of columns for .xyz, .asc, .txt and .csv files alone");
}

/// The faces of a file, as it has them.
struct Faces {
  Polygons polygons;
  std::vector<Triangle> triangles;
};

/// @param faces if not null, set where the format has some
Contents parse(const std::string& extension, std::string_view file, const ReadSettings& settings, unsigned threads,
               Faces* faces)
{
  requireSettings(extension, settings);
  if (isReadByPlace(extension))
    return readAll(*readerByPlace(extension, std::make_unique<HeldBytes>(file), settings, threads));
  Contents contents;
  if (extension == ".pcd") {
    contents.cloud = parsePcd(file, contents.facts.viewpoint, &contents.facts.remarks);
  }
  else if (extension == ".ply") {
    contents.cloud =
        parsePly(file, contents.facts.viewpoint, faces ? &faces->polygons : nullptr, &contents.facts.remarks);
  }
  else if (extension == ".ptx") {
    contents.cloud = parsePtx(file, contents.facts.viewpoint, settings.scan, &contents.facts.scanners,
                              settings.allow_scale, &contents.facts.remarks);
  }
  else if (extension == ".obj") {
    contents.cloud = parseObj(file, &contents.facts.remarks);
    if (faces) faces->polygons = parseObjFaces(file, &contents.facts.remarks);
  }
  else if (extension == ".off") {
    contents.cloud = parseOff(file);
    if (faces) faces->polygons = parseOffFaces(file);
  }
  else if (extension == ".stl") {
    contents.cloud = parseStl(file, faces ? &faces->triangles : nullptr);
  }
  else if (extension == ".pts") {
    contents.cloud = parsePts(file, &contents.facts.remarks);
  }
  else {
    contents.cloud = parseColumns(file, settings.columns, &contents.facts.remarks);
  }
  return contents;
}

pcl::PCLPointCloud2 parseHeader(const std::string& extension, std::string_view file, bool whole,
                                const ReadSettings& settings)
{
  requireSettings(extension, settings);
  if (extension == ".pcd") return parsePcdHeader(file);
  if (extension == ".ply") return parsePlyHeader(file);
  if (extension == ".obj") return parseObjHeader(file);
  if (extension == ".off") return parseOffHeader(file);
  if (extension == ".stl") return parseStlHeader(file);
  if (extension == ".pts") return parsePtsHeader(file, whole);
  if (extension == ".ptx") return parsePtxHeader(file, settings.scan, settings.allow_scale);
  return parseColumnNames(file, whole, settings.columns);
}

void print(const std::string& extension, std::ostream& out, const pcl::PCLPointCloud2& cloud,
           const Viewpoint& viewpoint, const LasHeader* las)
{
  if (extension == ".pcd") return writePcd(out, cloud, viewpoint);
  if (extension == ".ply") return writePly(out, cloud, viewpoint);
  if (isLasExtension(extension)) return writeLas(out, cloud, las, extension == ".laz");
  if (extension == ".obj") return writeObj(out, cloud);
  if (extension == ".pts") return writePts(out, cloud);
  if (extension == ".ptx") return writePtx(out, cloud, viewpoint);
  writeColumns(out, cloud, extension == ".csv" ? ',' : ' ');
}

/// The format of the bytes of a pipe, by their beginning: the name of a pipe says nothing.
std::string extensionByContent(std::string_view file)
{
  for (const CloudFormat& format : cloud_formats)
    if (format.begins && format.begins(file)) return std::string(format.extension);
  return ".txt";
}

/// The file's extension, of those that can be read; of a pipe, that which its name or `beginning` tells.
std::string readableExtension(const std::filesystem::path& path, std::string_view beginning)
{
  std::string extension = extensionOf(path);
  if (cloudFormat(extension)) return extension;
  if (!isPipe(path))
    throw files::FileError(path, unknown(extension), "give a " + extensionsOf(isRead, ", ", " or ") + " file");
  return extensionByContent(beginning);
}

/// Whether the file is read piece by piece, and not held in memory.
bool isFileReadByPlace(const std::filesystem::path& path)
{
  return isReadByPlace(extensionOf(path)) && !isPipe(path);
}

/// The cloud, once it is known to be usable.
pcl::PCLPointCloud2 checked(Contents contents, const ReadSettings& settings, CloudFacts* facts)
{
  makeCoordinatesPlain(contents.cloud);
  requireCoordinates(contents.cloud);
  convert(contents.cloud, contents.facts, settings);
  setDense(contents.cloud);
  if (facts != nullptr) *facts = std::move(contents.facts);
  return std::move(contents.cloud);
}

/// @param told unit and coordinate system that the file names
pcl::PCLPointCloud2 checkedHeader(pcl::PCLPointCloud2 header, const ReadSettings& settings, const CloudFacts& told = {})
{
  makeCoordinatesPlain(header);
  pcl::PCLPointCloud2 fields = header;
  fields.width = fields.height = fields.row_step = 0; // the records are not there
  requireCoordinates(fields);
  convertHeader(header, told, settings);
  return header;
}

pcl::PCLPointCloud2 headerOf(const std::filesystem::path& path, const FileBytes& file, const ReadSettings& settings)
{
  const std::string extension = readableExtension(path, file.view());
  return naming(path,
                [&] { return checkedHeader(parseHeader(extension, file.view(), file.isWhole(), settings), settings); });
}

pcl::PCLPointCloud2 read(const std::filesystem::path& path, CloudFacts* facts, const ReadSettings& settings,
                         unsigned threads, Faces* faces)
{
  if (isFileReadByPlace(path)) {
    return naming(path, [&] {
      const std::string extension = extensionOf(path);
      requireSettings(extension, settings);
      return checked(readAll(*readerByPlace(extension, openBytes(path), settings, threads)), settings, facts);
    });
  }
  const FileBytes file(path);
  const std::string extension = readableExtension(path, file.view());
  return naming(path,
                [&] { return checked(parse(extension, file.view(), settings, threads, faces), settings, facts); });
}

} // namespace

pcl::PCLPointCloud2 readCloud(const std::filesystem::path& path, CloudFacts* facts, const ReadSettings& settings,
                              unsigned threads)
{
  return read(path, facts, settings, threads, nullptr);
}

Mesh readMeshOrCorners(const std::filesystem::path& path, CloudFacts* facts, const ReadSettings& settings,
                       unsigned threads)
{
  Faces faces;
  Mesh mesh{read(path, facts, settings, threads, &faces), std::move(faces.triangles)};
  naming(path, [&] {
    const std::vector<Triangle> cut = trianglesOf(faces.polygons, viewOf(mesh.vertices), mesh.face_values);
    const LeftOuts left_out = leftOutOf(faces.polygons);
    mesh.triangles.insert(mesh.triangles.end(), cut.begin(), cut.end());
    if (mesh.triangles.empty() && left_out.joinVertices()) mesh.corners_alone = left_out.refusal();
    if (facts != nullptr && !left_out.empty()) facts->remarks.push_back(left_out.remark());
  });
  return mesh;
}

Mesh readMesh(const std::filesystem::path& path, CloudFacts* facts, const ReadSettings& settings, unsigned threads)
{
  Mesh mesh = readMeshOrCorners(path, facts, settings, threads);
  if (!mesh.corners_alone.empty()) throw files::FileError(path, mesh.corners_alone, give_corners);
  return mesh;
}

pcl::PCLPointCloud2 readCloudHeader(const std::filesystem::path& path, const ReadSettings& settings)
{
  if (isPipe(path)) {
    throw files::FileError(path, "is a pipe, whose header and points cannot be read one after the other",
                           "save the cloud to a file first");
  }
  if (isFileReadByPlace(path)) {
    return naming(path, [&] {
      const std::string extension = extensionOf(path);
      requireSettings(extension, settings);
      const auto reader = readerByPlace(extension, openBytes(path), settings, 0);
      requirePoints(reader->size());
      pcl::PCLPointCloud2 header = reader->header();
      header.width = static_cast<std::uint32_t>(reader->size());
      return checkedHeader(std::move(header), settings, reader->facts());
    });
  }
  constexpr std::size_t usual = std::size_t{1} << 16;
  const FileBytes beginning(path, usual);
  try {
    return headerOf(path, beginning, settings);
  }
  catch (const files::FileError&) {
    if (beginning.isWhole()) throw;
  }
  return headerOf(path, FileBytes(path), settings); // a long header, or one that rows decide
}

void requireWritableCloud(const std::filesystem::path& path)
{
  const std::string extension = writtenExtension(path);
  if (extension == ".laz" && !writesLaz()) {
    throw files::FileError(path, "is the name of a compressed file, which is not written without LASzip",
                           "write a .las file, or build it where liblaszip-dev is installed");
  }
  if (path.stem().extension() == ".copc" && extension == ".laz")
    throw files::FileError(path, "is the name of a COPC file, whose tree of parts is not written", "write a .laz file");
  const CloudFormat* const format = cloudFormat(extension);
  if (!format || !isWritten(*format))
    throw files::FileError(path, unknown(extension), "write a " + extensionsOf(isWritten, ", ", " or ") + " file");
  files::requireWritable(path);
}

void requireWritableCloud(const std::filesystem::path& path, pcl::PCLPointCloud2 header)
{
  requireWritableCloud(path);
  header.width = 0;
  std::ostringstream nowhere;
  naming(path, [&] { print(writtenExtension(path), nowhere, header, no_viewpoint, nullptr); });
}

void writeCloud(const std::filesystem::path& path, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint,
                const LasHeaderPtr& las)
{
  requireWritableCloud(path);
  naming(path, [&] {
    files::replaceFile(path,
                       [&](std::ostream& out) { print(writtenExtension(path), out, cloud, viewpoint, las.get()); });
  });
}

void requireWritableMesh(const std::filesystem::path& path)
{
  if (writtenExtension(path) != ".ply")
    throw files::FileError(path, "has no place for what is known of triangles", "write a .ply file");
  files::requireWritable(path);
}

void writeMesh(const std::filesystem::path& path, const pcl::PCLPointCloud2& vertices,
               const std::vector<Triangle>& triangles, const std::vector<FaceField>& fields, const Viewpoint& viewpoint)
{
  requireWritableMesh(path);
  naming(path, [&] {
    files::replaceFile(path, [&](std::ostream& out) { writePlyMesh(out, vertices, triangles, fields, viewpoint); });
  });
}

} // namespace pcl_bsh::io
