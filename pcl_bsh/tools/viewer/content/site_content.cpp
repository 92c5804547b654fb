// SPDX-License-Identifier: BSD-3-Clause
#include "site_content.h"

#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/viewer/actors/text.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/search/cloud_view.h>

#include <utility>

namespace pcl_bsh::viewer {
namespace {

ViewedCloud withoutHierarchy(pcl::PCLPointCloud2&& points, const std::filesystem::path& file)
{
  ViewedCloud viewed;
  viewed.name = file.filename().string();
  viewed.file = file;
  viewed.cloud = std::make_shared<const pcl::PCLPointCloud2>(std::move(points));
  viewed.records = viewOf(*viewed.cloud);
  viewed.records.owner = viewed.cloud;
  return viewed;
}

class TileContent final : public FieldContent {
public:
  TileContent(const Options& options, ViewedCloud&& tile, const site::Site& site, const SharedColors& alike)
  : FieldContent(options),
    site_(site),
    alike_(alike)
  {
    viewed_clouds_.push_back(std::move(tile));
  }

  std::string heading(const StepCollisions& /*collisions*/, std::size_t /*step*/) const override { return {}; }
  const SharedColors* sharedColors() const override { return &alike_; }

  /// Where the point came from.
  std::string details(std::size_t /*cloud*/, std::uint32_t part, std::size_t /*step*/) const override
  {
    const auto source = numberAt(site::source_field_name, part), record = numberAt(site::record_field_name, part);
    if (source >= site_.sources.size()) return {};
    return "; record " + std::to_string(record) + " of " + site_.sources[source].file;
  }

private:
  std::uint32_t numberAt(const char* field_name, std::uint32_t part) const
  {
    const pcl::PCLPointCloud2& cloud = *scan().cloud;
    std::uint32_t number = 0;
    for (const pcl::PCLPointField& field : cloud.fields)
      if (field.name == field_name)
        std::memcpy(&number, cloud.data.data() + std::size_t{part} * cloud.point_step + field.offset, sizeof number);
    return number;
  }

  const site::Site& site_;
  const SharedColors& alike_;
};

} // namespace

SiteContent::SiteContent(const Options& options) : FieldContent(options), site_(site::readSite(*options.site))
{
  cli::Step step("Loading the overview of " + site_.folder.string());
  const std::filesystem::path file = site_.folder / site::overview_file_name;
  if (!std::filesystem::exists(file))
    throw files::FileError(file, "the overview of the site is missing", "copy it back, or make the site again");
  ViewedCloud overview = withoutHierarchy(io::readCloud(file), file);
  overview.name = std::filesystem::weakly_canonical(site_.folder).filename().string();
  overview.legend = "points";
  HierarchyOptions how;
  how.threads = options.question.threads;
  overview.hierarchy = std::make_shared<SphereHierarchy>(overview.records, how);
  if (overview.hierarchy->empty())
    throw files::FileError(file, "has no finite point to show", "make the site of others");
  const std::uint64_t points = overview.records.count;
  if (points > options.budget)
    throw cli::UsageError("--budget: " + counted(options.budget, "point") + ": the overview alone has " +
                          std::to_string(points) + ": give more");
  tile_points_ = points == site_.points ? 0 : options.budget - points; // an overview of all points needs no tiles
  viewed_clouds_.push_back(std::move(overview));
  step.done(counted(points, "point"));
  std::size_t large = 0;
  for (const site::Tile& tile : site_.tiles) large += points < site_.points && tile.points > tile_points_ ? 1 : 0;
  if (large > 0)
    cli::warn(program, {site_.folder.string() + ": " + std::to_string(large) + " of " +
                        counted(site_.tiles.size(), "tile has", "tiles have") +
                        " more points than the overview leaves of the budget, and are not drawn: give a "
                        "greater --budget"});
}

std::string SiteContent::heading(const StepCollisions& /*collisions*/, std::size_t /*step*/) const
{
  return name() + ": " + groupedCount(site_.points, "point") + " in " + groupedCount(site_.tiles.size(), "tile");
}

std::unique_ptr<ViewContent> SiteContent::readTile(std::size_t tile, const SharedColors& alike) const
{
  const site::Tile& is = site_.tiles[tile];
  return std::make_unique<TileContent>(options_, withoutHierarchy(site::readTile(site_, is), site_.folder / is.file),
                                       site_, alike);
}

} // namespace pcl_bsh::viewer
