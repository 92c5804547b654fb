// SPDX-License-Identifier: BSD-3-Clause
// Clouds for the filter tests, and the answer of a plain double loop to compare with.
#pragma once

#include "support/verdicts.h"

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>
#include <pcl/types.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace pcl_bsh::test {

using Points = std::vector<Eigen::Vector3d>;

/// Uniform in a cube of edge 1 around the centre, representable in float32.
inline Points randomPoints(std::size_t count, std::uint32_t seed, const Eigen::Vector3d& centre = {0, 0, 0})
{
  std::mt19937 generator(seed);
  const auto coordinate = [&](double middle) {
    return static_cast<float>(middle + static_cast<double>(generator()) / 4294967296.0 - 0.5);
  };
  Points points(count);
  for (Eigen::Vector3d& p : points) {
    const float x = coordinate(centre.x());
    const float y = coordinate(centre.y());
    const float z = coordinate(centre.z());
    p = {x, y, z};
  }
  return points;
}

inline Eigen::Isometry3d somePose()
{
  Eigen::Isometry3d pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()));
  pose.translation() = Eigen::Vector3d(0.4, -0.3, 0.2);
  return pose;
}

/// One verdict per point of a: it collides if a point of b, posed, is within the clearance. Comparisons with NaN are
/// false.
inline std::vector<Verdict> doubleLoop(const Points& a, const Points& b, const Eigen::Isometry3d& pose,
                                       double clearance)
{
  std::vector<Verdict> flags(a.size(), Verdict::free);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size() && flags[i] == Verdict::free; ++j)
      flags[i] = test::verdictIf((a[i] - pose * b[j]).norm() <= clearance);
  }
  return flags;
}

/// The finite points that are not free, or those that are.
inline pcl::Indices where(const std::vector<Verdict>& flags, bool wanted, const Points& points)
{
  pcl::Indices indices;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (points[i].allFinite() && (flags[i] != Verdict::free) == wanted) indices.push_back(static_cast<pcl::index_t>(i));
  }
  return indices;
}

template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr typedCloud(const Points& points)
{
  auto cloud = std::make_shared<pcl::PointCloud<PointT>>();
  cloud->header.frame_id = "scanner";
  cloud->is_dense = false;
  for (const Eigen::Vector3d& p : points) {
    PointT point{};
    point.x = static_cast<decltype(PointT::x)>(p.x());
    point.y = static_cast<decltype(PointT::y)>(p.y());
    point.z = static_cast<decltype(PointT::z)>(p.z());
    cloud->push_back(point);
  }
  return cloud;
}

/// One row of packed records: a label (UINT16, the point's number), x, y, z, an intensity (FLOAT32).
template <typename Coordinate>
pcl::PCLPointCloud2::Ptr fieldCloud(const Points& points)
{
  auto cloud = std::make_shared<pcl::PCLPointCloud2>();
  const auto field = [&](const std::string& name, std::uint8_t datatype, std::size_t bytes) {
    pcl::PCLPointField added;
    added.name = name;
    added.offset = cloud->point_step;
    added.datatype = datatype;
    added.count = 1;
    cloud->fields.push_back(added);
    cloud->point_step += static_cast<pcl::uindex_t>(bytes);
  };
  field("label", pcl::PCLPointField::UINT16, sizeof(std::uint16_t));
  for (const char* const axis : {"x", "y", "z"}) field(axis, pcl::traits::asEnum_v<Coordinate>, sizeof(Coordinate));
  field("intensity", pcl::PCLPointField::FLOAT32, sizeof(float));

  cloud->header.frame_id = "scanner";
  cloud->width = static_cast<pcl::uindex_t>(points.size());
  cloud->height = 1;
  cloud->row_step = cloud->width * cloud->point_step;
  cloud->data.resize(cloud->row_step);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint8_t* const record = &cloud->data[i * cloud->point_step];
    const auto label = static_cast<std::uint16_t>(i);
    const Eigen::Matrix<Coordinate, 3, 1> xyz = points[i].cast<Coordinate>();
    const float intensity = 0.25f * static_cast<float>(i);
    std::memcpy(record, &label, sizeof label);
    std::memcpy(record + sizeof label, xyz.data(), 3 * sizeof(Coordinate));
    std::memcpy(record + sizeof label + 3 * sizeof(Coordinate), &intensity, sizeof intensity);
  }
  return cloud;
}

/// Bytes of one record.
inline std::vector<std::uint8_t> record(const pcl::PCLPointCloud2& cloud, std::size_t i)
{
  const auto first = cloud.data.begin() + static_cast<std::ptrdiff_t>(i * cloud.point_step);
  return {first, first + cloud.point_step};
}

} // namespace pcl_bsh::test
