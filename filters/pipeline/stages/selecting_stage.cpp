// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/selecting_stage.h>
#include <pcl_bsh/filters/removed_points.h>
#include <pcl_bsh/search/cloud_view.h>

#include <cstring>
#include <limits>

namespace pcl_bsh::pipeline {
namespace {

/// The records of the cloud with these numbers, as one row.
StageCloudPtr recordsOf(const StageCloud& cloud, const pcl::Indices& records)
{
  const auto kept = emptyLike(cloud);
  pcl::PCLPointCloud2& out = kept->cloud;
  const std::size_t step = cloud.cloud.point_step;
  out.width = static_cast<std::uint32_t>(records.size());
  out.row_step = out.width * out.point_step;
  out.data.resize(records.size() * step);
  std::uint8_t* next = out.data.data();
  for (const pcl::index_t i : records) {
    std::memcpy(next, &cloud.cloud.data[static_cast<std::size_t>(i) * step], step);
    next += step;
  }
  return kept;
}

} // namespace

float SelectingStage::filterValue() const
{
  return user_filter_value ? static_cast<float>(*user_filter_value) : std::numeric_limits<float>::quiet_NaN();
}

StageCloudPtr SelectingStage::run(StageClouds&& inputs)
{
  StageCloudPtr input = std::move(inputs[0]);
  pcl::Indices kept;
  pcl::Indices removed;
  {
    const std::vector<std::uint8_t> passes = passing(input);
    const PointsView points = viewOf(input->cloud);
    for (std::uint32_t i = 0; i < points.count; ++i) {
      const bool keep = (passes[i] != 0) != negative && isFinite(points.point(i));
      if (keep && !keep_organized) kept.push_back(static_cast<pcl::index_t>(i));
      if (!keep && keep_organized) removed.push_back(static_cast<pcl::index_t>(i));
    }
  }
  if (!keep_organized) return recordsOf(*input, kept);
  const auto output = ownCloud(std::move(input));
  overwritePoints(output->cloud, removed, filterValue());
  return output;
}

} // namespace pcl_bsh::pipeline
