// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/site/check_site.h>
#include <pcl_bsh/site/tiles/records.h>
#include <pcl_bsh/site/tiles/tile_file.h>

#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::site {

namespace {

bool isSame(const std::optional<Bounds>& a, const std::optional<Bounds>& b)
{
  return a.has_value() == b.has_value() && (!a || (a->low == b->low && a->high == b->high));
}

class Checker {
public:
  explicit Checker(const Site& site) : site_(site)
  {
    // Checks the sizes of files first, before memory is taken for as many points as site.json says.
    for (const Tile& tile : site.tiles) openTile(site.folder / tile.file, site.fields, tile.points);
    const std::filesystem::path overview = site.folder / overview_file_name;
    if (std::filesystem::exists(overview)) openRecords(overview, site.fields);
    for (const Source& source : site.sources) seen_.emplace_back(source.points, false);
  }

  void check(const Tile& tile)
  {
    tile_ = &tile;
    cloud_ = readTile(site_, tile, std::move(cloud_));
    checkMeasures(cloud_);
    checkRecords(cloud_);
  }

  /// Compares the bounds of the site with the union of those of its tiles.
  void checkAll() const
  {
    if (!isSame(all_, site_.bounds))
      throw files::FileError(site_.folder / site_file_name, "its bounds are not those of its tiles",
                             "make the site again");
  }

private:
  [[noreturn]] void fail(const std::string& wrong) const
  {
    throw files::FileError(site_.folder / tile_->file, wrong, "make the site again");
  }

  static std::string named(const SitePoint& name)
  {
    return "has record " + std::to_string(name.record) + " of source " + std::to_string(name.source);
  }

  /// Queries leave out tiles by bounds and greatest values, so none may say less than the points do. A greatest value
  /// that is not there leaves out no tile.
  void checkMeasures(const pcl::PCLPointCloud2& cloud)
  {
    Tile measured;
    measureExtremes(cloud, measured);
    if (!isSame(measured.bounds, tile_->bounds)) fail("its points have other bounds than site.json says");
    for (const auto& [field, greatest] : tile_->greatest) {
      const auto found = measured.greatest.find(field);
      if (found == measured.greatest.end() || found->second != greatest)
        fail("its field '" + field + "' has another greatest value than site.json says");
    }
    if (!measured.bounds) return;
    extend(all_, measured.bounds->low);
    extend(all_, measured.bounds->high);
  }

  void checkRecords(const pcl::PCLPointCloud2& cloud)
  {
    const PointNames names(cloud);
    SitePoint last;
    for (std::size_t i = 0; i < cloud.width; ++i) {
      const SitePoint name = names(cloud.data.data() + i * cloud.point_step);
      const auto [source, record] = name;
      if (source >= seen_.size() || record >= seen_[source].size()) fail(named(name) + ", which there is not");
      if (seen_[source][record]) fail(named(name) + ", which is there twice");
      if (i > 0 && name < last) fail("its points are not in the order of their sources and records");
      seen_[source][record] = true;
      last = name;
    }
  }

  const Site& site_;
  const Tile* tile_ = nullptr;
  pcl::PCLPointCloud2 cloud_;
  std::vector<std::vector<bool>> seen_;
  std::optional<Bounds> all_;
};

} // namespace

void checkSite(const Site& site, const std::function<bool(std::uint64_t, std::uint64_t)>& progress)
{
  Checker checker(site);
  std::uint64_t done = 0;
  for (const Tile& tile : site.tiles) {
    checker.check(tile);
    if (progress && !progress(done += tile.points, site.points)) throw Cancelled();
  }
  checker.checkAll();
}

} // namespace pcl_bsh::site
