// SPDX-License-Identifier: BSD-3-Clause
// A site as the scan: its tiles, dealt to the processes of an MPI job.
#include "scan.h"

#include <pcl_bsh/io/files/file_error.h>

#ifdef PCL_BSH_SITE_QUERIES
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/ask_site.h>
#include <pcl_bsh/site/site.h>
#include <pcl_bsh/site/tiles/records.h>
#include <pcl_bsh/site/tiles/tile_visitor.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <numeric>
#endif

namespace pcl_bsh::cli {

#ifdef PCL_BSH_SITE_QUERIES
namespace {

/// A point's number counts the records of the sources, one after the other, so that answers are those of one file.
class SiteScan : public GaugeScan {
public:
  explicit SiteScan(const GaugeOptions& options) : site_(site::readSite(options.input))
  {
    whole_.fields = site_.fields;
    whole_.point_step = static_cast<pcl::uindex_t>(site::recordBytes(site_));
    facts_.coordinate_system.name = site::coordinateSystemOf(site_);
    points_ = site_.points;
    for (const site::Source& source : site_.sources)
      first_of_source_.push_back(first_of_source_.back() + source.points);
  }

  void forEachBatch(const Use& use) override
  {
    std::vector<std::uint32_t> tiles(site_.tiles.size());
    std::iota(tiles.begin(), tiles.end(), 0U);
    site::TileVisitor visitor(site_, std::numeric_limits<std::uint64_t>::max());
    visitor.visitAll(tiles, [&](const site::Tile&, const pcl::PCLPointCloud2& cloud) {
      useTile(cloud, static_cast<double>(visitor.place() + 1) / static_cast<double>(tiles.size()), use);
    });
  }

  void join(io::GaugeRun& run) override
  {
    if (site::ranks() > 1) run.join([](const auto& own) { return site::gatheredFromAllRanks(own); });
  }

  void forEachBatchNear(const std::vector<Point3>& places, double near, const Use& use) override
  {
    pcl::PCLPointCloud2 cloud;
    for (std::size_t i = 0; i < site_.tiles.size(); ++i) {
      const site::Tile& tile = site_.tiles[i];
      const auto comes_near = [&](const Point3& place) {
        return place[0] >= tile.bounds->low[0] - near && place[0] <= tile.bounds->high[0] + near &&
               place[1] >= tile.bounds->low[1] - near && place[1] <= tile.bounds->high[1] + near;
      };
      if (!tile.bounds || std::none_of(places.begin(), places.end(), comes_near)) continue;
      cloud = site::readTile(site_, tile, std::move(cloud));
      useTile(cloud, static_cast<double>(i + 1) / static_cast<double>(site_.tiles.size()), use);
    }
  }

private:
  void useTile(const pcl::PCLPointCloud2& cloud, double done, const Use& use)
  {
    const site::PointNames names(cloud);
    const PointsView all = viewOf(cloud);
    numbers_.resize(all.count);
    for (std::size_t i = 0; i < all.count; ++i) {
      const site::SitePoint name = names(cloud.data.data() + i * cloud.point_step);
      if (name.source >= site_.sources.size() || name.record >= site_.sources[name.source].points)
        throw files::FileError(site_.folder, "its tiles do not hold each record once", "make the site again");
      numbers_[i] = first_of_source_[name.source] + name.record;
    }
    io::forEachGaugeBatch(all, [&](const PointsView& points, std::uint64_t first) {
      use({points, 0, numbers_.data() + first, done});
    });
  }

  site::Site site_;
  std::vector<std::uint64_t> first_of_source_ = {0};
  std::vector<std::uint64_t> numbers_; ///< of the tile's records
};

} // namespace

std::unique_ptr<GaugeScan> openSite(const GaugeOptions& options)
{
  return std::make_unique<SiteScan>(options);
}

bool tellsAbout(const GaugeOptions& options)
{
  return !options.isSite() || site::rankHere() == 0;
}

void endOtherRanks(const GaugeOptions& options, const char* error)
{
  if (!options.isSite() || site::ranks() == 1) return;
  std::cerr << gauge_program << ": rank " << site::rankHere() << ": " << error << '\n';
  site::endAllRanks();
}

#else
std::unique_ptr<GaugeScan> openSite(const GaugeOptions& options)
{
  throw files::FileError(options.input, "is a folder, and this build asks nothing about sites",
                         "build it where DIY and MPI are (libvtk9-dev, libopenmpi-dev)");
}

bool tellsAbout(const GaugeOptions&)
{
  return true;
}

void endOtherRanks(const GaugeOptions&, const char*)
{
}
#endif

} // namespace pcl_bsh::cli
