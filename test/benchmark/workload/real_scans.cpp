// SPDX-License-Identifier: BSD-3-Clause
#include "real_scans.h"

#include <pcl/common/point_tests.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <filesystem>
#include <stdexcept>

namespace pcl_bsh::bench {
namespace {

std::optional<Points> load(const std::filesystem::path& file)
{
  if (!std::filesystem::exists(file)) return std::nullopt;
  pcl::PointCloud<pcl::PointXYZ> cloud;
  if (pcl::io::loadPCDFile(file.string(), cloud) != 0) throw std::runtime_error(file.string() + ": not a readable PCD");
  Points points;
  points.reserve(cloud.size());
  for (const auto& p : cloud)
    if (pcl::isFinite(p)) points.push_back({p.x, p.y, p.z});
  return points;
}

/// lidar_sweep_b in the frame of lidar_sweep_a, as published with the scans; given to six digits.
constexpr RigidPose kSweepPose = {
    {0.999925, 0.0121483, -0.00177009, -0.0121523, 0.999924, -0.00228657, 0.00174218, 0.00230791, 0.999996},
    {0.488882, 0.121214, -0.0253342}};

RigidPose pushed(double x)
{
  return {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {x, 0, 0}};
}

} // namespace

std::optional<ScanPair> realPair(const std::string& scene, const std::string& folder)
{
  const std::filesystem::path data(folder);
  ScanPair pair;
  if (scene == "lidar") {
    const auto a = load(data / "lidar_sweep_a.pcd"), b = load(data / "lidar_sweep_b.pcd");
    if (!a || !b) return std::nullopt;
    pair = {*a, moved(*b, kSweepPose), 0.0};
  }
  else if (scene == "lion") {
    const auto lion = load(data / "statue_lion_takanawa.pcd");
    if (!lion) return std::nullopt;
    pair = {*lion, moved(*lion, pushed(0.05)), 0.0};
  }
  else if (scene == "autzen") {
    const auto all = load(data / "airborne_autzen_stadium_local.pcd");
    if (!all) return std::nullopt;
    for (std::size_t i = 0; i < all->size(); ++i) (i % 2 == 0 ? pair.a : pair.b).push_back((*all)[i]);
    pair.b = moved(pair.b, pushed(30.0));
  }
  else {
    throw std::invalid_argument("scene '" + scene + "' is unknown: use lidar, lion or autzen");
  }
  pair.spacing = medianSpacing(pair.a);
  return pair;
}

} // namespace pcl_bsh::bench
