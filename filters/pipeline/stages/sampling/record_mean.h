// SPDX-License-Identifier: BSD-3-Clause
// Makes one record of several, as pcl::CentroidPoint does of typed points, for clouds whose fields are known at run
// time.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_cloud.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh::pipeline {

/// Floating-point fields: the mean, computed in double relative to the first value, so that georeferenced coordinates
/// keep their digits. Fields rgb and rgba: the mean of each channel. Fields normal_x, normal_y, normal_z: the mean,
/// scaled to length 1. Integers, which may be labels: the value that occurs most often, the least of several.
class RecordMeans {
public:
  /// @param cloud must outlive this
  /// @param all_fields otherwise only of x, y and z; the others are the first record's
  RecordMeans(const StageCloud& cloud, bool all_fields);

  /// Reserves memory for so many points: growing step by step takes up to three times as much.
  void reserve(std::size_t points) { output_->cloud.data.reserve(points * cloud_.point_step); }

  /// Adds one point, the mean of these records, of which there is at least one.
  void add(const std::vector<std::uint32_t>& records);

  /// All that was added, as one row.
  StageCloudPtr finished();

private:
  enum class How : std::uint8_t { mean, channels, most_frequent };
  struct Part {
    std::size_t offset;
    std::uint8_t datatype;
    How how;
  };

  void combine(const Part& part, const std::vector<std::uint32_t>& records, std::uint8_t* record) const;
  void normalise(std::uint8_t* record) const;

  const pcl::PCLPointCloud2& cloud_;
  std::shared_ptr<StageCloud> output_;
  std::vector<Part> parts_;                 ///< of a field with a count, one for each
  std::vector<std::size_t> normal_offsets_; ///< three, or none
};

} // namespace pcl_bsh::pipeline
