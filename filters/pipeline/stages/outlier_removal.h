// SPDX-License-Identifier: BSD-3-Clause
// Stages that remove outliers by one of PCL's filters.
#pragma once

#include <pcl_bsh/filters/pipeline/stages/float_cloud.h>
#include <pcl_bsh/filters/pipeline/stages/selecting_stage.h>

#include <pcl/filters/filter_indices.h>

#include <memory>

namespace pcl_bsh::pipeline {

/// Gives PCL's filter the finite points in float32, and warns where their rounding matters.
struct OutlierRemoval : SelectingStage {
protected:
  using Filter = pcl::FilterIndices<pcl::PointXYZ>;

  /// PCL's filter with the stage's options. @throws OptionError when it cannot take so few points
  virtual std::unique_ptr<Filter> filterFor(const FloatCloud& points) const = 0;

  /// The length that distances between neighbours are compared with.
  virtual double comparedLength(const PointsView& view, const FloatCloud& points) const = 0;

  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) final;
};

} // namespace pcl_bsh::pipeline
