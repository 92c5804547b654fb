// SPDX-License-Identifier: BSD-3-Clause
#include "viewed_cloud.h"

#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <cstring>

namespace pcl_bsh::viewer {
namespace {

const pcl::PCLPointField* find(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  for (const pcl::PCLPointField& field : cloud.fields)
    if (field.name == name && field.count <= 1) return &field;
  return nullptr;
}

/// Calls use(record, value) with a field's value of each record.
template <class T, class Use>
void eachValue(const pcl::PCLPointCloud2& cloud, const pcl::PCLPointField& field, const Use& use)
{
  const std::size_t count = std::size_t{cloud.width} * cloud.height;
  for (std::size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, cloud.data.data() + i * cloud.point_step + field.offset, sizeof value);
    use(i, value);
  }
}

} // namespace

Point3 ViewedCloud::placeOf(std::uint32_t part) const
{
  if (!hasTriangles()) return points().point(part);
  Point3 sum = {};
  for (const Point3& corner : points().triangles->triangle(part))
    for (std::size_t k = 0; k < 3; ++k) sum[k] += corner[k] / 3.0;
  return sum;
}

Triangle3 ViewedCloud::cornersOf(std::uint32_t part, const Eigen::Isometry3d& pose) const
{
  const Point3 only = points().point(part);
  Triangle3 corners = hasTriangles() ? points().triangles->triangle(part) : Triangle3{only, only, only};
  for (Point3& corner : corners) {
    const Eigen::Vector3d placed = pose * Eigen::Vector3d(corner[0], corner[1], corner[2]);
    corner = {placed.x(), placed.y(), placed.z()};
  }
  return corners;
}

std::optional<std::vector<float>> ViewedCloud::result(const std::string& field_name) const
{
  if (!hasTriangles()) return fieldOfRecords(field_name);
  for (const io::FaceValues& known : face_values)
    if (known.name == field_name) return std::vector<float>(known.values.begin(), known.values.end());
  return std::nullopt;
}

std::optional<std::vector<float>> ViewedCloud::field(const std::string& field_name) const
{
  if (auto known = result(field_name)) return known;
  const auto values = hasTriangles() ? fieldOfRecords(field_name) : std::nullopt;
  if (!values) return std::nullopt;
  std::vector<float> means;
  means.reserve(parts());
  for (const Triangle& t : *surface->triangles())
    means.push_back(((*values)[t[0]] + (*values)[t[1]] + (*values)[t[2]]) / 3.0f);
  return means;
}

std::optional<std::vector<std::array<unsigned char, 3>>> ViewedCloud::colors() const
{
  auto colors = colorsOfRecords();
  if (!colors || !hasTriangles()) return colors;
  std::vector<std::array<unsigned char, 3>> means(parts());
  for (std::size_t i = 0; i < means.size(); ++i) {
    const Triangle& t = (*surface->triangles())[i];
    for (std::size_t k = 0; k < 3; ++k)
      means[i][k] = static_cast<unsigned char>(((*colors)[t[0]][k] + (*colors)[t[1]][k] + (*colors)[t[2]][k]) / 3);
  }
  return means;
}

std::optional<std::vector<float>> ViewedCloud::fieldOfRecords(const std::string& field_name) const
{
  const pcl::PCLPointField* const found = cloud ? find(*cloud, field_name) : nullptr;
  if (!found) return std::nullopt;
  std::vector<float> values(std::size_t{cloud->width} * cloud->height);
  io::withFieldType(found->datatype, [&](auto zero) {
    eachValue<decltype(zero)>(*cloud, *found,
                              [&](std::size_t i, auto value) { values[i] = static_cast<float>(value); });
  });
  return values;
}

std::optional<std::vector<std::array<unsigned char, 3>>> ViewedCloud::colorsOfRecords() const
{
  std::vector<std::array<unsigned char, 3>> colors(std::size_t{cloud->width} * cloud->height);
  for (const char* packed : {"rgb", "rgba"}) {
    const pcl::PCLPointField* const found = find(*cloud, packed);
    if (!found || io::sizeOf(found->datatype) != 4) continue;
    eachValue<std::uint32_t>(*cloud, *found, [&](std::size_t i, std::uint32_t bits) {
      colors[i] = {static_cast<unsigned char>(bits >> 16), static_cast<unsigned char>(bits >> 8),
                   static_cast<unsigned char>(bits)};
    });
    return colors;
  }
  constexpr const char* names[2][3] = {{"red", "green", "blue"}, {"r", "g", "b"}};
  for (const auto& set : names) {
    const pcl::PCLPointField* const channels[3] = {find(*cloud, set[0]), find(*cloud, set[1]), find(*cloud, set[2])};
    if (!channels[0] || !channels[1] || !channels[2]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      // 16 bits a channel where the type says so; fractions of one where it is a real number.
      const std::uint8_t type = channels[k]->datatype;
      const float scale = type == pcl::PCLPointField::UINT16                                           ? 1.0f / 257.0f
                          : type == pcl::PCLPointField::FLOAT32 || type == pcl::PCLPointField::FLOAT64 ? 255.0f
                                                                                                       : 1.0f;
      const std::vector<float> values = *fieldOfRecords(set[k]);
      for (std::size_t i = 0; i < values.size(); ++i)
        colors[i][k] = static_cast<unsigned char>(std::clamp(values[i] * scale, 0.0f, 255.0f));
    }
    return colors;
  }
  return std::nullopt;
}

} // namespace pcl_bsh::viewer
