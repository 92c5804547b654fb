// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/retained_memory.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/making/density_tree.h>
#include <pcl_bsh/site/making/make_state.h>
#include <pcl_bsh/site/making/unfinished_site.h>
#include <pcl_bsh/site/tiles/checksum.h>
#include <pcl_bsh/site/tiles/records.h>
#include <pcl_bsh/site/tiles/tile_file.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace pcl_bsh::site {

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
    throw std::invalid_argument("a tile of " + counted(options.tile_points, "point") +
                                " cannot be: give from 1 to 2147483647");
}

/// Makes a site. Reads the clouds one after the other, twice.
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
    const std::uint64_t least_tiles = site_.points / options_.tile_points + 1;
    const std::uint64_t overview = std::min(options_.overview_points, site_.points);
    UnfinishedSite unfinished(folder_, UnfinishedSite::Use::continuable,
                              diskSpaceOf(site_.fields, site_.points, least_tiles, overview));
    unfinished_ = &unfinished;
    site_.folder = folder_;
    if (unfinished.wasSaved())
      goOn();
    else
      count();
    deal();
    measureTiles();
    unfinished.finish(site_);
    return std::move(site_);
  }

private:
  io::ColumnNames columnsOf(const fs::path& file) const
  {
    return options_.columns ? options_.columns(file) : io::ColumnNames();
  }

  std::unique_ptr<io::CloudStream> open(std::size_t cloud) const
  {
    const fs::path& file = clouds_[cloud];
    const bool may_have_scans = io::mayHaveScans(io::extensionOf(file));
    io::ReadSettings reading(columnsOf(file), options_.allow_scale, may_have_scans ? options_.scan : std::nullopt);
    if (!options_.unit.empty()) reading.unit = io::lengthUnitOf(options_.unit);
    if (!options_.to_unit.empty()) reading.to_unit = io::lengthUnitOf(options_.to_unit);
    reading.crs = options_.crs;
    reading.to_crs = options_.to_crs;
    return io::openCloud(file, options_.memory / 2, reading, options_.threads);
  }

  /// Reads the fields and the numbers of points of all clouds, before anything is written.
  void describe()
  {
    std::vector<Fields> fields;
    std::pair<std::size_t, io::CoordinateSystem> first_named;
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
      const auto stream = open(i);
      if (!options_.vertices_only && io::hasFaces(clouds_[i])) {
        throw files::FileError(clouds_[i], "has faces, which a site cannot hold",
                               "take its vertices alone (--vertices-only), or ask about it as the obstacle of a site");
      }
      if (stream->size() > std::numeric_limits<std::uint32_t>::max())
        throw files::FileError(clouds_[i], "has more points than a number of 32 bits can count", "split the cloud");
      const io::CloudFacts facts = stream->facts();
      if (options_.remark && !facts.remarks.empty()) options_.remark(clouds_[i], facts.remarks);
      fields.push_back(packed(stream->header()));
      const io::CoordinateSystem& system = facts.coordinate_system;
      if (!system.name.empty() && first_named.second.name.empty()) first_named = {i, system};
      requireOneSystem(first_named, i, system);
      site_.sources.push_back({clouds_[i].string(), stream->size(), fields.back(), system.name});
      site_.points += stream->size();
    }
    site_.fields = united(fields, clouds_);
    layout_ = layoutOf(site_.fields);
    // A tile and its hierarchy, which takes at most twice 32 bytes for each point while it is built.
    const std::uint64_t tile = std::min(options_.tile_points, site_.points) * (layout_.point_step + 64);
    if (tile > options_.memory) {
      throw std::invalid_argument("a tile of " + counted(options_.tile_points, "point") + " needs " + megabytes(tile) +
                                  ", more than the memory given: make tiles smaller, or give more");
    }
  }

  /// Refuses a cloud whose coordinate system is not the first one named, as far as is known.
  void requireOneSystem(const std::pair<std::size_t, io::CoordinateSystem>& first, std::size_t cloud,
                        const io::CoordinateSystem& system) const
  {
    const auto warning = io::naming(clouds_[cloud], [&] {
      return io::requireOneSystem(clouds_[first.first].string(), first.second, system,
                                  "transform them (--to-crs), or make two sites");
    });
    if (warning && options_.remark) options_.remark(clouds_[cloud], {*warning});
  }

  /// Calls use(source, record, its bytes, the point) for all records of all clouds from (first, record) on.
  /// @param done records before that
  template <typename Use, typename AfterBatch>
  void forEachRecord(MakeStep step, std::uint32_t first, std::uint32_t record, std::uint64_t done, const Use& use,
                     const AfterBatch& after_batch)
  {
    for (std::size_t i = first; i < clouds_.size(); ++i, record = 0) {
      const auto stream = open(i);
      const pcl::PCLPointCloud2& header = stream->header();
      if (stream->size() != site_.sources[i].points) failAsChanged(i);
      const std::size_t most = std::max<std::size_t>(batch_bytes / header.point_step, 1);
      std::vector<std::uint8_t> batch(most * header.point_step);
      const PointsView view = viewOfRecords(header, batch.data(), most);
      begin(header);
      stream->skip(record);
      while (const std::size_t points = stream->read(batch.data(), most)) {
        for (std::uint32_t k = 0; k < points; ++k, ++record)
          use(static_cast<std::uint32_t>(i), record, batch.data() + std::size_t{k} * header.point_step, view.point(k));
        done += points;
        after_batch(static_cast<std::uint32_t>(i), record, done);
        tell(step, done, site_.points);
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
    const auto add = [&](std::uint32_t, std::uint32_t, const std::uint8_t*, const Point3& point) {
      if (!isFinite(point)) return;
      tree_.add(point);
      extend(site_.bounds, point);
      if (tree_.bytes() > options_.memory / 4) failAsTooFine();
    };
    forEachRecord(MakeStep::count, 0, 0, 0, add, [](std::uint32_t, std::uint32_t, std::uint64_t) {});
    // One tile more, for points that are not finite.
    state_.open.resize(std::size_t{tree_.plan()} + 1);
    if (tree_.bytes() > options_.memory / 4) failAsTooFine();
    state_.bounds = site_.bounds;
    if (site_.points < options_.save_points) return;
    const std::string plan = planBytes(tree_.planned());
    state_.plan_crc32 = crcOf(plan);
    unfinished_->savePlan(plan);
    save();
  }

  /// Returns the clouds and options that the site is made of. A run that is continued must have equal ones.
  io::Json question() const
  {
    io::Json question = {{"version", 3},
                         {"tile_points", options_.tile_points},
                         {"overview_points", options_.overview_points},
                         {"units", {options_.unit, options_.to_unit}},
                         {"systems", {options_.crs, options_.to_crs}},
                         {"scan", options_.scan ? io::Json(*options_.scan) : io::Json()},
                         {"clouds", io::Json::array()}};
    for (const fs::path& cloud : clouds_) {
      question["clouds"].push_back({cloud.string(), fs::file_size(cloud),
                                    fs::last_write_time(cloud).time_since_epoch().count(), columnsOf(cloud)});
    }
    return question;
  }

  /// Notes on the disk how much is done.
  void save()
  {
    for (TileFile& file : files_) file.flush();
    if (overview_) overview_->flush();
    state_.files.clear();
    for (const TileFile& file : files_) state_.files.push_back(file.points());
    state_.overview = overview_ ? overview_->points() : 0;
    unfinished_->save(stateText(state_, question()));
    saved_ = true;
  }

  /// Reads the state that an earlier run has saved.
  void goOn()
  {
    state_ = readState(unfinished_->stateFile(), question());
    site_.bounds = state_.bounds;
    tree_ = DensityTree::fromPlanned(readPlan(unfinished_->planFile(), state_.plan_crc32));
    unfinished_->discardTilesFrom(state_.files.size());
    saved_ = true;
  }

  [[noreturn]] void failAsTooFine() const
  {
    throw std::invalid_argument("tiles of " + counted(options_.tile_points, "point") + " are too many for " +
                                megabytes(options_.memory) + ": make tiles larger, or give more memory");
  }

  void deal()
  {
    const std::size_t step = layout_.point_step;
    constexpr std::size_t largest = std::size_t{4} << 20;
    buffer_ = static_cast<std::size_t>(std::min<std::uint64_t>(largest, options_.memory / 4 / state_.open.size()));
    if (buffer_ < step) failAsTooFine();
    std::vector<std::uint8_t> site_record(step);
    const PointNames names(layout_);
    for (std::size_t i = 0; i < state_.files.size(); ++i) {
      const std::uint64_t points = state_.files[i];
      files_.emplace_back(unfinished_->goOn(tileFileName(i), TileFile::bytesOf(site_.fields, points)), site_.fields,
                          buffer_, points);
    }
    beginOverview();
    const auto unlocated = static_cast<std::uint32_t>(state_.open.size() - 1);
    std::uint64_t number = state_.dealt;
    const auto place = [&](std::uint32_t source, std::uint32_t record, const std::uint8_t* bytes, const Point3& point) {
      (*copy_)(bytes, site_record.data());
      names.set(site_record.data(), {source, record});
      tileFor(isFinite(point) ? tree_.tileOf(point) : unlocated).add(site_record.data(), step);
      if (overview_ && number++ % overview_every_ == 0) overview_->add(site_record.data(), step);
    };
    std::uint64_t next = state_.dealt + options_.save_points;
    const auto save_some = [&](std::uint32_t source, std::uint32_t record, std::uint64_t done) {
      if (done < next || !saved_) return;
      state_.source = source;
      state_.record = record;
      state_.dealt = done;
      save();
      next = done + options_.save_points;
    };
    forEachRecord(MakeStep::deal, state_.source, state_.record, state_.dealt, place, save_some);
    for (TileFile& file : files_) file.finish();
    if (overview_) overview_->finish();
    std::uint64_t dealt = 0;
    for (const TileFile& file : files_) dealt += file.points();
    if (dealt != site_.points)
      throw files::FileError(folder_, "a cloud has changed while it was read", "make it again");
  }

  /// Returns the file that takes the next point of a tile. When it is full, another one follows: that happens where too
  /// many points are at one place, or are not finite.
  TileFile& tileFor(std::uint32_t tile)
  {
    std::optional<std::size_t>& file = state_.open[tile];
    if (!file || files_[*file].points() == options_.tile_points) {
      if (file) files_[*file].finish();
      file = files_.size();
      files_.emplace_back(unfinished_->add(tileFileName(files_.size())), site_.fields, buffer_);
    }
    return files_[*file];
  }

  void beginOverview()
  {
    if (options_.overview_points == 0 || site_.points == 0) return;
    overview_every_ = overviewStep(site_.points, options_.overview_points);
    if (state_.dealt > 0) {
      const std::uint64_t bytes = TileFile::bytesOf(site_.fields, state_.overview);
      overview_.emplace(unfinished_->goOn(overview_file_name, bytes), site_.fields, batch_bytes, state_.overview);
    }
    else {
      unfinished_->discard(overview_file_name);
      overview_.emplace(unfinished_->add(overview_file_name), site_.fields, batch_bytes);
    }
  }

  void measureTiles()
  {
    state_.source = static_cast<std::uint32_t>(clouds_.size());
    state_.record = 0;
    state_.dealt = site_.points;
    std::uint64_t done = 0, next = 0;
    if (saved_) save();
    pcl::PCLPointCloud2 cloud;
    for (std::size_t i = 0; i < files_.size(); ++i) {
      const TileFile& file = files_[i];
      Tile tile;
      if (i < state_.measured.size()) tile = state_.measured[i];
      tile.file = tileFileName(i);
      tile.points = file.points();
      done += file.points();
      if (i < state_.measured.size()) {
        site_.tiles.push_back(std::move(tile));
        next = done;
        continue;
      }
      cloud = loadTile(file.path(), site_.fields, tile.points, std::move(cloud));
      measure(cloud, tile);
      state_.measured.push_back(tile);
      site_.tiles.push_back(std::move(tile));
      if (saved_ && done >= next + options_.save_points) {
        save();
        next = done;
      }
      tell(MakeStep::measure, done, site_.points);
    }
  }

  const std::vector<fs::path>& clouds_;
  const MakeOptions& options_;
  const fs::path folder_;
  Site site_;
  pcl::PCLPointCloud2 layout_;
  DensityTree tree_;
  MakeState state_;
  bool saved_ = false; ///< there is a state on the disk
  UnfinishedSite* unfinished_ = nullptr;
  std::size_t buffer_ = 0;
  std::vector<TileFile> files_;
  std::optional<TileFile> overview_;
  std::uint64_t overview_every_ = 1;
  std::optional<RecordCopy> copy_;
};

} // namespace

Site makeSite(const std::vector<fs::path>& clouds, const fs::path& folder, const MakeOptions& options)
{
  return Maker(clouds, folder, options).make();
}

} // namespace pcl_bsh::site
