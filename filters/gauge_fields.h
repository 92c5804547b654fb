// SPDX-License-Identifier: BSD-3-Clause
// A gauging run as fields of its cloud, gathered batch by batch.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/track/origin_path.h>
#include <pcl_bsh/track/tracks.h>

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// `chainage` (FLOAT64), `offset`, `height` and `clearance` (FLOAT32, NaN without one), `envelope` (INT32, -1 where no
/// envelope of its track counts) and `place` (UINT8, a PlaceState). Where tracks have names, `track` (INT32), too: the
/// index of the track that the point's values are of, or -1.
class GaugeFields {
public:
  /// @param tracks all of them, at least one
  explicit GaugeFields(const std::vector<Track>& tracks) : has_names_(!tracks.front().name.empty()) {}

  /// Takes the answer of gauge() for the next points.
  void add(const std::vector<Track>& tracks, const GaugedTracks& found);

  /// For withFields(). Borrowed.
  std::vector<NewField> fields() const;

private:
  bool has_names_;
  std::vector<double> chainage_;
  std::vector<float> offset_, height_, clearance_;
  std::vector<std::int32_t> envelope_, track_;
  std::vector<std::uint8_t> place_;
};

/// Returns where the records of a cloud hold their times.
/// @param name of the field; empty: the first of gps_time, time, timestamp, timeStamp and t
/// @throws InvalidInput naming the field that is missing, or of another type than FLOAT32 and FLOAT64
TimeField timeFieldOf(const pcl::PCLPointCloud2& cloud, const std::string& name);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
