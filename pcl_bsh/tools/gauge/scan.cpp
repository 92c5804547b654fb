// SPDX-License-Identifier: BSD-3-Clause
#include "scan.h"

#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::cli {
namespace {

constexpr std::size_t batch_points = std::size_t{1} << 18;

std::unique_ptr<io::CloudStream> streamOf(const GaugeOptions& options)
{
  return io::openCloud(options.input, std::numeric_limits<std::uint64_t>::max(), options.reading.of(options.input),
                       options.threads);
}

} // namespace

GaugeScan::GaugeScan(const GaugeOptions& options)
: options_(options),
  is_whole_(!options.output.empty() || io::isPipe(options.input))
{
  if (is_whole_) {
    whole_ = io::readCloud(options.input, &facts_, options.reading.of(options.input), options.threads);
    points_ = viewOf(whole_).count;
    return;
  }
  const std::unique_ptr<io::CloudStream> stream = streamOf(options);
  points_ = stream->size();
  facts_.remarks = stream->remarks();
  facts_.coordinate_system = stream->coordinateSystem();
}

void GaugeScan::forEachBatch(const std::function<void(const PointsView&, std::uint64_t)>& use)
{
  if (is_whole_) {
    PointsView view = viewOf(whole_);
    const std::size_t count = view.count;
    for (std::size_t first = 0; first < count; first += batch_points) {
      PointsView batch = view;
      batch.data = static_cast<const unsigned char*>(view.data) + first * view.stride;
      batch.count = std::min(batch_points, count - first);
      use(batch, first);
    }
    return;
  }
  const std::unique_ptr<io::CloudStream> stream = streamOf(options_);
  pcl::PCLPointCloud2 batch = stream->header();
  batch.data.resize(batch_points * batch.point_step);
  for (std::uint64_t first = 0;;) {
    const std::size_t count = stream->read(batch.data.data(), batch_points);
    if (count == 0) return;
    batch.height = 1;
    batch.width = static_cast<pcl::uindex_t>(count);
    batch.row_step = batch.width * batch.point_step;
    use(viewOf(batch), first);
    first += count;
  }
}

} // namespace pcl_bsh::cli
