// SPDX-License-Identifier: BSD-3-Clause
// The scan of a gauging run, batch by batch: more than once, and larger than memory where nothing wants it whole.
#pragma once

#include "gauge_options.h"

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/io/clouds/cloud_file.h>

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

class GaugeScan {
public:
  /// @throws files::FileError where it cannot be read
  explicit GaugeScan(const GaugeOptions& options);

  const std::vector<std::string>& remarks() const { return facts_.remarks; }
  const io::CloudFacts& facts() const { return facts_; }
  const pcl::PCLPointCloud2& whole() const { return whole_; } ///< its fields; its points only if OUTPUT is written
  std::uint64_t points() const { return points_; }

  /// Calls use(points, number of the first one) for each batch, from the first point to the last. @throws FileError
  void forEachBatch(const std::function<void(const PointsView&, std::uint64_t)>& use);

private:
  const GaugeOptions& options_;
  bool is_whole_;
  pcl::PCLPointCloud2 whole_;
  io::CloudFacts facts_;
  std::uint64_t points_ = 0;
};

} // namespace pcl_bsh::cli
