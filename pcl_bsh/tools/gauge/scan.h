// SPDX-License-Identifier: BSD-3-Clause
// The scan of a gauging run, in batches. It may be read again, and may be larger than memory unless it is needed whole.
#pragma once

#include "gauge_options.h"

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/reports/gauge_run.h>

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace pcl_bsh::cli {

class GaugeScan {
public:
  /// A batch of points. Its numbers are as GaugeRun::add() takes them.
  struct Batch {
    const PointsView& points;
    std::uint64_t first;
    const std::uint64_t* numbers;
    double done; ///< the share of the scan that is read after this batch
  };
  using Use = std::function<void(const Batch&)>;

  virtual ~GaugeScan() = default;

  const io::CloudFacts& facts() const { return facts_; }
  const pcl::PCLPointCloud2& whole() const { return whole_; } ///< its fields; points only for OUTPUT or a pipe
  std::uint64_t points() const { return points_; }

  /// Calls `use` for each batch. In an MPI job each batch comes to one process. @throws FileError
  virtual void forEachBatch(const Use& use) = 0;

  /// Merges the runs of all processes: afterwards each has the run of all.
  virtual void join(io::GaugeRun&) {}

  /// As forEachBatch(), in this process alone. Points farther from all these places than `near`, along x or y, may be
  /// left out.
  virtual void forEachBatchNear(const std::vector<Point3>& places, double near, const Use& use) = 0;

protected:
  pcl::PCLPointCloud2 whole_;
  io::CloudFacts facts_;
  std::uint64_t points_ = 0;
};

/// Opens a file, or a site where INPUT is a folder. @throws files::FileError where it cannot be read
std::unique_ptr<GaugeScan> openScan(const GaugeOptions& options);

/// A site; for openScan(). @throws files::FileError, too, in builds without queries of sites
std::unique_ptr<GaugeScan> openSite(const GaugeOptions& options);

/// Whether this process prints and writes. In an MPI job about a site only one process does.
bool tellsAbout(const GaugeOptions& options);

/// Ends all processes of an MPI job about a site, as this one failed; returns where there is no such job.
void endOtherRanks(const GaugeOptions& options, const char* error);

} // namespace pcl_bsh::cli
