// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/files/file_error.h>
#include <pcl_bsh/filters/cloud_files/cloud_stream.h>
#include <pcl_bsh/hierarchy/retained_memory.h>
#include <pcl_bsh/query/cancelled.h>
#include <pcl_bsh/site/density_tree.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/records.h>
#include <pcl_bsh/site/tile_file.h>
#include <pcl_bsh/site/unfinished_site.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace pcl_bsh::sites {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t batch_bytes = std::size_t{4} << 20;

std::string megabytes(std::uint64_t bytes)
{
  return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB";
}

void check(const std::vector<fs::path>& clouds, const MakeOptions& options)
{
  if (clouds.empty()) throw std::invalid_argument("there is no cloud to make a site of: name one");
  if (options.memory < std::uint64_t{64} << 20)
    throw std::invalid_argument("memory " + megabytes(options.memory) + " is too little: give 64 MiB or more");
  if (options.tile_points < 1 || options.tile_points > io::max_points)
    throw std::invalid_argument("a tile of " + std::to_string(options.tile_points) +
                                " points cannot be: give from 1 to 2147483647");
}

/// The clouds one after the other, twice.
class Maker {
public:
  Maker(const std::vector<fs::path>& clouds, const fs::path& folder, const MakeOptions& options)
  : clouds_(clouds),
    options_(options),
    folder_(folder),
    tree_(options.tile_points)
  {
    check(clouds, options);
  }

  Site make()
  {
    describe();
    UnfinishedSite unfinished(folder_);
    unfinished_ = &unfinished;
    site_.folder = folder_;
    count();
    deal();
    measureTiles();
    unfinished.finish(site_);
    return std::move(site_);
  }

private:
  std::unique_ptr<io::CloudStream> open(std::size_t cloud) const
  {
    return io::openCloud(clouds_[cloud], options_.memory / 2);
  }

  /// Of all clouds the fields and the numbers of points, before anything is written.
  void describe()
  {
    std::vector<Fields> fields;
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
      const auto stream = open(i);
      if (stream->size() > std::numeric_limits<std::uint32_t>::max())
        throw files::FileError(clouds_[i], "has more points than a number of 32 bits can count", "split the cloud");
      fields.push_back(packed(stream->header()));
      site_.sources.push_back({clouds_[i].string(), stream->size(), fields.back()});
      site_.points += stream->size();
    }
    site_.fields = united(fields, clouds_);
    layout_ = layoutOf(site_.fields);
    // A tile and its hierarchy, which takes at most twice 32 bytes for each point while it is built.
    const std::uint64_t tile = std::min(options_.tile_points, site_.points) * (layout_.point_step + 64);
    if (tile > options_.memory) {
      throw std::invalid_argument("a tile of " + std::to_string(options_.tile_points) + " points needs " +
                                  megabytes(tile) + ", more than the memory given: make tiles smaller, or give more");
    }
  }

  /// Calls use(source, record, its bytes, the point) for all records of all clouds.
  template <typename Use>
  void forEachRecord(MakeStep step, const Use& use)
  {
    std::uint64_t done = 0;
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
      const auto stream = open(i);
      const pcl::PCLPointCloud2& header = stream->header();
      if (stream->size() != site_.sources[i].points) failAsChanged(i);
      const std::size_t most = std::max<std::size_t>(batch_bytes / header.point_step, 1);
      std::vector<std::uint8_t> batch(most * header.point_step);
      const PointsView view = viewOfRecords(header, batch.data(), most);
      begin(header);
      std::uint32_t record = 0;
      while (const std::size_t points = stream->read(batch.data(), most)) {
        for (std::uint32_t k = 0; k < points; ++k, ++record)
          use(static_cast<std::uint32_t>(i), record, batch.data() + std::size_t{k} * header.point_step, view.point(k));
        tell(step, done += points, site_.points);
      }
    }
  }

  void begin(const pcl::PCLPointCloud2& header) { copy_.emplace(io::namedFields(header), layout_); }

  void tell(MakeStep step, std::uint64_t done, std::uint64_t all) const
  {
    if (options_.progress && !options_.progress(step, done, all)) throw Cancelled();
  }

  [[noreturn]] void failAsChanged(std::size_t cloud) const
  {
    throw files::FileError(clouds_[cloud], "has changed while it was read", "make the site when it is complete");
  }

  void count()
  {
    forEachRecord(MakeStep::count, [&](std::uint32_t, std::uint32_t, const std::uint8_t*, const Point3& point) {
      if (!isFinite(point)) return;
      tree_.add(point);
      extend(site_.bounds, point);
      if (tree_.bytes() > options_.memory / 4) failAsTooFine();
    });
    planned_ = tree_.plan();
    if (tree_.bytes() > options_.memory / 4) failAsTooFine();
  }

  [[noreturn]] void failAsTooFine() const
  {
    throw std::invalid_argument("tiles of " + std::to_string(options_.tile_points) + " points are too many for " +
                                megabytes(options_.memory) + ": make tiles larger, or give more memory");
  }

  void deal()
  {
    // One tile more for points that are nowhere.
    open_.resize(std::size_t{planned_} + 1);
    const std::size_t step = layout_.point_step;
    constexpr std::size_t largest = std::size_t{4} << 20;
    buffer_ = static_cast<std::size_t>(std::min<std::uint64_t>(largest, options_.memory / 4 / open_.size()));
    if (buffer_ < step) failAsTooFine();
    std::vector<std::uint8_t> site_record(step);
    const std::size_t source_at = offsetOf(layout_, source_field_name),
                      record_at = offsetOf(layout_, record_field_name);
    beginOverview();
    std::uint64_t number = 0;
    const auto place = [&](std::uint32_t source, std::uint32_t record, const std::uint8_t* bytes, const Point3& point) {
      (*copy_)(bytes, site_record.data());
      std::memcpy(site_record.data() + source_at, &source, sizeof source);
      std::memcpy(site_record.data() + record_at, &record, sizeof record);
      tileFor(isFinite(point) ? tree_.tileOf(point) : planned_).add(site_record.data(), step);
      if (overview_ && number++ % overview_every_ == 0) overview_->add(site_record.data(), step);
    };
    forEachRecord(MakeStep::deal, place);
    for (TileFile& file : files_) file.finish();
    if (overview_) overview_->finish();
    std::uint64_t dealt = 0;
    for (const TileFile& file : files_) dealt += file.points();
    if (dealt != site_.points)
      throw files::FileError(folder_, "a cloud has changed while it was read", "make it again");
  }

  /// The file of a tile, which is followed by another one when it is full: so many points at one place.
  TileFile& tileFor(std::uint32_t tile)
  {
    std::optional<std::size_t>& file = open_[tile];
    if (!file || files_[*file].points() == options_.tile_points) {
      if (file) files_[*file].finish();
      file = files_.size();
      files_.emplace_back(unfinished_->add(tileFileName(files_.size())), site_.fields, buffer_);
    }
    return files_[*file];
  }

  void beginOverview()
  {
    const std::uint64_t most = std::min(options_.overview_points, site_.points);
    if (most == 0) return;
    overview_every_ = (site_.points + most - 1) / most;
    overview_.emplace(unfinished_->add(overview_file_name), site_.fields, batch_bytes);
  }

  void measureTiles()
  {
    std::uint64_t done = 0;
    for (const TileFile& file : files_) {
      Tile tile;
      tile.file = fs::path(tiles_folder_name) / file.path().filename();
      tile.points = file.points();
      measure(loadTile(file.path(), site_.fields, tile.points), tile);
      site_.tiles.push_back(std::move(tile));
      tell(MakeStep::measure, done += file.points(), site_.points);
    }
  }

  const std::vector<fs::path>& clouds_;
  const MakeOptions& options_;
  const fs::path folder_;
  Site site_;
  pcl::PCLPointCloud2 layout_;
  DensityTree tree_;
  std::uint32_t planned_ = 0;
  UnfinishedSite* unfinished_ = nullptr;
  std::size_t buffer_ = 0;
  std::vector<TileFile> files_;
  std::vector<std::optional<std::size_t>> open_; ///< of each tile planned, the file that takes its points
  std::optional<TileFile> overview_;
  std::uint64_t overview_every_ = 1;
  std::optional<RecordCopy> copy_;
};

} // namespace

Site makeSite(const std::vector<fs::path>& clouds, const fs::path& folder, const MakeOptions& options)
{
  return Maker(clouds, folder, options).make();
}

} // namespace pcl_bsh::sites
