// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/faces.h>
#include <pcl_bsh/filters/pipeline/stages/selection/selecting_stage.h>
#include <pcl_bsh/filters/removed_points.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/selected_records.h>

#include <limits>

namespace pcl_bsh::pipeline {

float SelectionOptions::filterValue() const
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
  if (!keep_organized) {
    auto output = emptyLike(*input);
    output->cloud = selectedRecords(input->cloud, kept);
    return output;
  }
  const auto output = ownCloud(std::move(input));
  output->triangles.reset(); // their corners may be removed
  output->face_properties.clear();
  overwritePoints(output->cloud, removed, filterValue());
  return output;
}

StageCloudPtr SelectingStage::keepFaces(const StageCloud& mesh, std::vector<std::uint8_t> passes) const
{
  if (keep_organized)
    throw OptionError("keep_organized", "is about points, and the input is a surface: leave it out, or give "
                                        "`vertices_only`: true");
  for (std::uint8_t& kept : passes) kept = (kept != 0) != negative;
  return keptFaces(mesh, passes);
}

} // namespace pcl_bsh::pipeline
