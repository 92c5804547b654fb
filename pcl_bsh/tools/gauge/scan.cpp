// SPDX-License-Identifier: BSD-3-Clause
#include "scan.h"

#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/reports/gauge_run.h>
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

} // namespace

GaugeScan::GaugeScan(const GaugeOptions& options)
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
  facts_.remarks = stream->remarks();
  facts_.coordinate_system = stream->coordinateSystem();
  facts_.unit = stream->unit();
}

void GaugeScan::forEachBatch(const std::function<void(const PointsView&, std::uint64_t)>& use)
{
  if (is_whole_) {
    io::forEachGaugeBatch(viewOf(whole_), use);
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
    use(viewOf(batch), first);
    first += count;
  }
}

} // namespace pcl_bsh::cli
