// SPDX-License-Identifier: BSD-3-Clause
// Stages that keep some of the points as they are and remove the others: what pcl::FilterIndices is to PCL's filters.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_type.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::pipeline {

/// The options that all of them have.
struct SelectionOptions {
  bool negative = false;
  bool keep_organized = false;
  std::optional<double> user_filter_value;

protected:
  /// Coordinate of removed points in an organised cloud.
  float filterValue() const;
};

/// Kept points keep every byte of their records, so float64 coordinates too. Points that are not finite are removed.
struct SelectingStage : Stage, SelectionOptions {
  StageCloudPtr run(StageClouds&& inputs) override;

protected:
  /// The triangles that pass, and the vertices that they use. @throws OptionError for `keep_organized`
  StageCloudPtr keepFaces(const StageCloud& mesh, std::vector<std::uint8_t> passes) const;

  /// One per record: 1 for records that the stage lets pass when `negative` is false. Entries of points that are not
  /// finite do not count.
  virtual std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) = 0;
};

/// Adds the SelectionOptions.
template <typename S>
StageDescription<S>& withSelectionOptions(StageDescription<S>& description)
{
  return description
      .option(&SelectionOptions::negative, "negative", "keep what would be removed, remove what would be kept")
      .option(&SelectionOptions::keep_organized, "keep_organized",
              "keep rows and columns: removed points get `user_filter_value` as coordinates")
      .option(&SelectionOptions::user_filter_value, "user_filter_value",
              "x, y and z of removed points in an organised cloud; null: NaN");
}

} // namespace pcl_bsh::pipeline
