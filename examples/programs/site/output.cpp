// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "output.h"

#include <pcl_bsh/filters/collision_field.h>

#include <limits>
#include <vector>

namespace pcl_bsh::cli {

namespace {

using Type = pcl::PCLPointField;

/// The fields that each question answers with, as those of pcl_bsh_collide.
std::vector<sites::ResultField> resultFields(SiteQuestion question)
{
  const sites::ResultField collision = {collision_field_name, Type::UINT8, 0.0},
                           distance = {distance_field_name, Type::FLOAT32, std::numeric_limits<double>::quiet_NaN()},
                           first = {first_pose_field_name, Type::INT32, -1.0},
                           closest = {closest_pose_field_name, Type::INT32, -1.0};
  switch (question) {
  case SiteQuestion::flags:
    return {collision};
  case SiteQuestion::distances:
    return {distance};
  case SiteQuestion::path:
    return {collision, distance, first, closest};
  default:
    return {};
  }
}

} // namespace

SiteOutput::SiteOutput(const sites::Site& site, const SiteOptions& options)
{
  if (!options.out.empty()) out_.emplace(site, options.out, resultFields(options.question));
}

sites::FlagsSink SiteOutput::flags()
{
  if (!out_) return nullptr;
  return [this](const sites::Tile& tile, const pcl::PCLPointCloud2& cloud, const FlagsResult& found) {
    out_->write(tile, cloud, {found.a.data()});
  };
}

sites::DistancesSink SiteOutput::distances()
{
  if (!out_) return nullptr;
  return [this](const sites::Tile& tile, const pcl::PCLPointCloud2& cloud, const PointDistances& found) {
    std::vector<float> distance;
    for (const double d : found.distance) distance.push_back(static_cast<float>(d));
    out_->write(tile, cloud, {distance.data()});
  };
}

sites::PassageSink SiteOutput::passage()
{
  if (!out_) return nullptr;
  return [this](const sites::Tile& tile, const pcl::PCLPointCloud2& cloud, const TrajectoryResult& found) {
    out_->write(tile, cloud,
                {found.flags.data(), found.distance.data(), found.first_pose.data(), found.closest_pose.data()});
  };
}

void SiteOutput::finish()
{
  if (out_) out_->finish();
}

} // namespace pcl_bsh::cli
#endif
