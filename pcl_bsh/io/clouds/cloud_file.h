// SPDX-License-Identifier: BSD-3-Clause
// Point clouds on disk: any format in, most out, every field kept in its type.
//
//   pcl::PCLPointCloud2 scan = pcl_bsh::io::readCloud("hall.ply");
//   pcl_bsh::io::writeCloud("hall.pcd", scan);
//
// PCL's own readers are not used: they allocate what a header claims, read a malformed number as 0 and a short ascii
// row as success. Here a damaged, truncated or lying file is an error, and is noticed before its memory is asked for.
#pragma once

#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/io/clouds/read_settings.h>
#include <pcl_bsh/io/files/file_error.h>

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pcl_bsh::io {

/// Where the sensor stood, as PCD's VIEWPOINT line has it: tx ty tz qw qx qy qz. Points are not moved by it. All
/// formats that hold it keep every bit, except the rotation of a PTX file: a matrix, which comes back to within
/// rounding and sign.
using Viewpoint = std::array<double, 7>;
inline constexpr Viewpoint no_viewpoint = {0, 0, 0, 1, 0, 0, 0};

/// Whether a viewpoint tells where a scan was made. Files without one have it at the origin.
inline bool tellsPlace(const Viewpoint& viewpoint)
{
  return viewpoint[0] != 0.0 || viewpoint[1] != 0.0 || viewpoint[2] != 0.0;
}

/// The part of a LAS file beside its points: scale and offset, version, records of the coordinate system and others.
/// For writeCloud(), which keeps it. Where the file is no LAS, it has the coordinate system alone; null where that is
/// not known.
struct LasHeader;
using LasHeaderPtr = std::shared_ptr<const LasHeader>;

/// Facts in a file beside its points.
struct CloudFacts {
  Viewpoint viewpoint = no_viewpoint;      ///< of .pcd, .ply, .ptx, .e57
  std::vector<Viewpoint> scanners = {};    ///< of .ptx and .e57, of each scan that was read; empty: not known
  LasHeaderPtr las = nullptr;              ///< for .las files that are written of the points
  CoordinateSystem coordinate_system = {}; ///< of the points as they were read, where the file or its user tells it
  std::optional<LengthUnit> unit = {};     ///< that lengths were read in, where the file or its user tells it
  LengthScale scale = {};                  ///< from the file's lengths to those that were read
  std::vector<std::string> remarks = {};   ///< what users should know of how it was read, without the file's name
};

/// Reads the points of a file; the format is told by its extension, in any case of letters.
///
/// .pcd        ascii, binary, binary_compressed; every field in its type, float64 included
/// .ply        ascii and binary of both byte orders; every vertex property in its type (a list, if of one length, is a
///             field with a count); of other elements only PCL's `camera`
/// .obj .off   vertices with their colours and normals; x y z as float64
/// .stl        the corners of the triangles, binary or ASCII, each place once; x y z as float32
/// .las .laz   LAS 1.0 to 1.4, point formats 0 to 10, every field (las/fields.h); x y z as float64. LAZ, and
///             .copc.laz, by chunks: points one by one (formats 0 to 5) and in layers (6 to 10), items of versions 1
///             to 4
/// .pts .ptx   Leica's scans (scan_text.h): intensity, colours; of PTX, all scans in their common frame, the scanner's
///             pose, and NaN where it saw nothing; x y z as float64
/// .e57        ASTM E2807 (e57/reader.h): all scans in their common frame, Cartesian or spherical, every value but
///             texts
/// .xyz .asc .txt .csv
///             a point per line, its values separated by semicolons, commas, tabs or blanks as the first line says.
///             Columns: x y z and then column_4, column_5, ... as float64, unless `columns`, the first line or a
///             comment before it names them (column_names.h). Lines that start with // are comments, and text after a #
///             that begins a line or stands behind a blank. Columns that float64 does not hold are whole numbers of 64
///             bits or text (column_kinds.h), which .csv has again as they were.
///
/// A pipe or standard input (`-`) without such a name is read as PCD, PLY, OFF, LAS, LAZ or E57 if it begins as such a
/// file, and as columns otherwise.
///
/// Fields have PCL's names and meaning: normal_x normal_y normal_z, and rgb or rgba packed from a byte per channel;
/// what files call them, and what stays as it is, says layOutForPcl() in pcl_names.h. The cloud has float32 or float64
/// x y z (integers become float64), at most 2^31 - 1 points, and is_dense as PCL defines
/// it. A file that says it holds no points is an empty cloud.
///
/// In another unit (ReadSettings::to_unit), x y z are float64. The cloud is then no longer what its LAS header says,
/// and CloudFacts has no such header. A remark tells both units. It is refused where nobody tells the file's own. In
/// another coordinate system (ReadSettings::to_crs) the same holds. PROJ transforms each point; remarks tell both
/// systems, the accuracy and the grid scale. Directions (normals, the scanners' rotations) are not turned.
/// @param facts if not null, set to what the file says beside its points
/// @param settings columns of .xyz, .asc, .txt and .csv, whether transforms may scale, one of several scans, units,
///   coordinate systems
///   (read_settings.h)
/// @param threads that unpack LAZ; 0: as many as the caller's oneTBB arena has
/// @throws files::FileError for anything else: missing, unreadable, unknown extension, malformed, truncated, no x y z;
///   for settings of another format; for a matrix that is no rigid motion (rigid_pose.h), with the scan that
///   has it
pcl::PCLPointCloud2 readCloud(const std::filesystem::path& path, CloudFacts* facts = nullptr,
                              const ReadSettings& settings = {}, unsigned threads = 0);

/// A named number of each triangle.
struct FaceValues {
  std::string name;
  std::vector<double> values; ///< NaN where the file gives none
};

/// A cloud and the triangles between its points.
struct Mesh {
  pcl::PCLPointCloud2 vertices;
  std::vector<Triangle> triangles;          ///< empty where the file has no faces
  std::vector<FaceValues> face_values = {}; ///< the properties of a .ply's faces that are numbers
  /// Says what is wrong where the file has no triangles, but lines, edges, free-form surfaces ...: its vertices alone
  /// say less than the file. To be followed by give_corners in messages. Otherwise empty.
  std::string corners_alone = {};
};

/// Reads the faces, too, of .obj, .off, .ply and .stl; of others the points alone. Polygons are cut into triangles.
/// Remarks of `facts` count all else that the file holds beside faces (lines, edges, points of no face ...).
/// Throws as readCloud() does, where a face names a vertex that is not there, and for a mesh of corners_alone.
Mesh readMesh(const std::filesystem::path& path, CloudFacts* facts = nullptr, const ReadSettings& settings = {},
              unsigned threads = 0);

/// As readMesh(), but reads corners_alone, too: for callers that compare nothing, or ask about vertices.
Mesh readMeshOrCorners(const std::filesystem::path& path, CloudFacts* facts = nullptr,
                       const ReadSettings& settings = {}, unsigned threads = 0);

/// The fields of a file's cloud and, where its header says so, the number of its points; the points are not read.
/// Throws as readCloud() does for what a header can tell, and for a pipe.
pcl::PCLPointCloud2 readCloudHeader(const std::filesystem::path& path, const ReadSettings& settings = {});

/// Writes .pcd (binary_compressed; binary from 2 GiB), .ply (binary), .las (las.h), .obj (vertices), .pts or .ptx
/// (scan_text.h), and named columns as .xyz, .asc, .txt and .csv. Fields have the names that readers of the format
/// expect: nx ny nz, and a number per channel of a colour. An rgb has no opacity: its fourth byte is kept by PCD alone.
/// `-` is standard output, as PCD. The file appears complete or not at all; what `path` held before is replaced only
/// then. PCD, PLY and PTX hold a viewpoint. PLY holds no 64-bit integers, text no field with a count, OBJ x y z, a
/// packed colour and normals. LAS and PTS have no place for points without finite coordinates, and leave them out.
/// @param las as CloudFacts has it: kept in a .las
/// @throws files::FileError when the extension is unknown, a field cannot be held, or the disk says no
void writeCloud(const std::filesystem::path& path, const pcl::PCLPointCloud2& cloud,
                const Viewpoint& viewpoint = no_viewpoint, const LasHeaderPtr& las = nullptr);

/// A value per triangle.
struct FaceField {
  std::string name;
  std::variant<const std::vector<std::uint8_t>*, const std::vector<std::int32_t>*, const std::vector<float>*> values;
};

/// Writes a mesh as .ply (binary): vertices with all their fields, and triangles with properties beside their corners.
/// Otherwise as writeCloud(). @pre one value per triangle
/// @throws files::FileError as writeCloud() does, and for a name of another format
void writeMesh(const std::filesystem::path& path, const pcl::PCLPointCloud2& vertices,
               const std::vector<Triangle>& triangles, const std::vector<FaceField>& fields = {},
               const Viewpoint& viewpoint = no_viewpoint);

/// Fails early where writeMesh() would fail because of the path. @throws files::FileError
void requireWritableMesh(const std::filesystem::path& path);

/// Fails early, before hours of work, where writeCloud() would fail because of the path.
/// @throws files::FileError
void requireWritableCloud(const std::filesystem::path& path);

/// Checks also that the format can hold a cloud with these fields.
void requireWritableCloud(const std::filesystem::path& path, pcl::PCLPointCloud2 header);

} // namespace pcl_bsh::io
