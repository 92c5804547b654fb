// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/cloud_files/pcl_names.h>
#include <pcl_bsh/filters/cloud_files/ply.h>
#include <pcl_bsh/filters/cloud_files/ply_camera.h>
#include <pcl_bsh/filters/cloud_files/ply_types.h>
#include <pcl_bsh/filters/cloud_files/records.h>

#include <bit>
#include <sstream>

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

std::string headerOf(const pcl::PCLPointCloud2& cloud, const Fields& fields, bool camera)
{
  std::ostringstream header;
  header.imbue(std::locale::classic());
  header << "ply\nformat binary_" << (std::endian::native == std::endian::little ? "little" : "big") << "_endian 1.0\n";
  if (cloud.height > 1) {
    header << "obj_info num_cols " << cloud.width << "\nobj_info num_rows " << cloud.height << '\n';
  }
  header << "element vertex " << std::uint64_t{cloud.width} * cloud.height << '\n';
  for (const pcl::PCLPointField& field : fields) {
    header << "property " << (field.count > 1 ? "list uint " : "") << plyName(field) << ' ' << field.name << '\n';
  }
  if (camera) {
    header << "element camera 1\n";
    for (const PlyCameraValue& value : ply_camera_values) {
      header << "property " << (value.whole ? "int " : "float ") << value.name << '\n';
    }
  }
  header << "end_header\n";
  return header.str();
}

} // namespace

void writePly(std::ostream& out, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint)
{
  const Fields fields = namedForFiles(namedFields(cloud), ply_channels);
  const bool camera = viewpoint != no_viewpoint;
  out << headerOf(cloud, fields, camera);
  forEachPackedBlock(cloud, fields, Lists::counted, [&](std::string_view block) { out << block; });
  if (camera) out << cameraRow(viewpoint, cloud.width, cloud.height);
}

} // namespace pcl_bsh::io
