// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/unfinished.h>
#include <pcl_bsh/site/answers/kept_answers.h>
#include <pcl_bsh/site/making/unfinished_site.h>
#include <pcl_bsh/site/result_site.h>
#include <pcl_bsh/site/tiles/checksum.h>
#include <pcl_bsh/site/tiles/records.h>
#include <pcl_bsh/site/tiles/tile_file.h>
#include <pcl_bsh/site/tiles/tile_visitor.h>

#include <algorithm>
#include <array>
#include <exception>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace pcl_bsh::site {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t result_buffer = std::size_t{1} << 20;
constexpr std::uint64_t overview_points = 1'000'000;

bool has(const std::vector<std::string>& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

void eraseNamed(const std::vector<std::string>& names, Fields& fields)
{
  std::erase_if(fields, [&](const auto& field) { return has(names, field.name); });
}

/// The fields of a site with those of its results, and without those of other questions.
pcl::PCLPointCloud2 layoutWithResults(const Site& site, const std::vector<ResultField>& results)
{
  Fields fields = site.fields;
  eraseNamed(staleFields(site, results), fields);
  pcl::PCLPointCloud2 layout = layoutOf(fields);
  for (const ResultField& result : results) {
    const pcl::PCLPointField* const same = findField(layout, result.name);
    if (same == nullptr)
      io::addField(layout, result.name, result.datatype);
    else if (same->datatype != result.datatype || same->count != 1)
      throw files::FileError(site.folder, "its field '" + result.name + "' has another type than the results",
                             "rename the field in the clouds, and make the site again");
  }
  return layout;
}

std::uint64_t bytesOf(const Site& site, const std::vector<ResultField>& results)
{
  return diskSpaceOf(layoutWithResults(site, results).fields, site.points, site.tiles.size(),
                     std::min(overview_points, site.points));
}

} // namespace

class ResultSite::Writer {
public:
  Writer(const Site& site, const fs::path& folder, const std::vector<ResultField>& results,
         const Continuation& continuation)
  : site_(site),
    folder_(folder),
    layout_(layoutWithResults(site, results)),
    copy_(site.fields, layout_),
    names_(layout_),
    record_(layout_.point_step)
  {
    for (const ResultField& result : results) {
      places_.push_back(placeOf(result));
      no_longer_of_sources_.push_back(result.name);
    }
    const std::vector<std::string> stale = staleFields(site, results);
    no_longer_of_sources_.insert(no_longer_of_sources_.end(), stale.begin(), stale.end());
    std::uint64_t points = 0;
    for (const Source& source : site.sources) {
      begins_.push_back(points);
      points += source.points;
    }
    every_ = overviewStep(points, overview_points);
    // The first rank makes the folder; the others go on when it is there.
    using Use = UnfinishedSite::Use;
    const bool is_kept = !continuation.question.empty();
    const Use use = continuation.goes_on ? Use::resumed : ranks() > 1 || is_kept ? Use::shared : Use::alone;
    if (rankHere() == 0) {
      const std::uint64_t answers = continuation.goes_on ? 0 : answersIn(folder);
      made_ = std::make_unique<UnfinishedSite>(folder, use, bytesOf(site, results));
      thrown_away_ = answers; // now that the folder is this run's
    }
    sumOfAllRanks(0);
    if (is_kept) answers_.emplace(folder, continuation.question);
    if (continuation.goes_on) goOn();
  }

  ~Writer()
  {
    if (made_ && answers_ && ranks() == 1 && !is_finished_ && !answers_->any()) made_->forget();
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  TileAnswers* answers() { return answers_ ? &*answers_ : nullptr; }
  std::uint64_t thrownAway() const noexcept { return thrown_away_; }

  void write(const Tile& tile, const pcl::PCLPointCloud2& cloud, const std::vector<const void*>& columns)
  {
    const auto number = static_cast<std::size_t>(&tile - site_.tiles.data());
    files::NewFile& made = add(tileFileName(number));
    TileFile file(made, layout_.fields, result_buffer);
    Checksum checksum;
    for (std::size_t i = 0; i < cloud.width; ++i) {
      copy_(cloud.data.data() + i * cloud.point_step, record_.data());
      for (std::size_t k = 0; k < places_.size(); ++k) {
        const Place& place = places_[k];
        const void* const column = columns.empty() ? nullptr : columns[k];
        const std::uint8_t* const value =
            column == nullptr ? place.none.data() : static_cast<const std::uint8_t*>(column) + i * place.bytes;
        std::memcpy(record_.data() + place.offset, value, place.bytes);
      }
      checksum.add(record_.data(), record_.size());
      file.add(record_.data(), record_.size());
      addToOverview(tile, record_.data());
    }
    file.finish();
    note(number, checksum.value());
    if (!answers_ || columns.empty()) return;
    answers_->setChecksum(number, checksum.value());
    const auto lock = files::lockUnfinished();
    made.keep();
  }

  Site finish()
  {
    copyOthers();
    Site out = site_;
    out.folder = folder_;
    out.fields = layout_.fields;
    for (Source& source : out.sources) eraseNamed(no_longer_of_sources_, source.fields);
    const std::vector<double> written = gatheredFromAllRanks(written_);
    for (std::size_t i = 0; i < written.size(); i += 2) {
      const auto number = static_cast<std::size_t>(written[i]);
      out.tiles[number].file = tileFileName(number);
      out.tiles[number].crc32 = static_cast<std::uint32_t>(written[i + 1]);
      for (const std::string& name : no_longer_of_sources_) out.tiles[number].greatest.erase(name);
    }
    const std::string overview = gatheredFromAllRanks(overview_);
    keepFiles();
    sumOfAllRanks(0); // all files are complete
    if (rankHere() == 0) {
      writeOverview(overview);
      made_->finish(out);
    }
    sumOfAllRanks(0); // and so is the site
    is_finished_ = true;
    return out;
  }

private:
  /// Where a result goes in a record.
  struct Place {
    std::size_t offset, bytes;
    std::vector<std::uint8_t> none;
  };

  [[noreturn]] void failAsDamaged(const Tile& tile, std::uint32_t source) const
  {
    throw files::FileError(site_.folder / tile.file,
                           "has a point of source " + std::to_string(source) + ", which there is not",
                           "make the site again");
  }

  void note(std::size_t tile, std::uint32_t crc32)
  {
    written_.push_back(static_cast<double>(tile));
    written_.push_back(static_cast<double>(crc32));
  }

  /// Adds one point of each `every_` to the overview. @param record of the results, of this tile
  void addToOverview(const Tile& tile, const std::uint8_t* record)
  {
    const auto [source, number] = names_(record);
    if (source >= begins_.size()) failAsDamaged(tile, source);
    if ((begins_[source] + number) % every_ == 0)
      overview_.append(reinterpret_cast<const char*>(record), layout_.point_step);
  }

  /// Takes over the tiles whose answers an earlier run has kept, and whose files have not changed since. All ranks
  /// share the work.
  void goOn()
  {
    std::vector<std::size_t> mine;
    std::exception_ptr failure;
    try {
      for (std::size_t i = static_cast<std::size_t>(rankHere()); i < site_.tiles.size();
           i += static_cast<std::size_t>(ranks()))
        if (takeOver(i)) mine.push_back(i);
    }
    catch (...) { // for example, of answers to another question
      failure = std::current_exception();
    }
    throwOfAnyRank(failure);
    answers_->share(mine);
    if (made_) {
      made_->discardTiles(answers_->all());
      made_->discard(overview_file_name);
    }
    sumOfAllRanks(0);
  }

  bool takeOver(std::size_t number)
  {
    const auto crc32 = answers_->checksumKept(number);
    if (!crc32) return false;
    const Tile& tile = site_.tiles[number];
    pcl::PCLPointCloud2 cloud;
    try {
      cloud = loadTile(folder_ / tileFileName(number), layout_.fields, tile.points);
    }
    catch (const std::runtime_error&) {
      return false; // it was not complete when the earlier run ended
    }
    if (crcOf(cloud.data) != *crc32) return false;
    for (std::size_t i = 0; i < cloud.width; ++i) addToOverview(tile, cloud.data.data() + i * cloud.point_step);
    note(number, *crc32);
    return true;
  }

  files::NewFile& add(const fs::path& name)
  {
    if (made_) return made_->add(name);
    files_.push_back(std::make_unique<files::NewFile>(folder_ / name));
    return *files_.back();
  }

  void keepFiles()
  {
    const auto lock = files::lockUnfinished();
    for (const auto& file : files_) file->keep();
  }

  Place placeOf(const ResultField& result) const
  {
    Place place{offsetOf(layout_, result.name), 0, {}};
    io::withFieldType(result.datatype, [&](auto value) {
      value = static_cast<decltype(value)>(result.none);
      place.bytes = sizeof value;
      place.none.resize(sizeof value);
      std::memcpy(place.none.data(), &value, sizeof value);
    });
    return place;
  }

  /// Copies the tiles that no rank has written. All ranks share the work.
  void copyOthers()
  {
    const std::vector<double> written = gatheredFromAllRanks(written_);
    std::vector<bool> done(site_.tiles.size(), false);
    for (std::size_t i = 0; i < written.size(); i += 2) done[static_cast<std::size_t>(written[i])] = true;
    int next = 0;
    pcl::PCLPointCloud2 cloud;
    for (std::size_t i = 0; i < done.size(); ++i) {
      if (done[i] || next++ % ranks() != rankHere()) continue;
      cloud = readTile(site_, site_.tiles[i], std::move(cloud));
      write(site_.tiles[i], cloud, {});
    }
  }

  /// In the order of (source, record), as makeSite() writes it.
  void writeOverview(const std::string& records)
  {
    const std::size_t step = layout_.point_step, count = records.size() / step;
    if (count == 0) return;
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(records.data());
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto name = [&](std::size_t i) { return names_(bytes + i * step); };
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return name(i) < name(j); });
    TileFile file(add(overview_file_name), layout_.fields, result_buffer);
    for (const std::size_t i : order) file.add(bytes + i * step, step);
    file.finish();
  }

  const Site& site_;
  fs::path folder_;
  pcl::PCLPointCloud2 layout_;
  RecordCopy copy_;
  PointNames names_; ///< of records of the results
  std::vector<std::uint8_t> record_;
  std::vector<Place> places_;
  std::vector<std::string> no_longer_of_sources_;      ///< fields of results, and those that are left out
  std::vector<std::uint64_t> begins_;                  ///< of each source, the number of its first point in the site
  std::uint64_t every_ = 1;                            ///< points of the site for one of the overview
  std::unique_ptr<UnfinishedSite> made_;               ///< on the first rank
  std::vector<std::unique_ptr<files::NewFile>> files_; ///< on the others
  std::vector<double> written_; ///< of each tile that this rank has written, its number and checksum
  std::string overview_;
  std::optional<KeptAnswers> answers_; ///< where the question may go on
  bool is_finished_ = false;
  std::uint64_t thrown_away_ = 0; ///< answers
};

ResultSite::ResultSite(const Site& site, const fs::path& folder, const std::vector<ResultField>& fields,
                       const Continuation& continuation)
: writer_(std::make_unique<Writer>(site, folder, fields, continuation))
{
}

ResultSite::~ResultSite() = default;

void ResultSite::write(const Tile& tile, const pcl::PCLPointCloud2& cloud, const std::vector<const void*>& columns)
{
  writer_->write(tile, cloud, columns);
}

std::uint64_t ResultSite::thrownAway() const
{
  return writer_->thrownAway();
}

TileAnswers* ResultSite::answers()
{
  return writer_->answers();
}

Site ResultSite::finish()
{
  return writer_->finish();
}

std::vector<std::string> staleFields(const Site& site, const std::vector<ResultField>& fields)
{
  constexpr std::array results = {collision_field_name, distance_field_name, first_pose_field_name,
                                  closest_pose_field_name};
  std::vector<std::string> stale;
  for (const char* name : results) {
    const bool is_answered = std::any_of(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; });
    const auto had_answers = [&](const Source& source) {
      return findField(source.fields, collision_field_name) && findField(source.fields, name);
    };
    if (!is_answered && std::any_of(site.sources.begin(), site.sources.end(), had_answers)) stale.emplace_back(name);
  }
  return stale;
}

std::uint64_t spaceWanted(const Site& site, const fs::path& folder, const std::vector<ResultField>& fields)
{
  return spaceWanted(folder, bytesOf(site, fields));
}

std::uint64_t answersIn(const fs::path& folder)
{
  std::error_code error;
  if (!isUnfinished(folder)) return 0;
  const fs::directory_iterator tiles(folder / tiles_folder_name, error);
  return static_cast<std::uint64_t>(std::count_if(
      begin(tiles), end(tiles), [](const auto& entry) { return entry.path().extension() == answer_extension; }));
}

} // namespace pcl_bsh::site
