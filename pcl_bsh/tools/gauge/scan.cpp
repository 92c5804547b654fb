// SPDX-License-Identifier: BSD-3-Clause
#include "scan.h"

#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/search/cloud_view.h>

#include <limits>

namespace pcl_bsh::cli {
namespace {

std::unique_ptr<io::CloudStream> streamOf(const GaugeOptions& options)
{
  return io::openCloud(options.input, std::numeric_limits<std::uint64_t>::max(), options.reading.ofInput(options.input),
                       options.threads);
}

class FileScan : public GaugeScan {
public:
  explicit FileScan(const GaugeOptions& options)
  : options_(options),
    is_whole_(!options.output.empty() || io::isPipe(options.input))
  {
    if (is_whole_) {
      whole_ = io::readCloud(options.input, &facts_, options.reading.ofInput(options.input), options.threads);
      points_ = viewOf(whole_).count;
      return;
    }
    const std::unique_ptr<io::CloudStream> stream = streamOf(options);
    points_ = stream->size();
    whole_ = stream->header();
    facts_ = stream->facts();
  }

  void forEachBatch(const Use& use) override
  {
    const auto useFrom = [&](const PointsView& points, std::uint64_t first) {
      use({points, first, nullptr, static_cast<double>(first + points.count) / static_cast<double>(points_)});
    };
    if (is_whole_) {
      io::forEachGaugeBatch(viewOf(whole_), useFrom);
      return;
    }
    const std::unique_ptr<io::CloudStream> stream = streamOf(options_);
    pcl::PCLPointCloud2 batch = stream->header();
    batch.data.resize(io::gauge_batch_points * batch.point_step);
    for (std::uint64_t first = 0;;) {
      const std::size_t count = stream->read(batch.data.data(), io::gauge_batch_points);
      if (count == 0) return;
      batch.height = 1;
      batch.width = static_cast<pcl::uindex_t>(count);
      batch.row_step = batch.width * batch.point_step;
      useFrom(viewOf(batch), first);
      first += count;
    }
  }

  void forEachBatchNear(const std::vector<Point3>&, double, const Use& use) override { forEachBatch(use); }

private:
  const GaugeOptions& options_;
  bool is_whole_;
};

} // namespace

std::unique_ptr<GaugeScan> openScan(const GaugeOptions& options)
{
  if (options.isSite()) return openSite(options);
  return std::make_unique<FileScan>(options);
}

} // namespace pcl_bsh::cli
