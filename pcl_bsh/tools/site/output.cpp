// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "output.h"

#include <pcl_bsh/tools/cli/interruption.h>
#include <pcl_bsh/tools/cli/obstacle.h>

#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/search/selected_records.h>

#include <boost/crc.hpp>
#include <nlohmann/json.hpp>

#include <limits>
#include <vector>

namespace pcl_bsh::cli {

namespace {

using Type = pcl::PCLPointField;

/// Whether distances and poses are written: as by pcl_bsh_collide, along a path whose accuracy never stops early.
bool tellsPoses(const SiteOptions& options)
{
  return !options.trajectory.empty() && options.question.wanted.contacts;
}

/// The fields that each question answers with, as those of pcl_bsh_collide.
std::vector<site::ResultField> resultFields(const SiteOptions& options)
{
  const site::ResultField collision = collisionField(),
                          distance = {distance_field_name, Type::FLOAT32, std::numeric_limits<double>::quiet_NaN()},
                          first = {first_pose_field_name, Type::INT32, -1.0},
                          closest = {closest_pose_field_name, Type::INT32, -1.0};
  if (options.question.wanted.distances) return {distance};
  if (!tellsPoses(options)) return {collision};
  return {collision, distance, first, closest};
}

template <typename Value>
std::uint32_t checksumOf(const std::vector<Value>& values)
{
  boost::crc_32_type checksum;
  checksum.process_bytes(values.data(), values.size() * sizeof(Value));
  return checksum.checksum();
}

/// Returns a text that tells one obstacle from another: checksums of the points of a cloud, and of its faces. A site is
/// too large for that: its text says how it is made, and the sizes and times of its tiles.
nlohmann::json obstacleText(const ObstacleFiles* given, const SiteOptions& options)
{
  nlohmann::json text = nlohmann::json::array();
  if (given != nullptr) {
    for (std::size_t i = 0; i < given->all.size(); ++i) {
      const io::ComparedObstacle& one = given->all[i];
      if (!one.asked) {
        text.push_back(one.name);
        continue;
      }
      text.push_back(checksumOf(one.loaded.points().data));
      for (const pcl::PCLPointField& field : one.loaded.points().fields)
        text.push_back({field.name, field.offset, field.datatype, field.count});
      if (one.loaded.isSurface()) text.push_back(checksumOf(*one.loaded.triangles()));
      if (!given->haveNames()) continue;
      const Eigen::Isometry3d& pose = given->shapes[i].pose;
      text.push_back({one.name, given->shapes[i].ignores_input, givenOptions(one.question),
                      std::vector<double>(pose.data(), pose.data() + 16)});
    }
    return text;
  }
  const site::Site other = site::readSite(options.obstacle);
  text.push_back(site::siteText(other));
  for (const site::Tile& tile : other.tiles) {
    const std::filesystem::path file = other.folder / tile.file;
    text.push_back(
        {std::filesystem::file_size(file), std::filesystem::last_write_time(file).time_since_epoch().count()});
  }
  return text;
}

/// All that the answer depends on, as a text.
std::string questionOf(const site::Site& site, const ObstacleFiles* obstacles, double cluster_distance,
                       const SiteOptions& options)
{
  const Question& asked = options.question;
  nlohmann::json question = {{"site", site::siteText(site)},
                             {"question", {asked.wanted.distances, options.alongPath(), asked.wanted.contacts}},
                             {"options", givenOptions(asked)},
                             {"clusters", cluster_distance},
                             {"obstacle", obstacleText(obstacles, options)},
                             {"poses", nlohmann::json::array()}};
  question["numbers"] = 4; // the version of the numbers that are kept of a tile
  for (const Eigen::Isometry3d& pose : asked.poses())
    question["poses"].push_back(std::vector<double>(pose.data(), pose.data() + 16));
  const auto bytes = nlohmann::json::to_cbor(question);
  return {bytes.begin(), bytes.end()};
}

std::vector<float> inFloats(const std::vector<double>& numbers)
{
  std::vector<float> floats;
  for (const double number : numbers) floats.push_back(static_cast<float>(number));
  return floats;
}

} // namespace

site::ResultField collisionField()
{
  return {collision_field_name, Type::UINT8, 0.0};
}

ObstacleFiles::ObstacleFiles(const SiteOptions& options)
{
  double seconds = 0.0;
  const std::vector<ObstacleChoice> choices = options.choices();
  std::vector<LoadedObstacle> loaded =
      loadObstacles(choices, options.question,
                    {options.reading, options.reading.input_unit, site::rankHere() == 0, options.between}, seconds);
  const IgnoredPairs ignored = options.ignoredPairs();
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const std::string file = choices[i].file.string();
    all.push_back({choices[i].name, file, std::move(loaded[i].obstacle), std::move(loaded[i].facts)});
    all.back().asked = choices[i].asked;
    shapes.push_back(choices[i].placed(all.back().loaded.shape(file)));
    shapes.back().ignores_input = haveNames() && (!choices[i].asked || ignored.holds(kInputName, choices[i].name));
  }
  setQuestion(options.question);
  if (!options.obstacle_out.empty()) requireWritableFlags(options.obstacle_out, only());
}

void ObstacleFiles::setQuestion(const Question& question)
{
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].question = pcl_bsh::questionOf(question, shapes[i]);
    all[i].question.progress = nullptr;
  }
}

void ObstacleFiles::write(const std::vector<Verdict>& flags, const SiteOptions& options) const
{
  if (options.obstacle_out.empty() || site::rankHere() != 0) return;
  writeFlags(options.obstacle_out, only(), flags, all.front().facts);
}

std::vector<std::string> droppedBy(const site::ResultSite& out, const std::string& option,
                                   const std::filesystem::path& folder, const site::Site& site,
                                   const std::vector<site::ResultField>& fields)
{
  std::vector<std::string> lines;
  if (out.thrownAway() > 0) {
    lines.push_back(
        option + ": " + folder.string() + ": what an earlier run had found of " + std::to_string(out.thrownAway()) +
        " of " + std::to_string(site.tiles.size()) +
        " tiles is thrown away, for --resume is not given: it goes on with what the same question has found");
  }
  std::string names;
  for (const std::string& name : site::staleFields(site, fields)) names += (names.empty() ? "" : ", ") + name;
  if (!names.empty()) {
    lines.push_back(option + ": " + folder.string() + ": leaves out fields of " + site.folder.string() +
                    " that answer an earlier question: " + names);
  }
  return lines;
}

SiteOutput::SiteOutput(const site::Site& site, const ObstacleFiles* obstacles, double cluster_distance,
                       const SiteOptions& options)
: options_(options)
{
  if (options.out.empty()) return;
  setWhatStays(what_stays);
  const std::vector<site::ResultField> fields = resultFields(options);
  out_.emplace(site, options.out, fields,
               site::Continuation{questionOf(site, obstacles, cluster_distance, options), options.resume});
  warnings_ = droppedBy(*out_, "--out", options.out, site, fields);
}

site::TileReceiver SiteOutput::receiver()
{
  if (!out_) return nullptr;
  return [this](const site::Tile& tile, const pcl::PCLPointCloud2& cloud, const Answer& found) {
    if (options_.question.wanted.distances) {
      out_->write(tile, cloud, {inFloats(found.distances.a.distance).data()});
      return;
    }
    const TrajectoryResult& collisions = found.collisions;
    std::vector<const void*> columns = {collisions.flags.data()};
    if (tellsPoses(options_))
      columns.insert(columns.end(),
                     {collisions.distance.data(), collisions.first_pose.data(), collisions.closest_pose.data()});
    out_->write(tile, cloud, columns);
  };
}

void SiteOutput::finish()
{
  if (out_) out_->finish();
}

} // namespace pcl_bsh::cli
#endif
