// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/clouds/ply/camera.h>
#include <pcl_bsh/io/clouds/ply/ply.h>
#include <pcl_bsh/io/clouds/ply/types.h>
#include <pcl_bsh/io/clouds/records.h>

#include <bit>
#include <sstream>
#include <type_traits>
#include <variant>

namespace pcl_bsh::io {

namespace {

std::string_view plyName(const pcl::PCLPointField& field)
{
  const std::uint8_t datatype =
      field.datatype == pcl::PCLPointField::BOOL ? std::uint8_t{pcl::PCLPointField::UINT8} : field.datatype;
  for (const PlyType& type : ply_types) {
    if (type.datatype == datatype) return type.name;
  }
  throw FormatError("field '" + field.name + "' has a type that PLY does not know", "write a .pcd instead");
}

template <typename Value>
constexpr std::string_view faceType()
{
  if constexpr (std::is_same_v<Value, std::uint8_t>) return "uchar";
  return std::is_same_v<Value, std::int32_t> ? "int" : "float";
}

std::string facesHeader(std::size_t triangles, const std::vector<FaceField>& fields)
{
  std::string header = "element face " + std::to_string(triangles) + "\nproperty list uchar int vertex_indices\n";
  for (const FaceField& field : fields) {
    std::visit(
        [&]<typename Value>(const std::vector<Value>*) { header += "property " + std::string(faceType<Value>()); },
        field.values);
    header += ' ' + field.name + '\n';
  }
  return header;
}

void writeFaces(std::ostream& out, const std::vector<Triangle>& triangles, const std::vector<FaceField>& fields)
{
  std::string rows;
  const auto append = [&rows](const auto& value) { rows.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    append(std::uint8_t{3});
    for (const std::uint32_t corner : triangles[t]) append(corner); // below 2^31, as int has it
    for (const FaceField& field : fields) std::visit([&](const auto* values) { append((*values)[t]); }, field.values);
    if (rows.size() < std::size_t{1} << 20) continue;
    out << rows;
    rows.clear();
  }
  out << rows;
}

/// @param faces of an element `face`, or empty
/// @param camera null: none
std::string headerOf(const pcl::PCLPointCloud2& cloud, const Fields& fields, const std::string& faces,
                     const Viewpoint* camera)
{
  std::ostringstream header;
  header.imbue(std::locale::classic());
  header << "ply\nformat binary_" << (std::endian::native == std::endian::little ? "little" : "big") << "_endian 1.0\n";
  if (camera) header << cameraComment(*camera);
  if (cloud.height > 1) {
    header << "obj_info num_cols " << cloud.width << "\nobj_info num_rows " << cloud.height << '\n';
  }
  header << "element vertex " << std::uint64_t{cloud.width} * cloud.height << '\n';
  for (const pcl::PCLPointField& field : fields) {
    header << "property " << (field.count > 1 ? "list uint " : "") << plyName(field) << ' ' << field.name << '\n';
  }
  header << faces;
  if (camera) {
    header << "element camera 1\n";
    for (const PlyCameraValue& value : ply_camera_values) {
      header << "property " << (value.whole ? "int " : "float ") << value.name << '\n';
    }
  }
  header << "end_header\n";
  return header.str();
}

template <typename WriteFaces>
void write(std::ostream& out, const pcl::PCLPointCloud2& cloud, const std::string& faces, const Viewpoint& viewpoint,
           const WriteFaces& write_faces)
{
  const Fields fields = namedForFiles(namedFields(cloud), ply_channels);
  const bool camera = viewpoint != no_viewpoint;
  out << headerOf(cloud, fields, faces, camera ? &viewpoint : nullptr);
  forEachPackedBlock(cloud, fields, Lists::counted, [&](std::string_view block) { out << block; });
  write_faces();
  if (camera) out << cameraRow(viewpoint, cloud.width, cloud.height);
}

} // namespace

void writePly(std::ostream& out, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint)
{
  write(out, cloud, "", viewpoint, [] {});
}

void writePlyMesh(std::ostream& out, const pcl::PCLPointCloud2& vertices, const std::vector<Triangle>& triangles,
                  const std::vector<FaceField>& fields, const Viewpoint& viewpoint)
{
  write(out, vertices, facesHeader(triangles.size(), fields), viewpoint, [&] { writeFaces(out, triangles, fields); });
}

} // namespace pcl_bsh::io
