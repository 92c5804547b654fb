// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/find_field.h>

#include <boost/predef/other/endian.h>

#include <stdexcept>
#include <string>

namespace pcl_bsh {
namespace {

using Field = pcl::PCLPointField;

std::string fieldNames(const pcl::PCLPointCloud2& cloud)
{
  std::string names;
  for (const Field& field : cloud.fields) names += (names.empty() ? "" : ", ") + field.name;
  return names.empty() ? "no fields" : "the fields " + names;
}

std::string quoted(const std::string& name)
{
  return "field '" + name + "' ";
}

const Field& requiredField(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  if (const Field* field = findField(cloud, name)) return *field;
  throw std::invalid_argument(quoted(name) + "is missing: the cloud has " + fieldNames(cloud) +
                              ", but x, y and z are needed");
}

Scalar scalarOf(const Field& field)
{
  // A count of 0 stands for 1, as everywhere in PCL.
  if (field.count > 1) {
    throw std::invalid_argument(quoted(field.name) + "holds " + std::to_string(field.count) +
                                " values per point: one is needed");
  }
  if (field.datatype == Field::FLOAT32) return Scalar::float32;
  if (field.datatype == Field::FLOAT64) return Scalar::float64;
  throw std::invalid_argument(quoted(field.name) + "has data type " + std::to_string(field.datatype) +
                              ": FLOAT32 (7) or FLOAT64 (8) is needed");
}

void requireReadable(const pcl::PCLPointCloud2& cloud)
{
  if (static_cast<bool>(cloud.is_bigendian) != static_cast<bool>(BOOST_ENDIAN_BIG_BYTE)) {
    throw std::invalid_argument("is_bigendian is " + std::to_string(cloud.is_bigendian) +
                                ": the cloud's byte order must be this machine's");
  }
  const std::size_t row_bytes = std::size_t{cloud.width} * cloud.point_step;
  if (cloud.height > 1 && cloud.row_step != row_bytes) {
    throw std::invalid_argument("row_step is " + std::to_string(cloud.row_step) + " bytes, width * point_step is " +
                                std::to_string(row_bytes) + ": rows must not be padded");
  }
  if (row_bytes > 0 && cloud.data.size() / row_bytes < cloud.height) {
    throw std::invalid_argument("data holds " + std::to_string(cloud.data.size()) + " bytes: too few for " +
                                std::to_string(cloud.height) + " rows of " + std::to_string(row_bytes) + " bytes");
  }
}

} // namespace

PointsView viewOf(const pcl::PCLPointCloud2& cloud)
{
  requireReadable(cloud);

  PointsView view;
  view.data = cloud.data.data();
  view.count = std::size_t{cloud.width} * cloud.height;
  view.stride = cloud.point_step;
  view.scalar = scalarOf(requiredField(cloud, "x"));
  const std::size_t bytes = view.scalar == Scalar::float32 ? sizeof(float) : sizeof(double);

  std::size_t axis = 0;
  for (const char* const name : {"x", "y", "z"}) {
    const Field& field = requiredField(cloud, name);
    if (scalarOf(field) != view.scalar) {
      throw std::invalid_argument(quoted(name) + "is not of the type of field 'x': x, y and z must be of one type");
    }
    // PCL's filters leave an empty cloud with fields but no point_step.
    if (view.count > 0 && field.offset + bytes > cloud.point_step) {
      throw std::invalid_argument(quoted(name) + "at offset " + std::to_string(field.offset) +
                                  " reaches beyond point_step " + std::to_string(cloud.point_step));
    }
    view.offset[axis++] = field.offset;
  }
  return view;
}

} // namespace pcl_bsh
