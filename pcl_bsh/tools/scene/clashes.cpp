// SPDX-License-Identifier: BSD-3-Clause
#include "clashes.h"

#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

namespace pcl_bsh::cli {
namespace {

constexpr auto clashes_effect = "effects.clashes";

/// Returns ask(). @throws std::invalid_argument naming the scene's file where the core refuses the question
template <typename Ask>
auto inScene(const io::SceneFile& file, const Ask& ask)
{
  try {
    return ask();
  }
  catch (const InvalidInput& error) {
    throw std::invalid_argument(file.path.string() + ": " + clashes_effect + ": " + error.what());
  }
}

} // namespace

SceneClashList::SceneClashList(const io::SceneFile& file, io::SceneWorld& world, const ClashOptions& options)
: file_(file),
  world_(world),
  options_(options),
  scan_(sourceOf(file.objects[file.clashes->of].parts[0].cloud)),
  question_(file.clashes->question)
{
  if (world.surface(scan_.name))
    throw std::invalid_argument(
        file.path.string() + ": " + clashes_effect + ".of: cloud '" + scan_.name +
        "' is a surface, and places of points are listed: give the cloud \"vertices_only\": true");
  question_.accuracy = file.options.accuracy;
  question_.threads = file.options.threads;
  question_.clearance = file.options.clearance;
  question_.uncertainty = scan_.uncertainty;
  question_.input_pose_uncertainty = scan_.uncertainty.pose;
  if (question_.seen && question_.origin.empty()) question_.origin = world.origins(scan_);
  Wanted& wanted = question_.wanted;
  wanted.flags = wanted.contacts = wanted.poses = wanted.closest = wanted.spacings = true;
  wanted.unseen_places = question_.seen;
  std::vector<std::string> names;
  inScene(file, [&] {
    for (ObjectId object = 0; object < file.objects.size(); ++object)
      if (object != file.clashes->of) addObject(object);
    for (const io::ComparedObstacle& one : obstacles_) names.push_back(one.name);
    checkObstacleNames(names);
  });
  if (std::all_of(placed_.begin(), placed_.end(), [](const PlacedShape& one) { return one.ignores_input; }))
    warnings_.push_back(file.path.string() + ": " + clashes_effect + ": no object is tested against '" +
                        file.objects[file.clashes->of].name +
                        "': do not fix what may collide with it, or give a rule that tests it");
  const io::CloudFacts facts = scan_.isAsRead() ? world.facts(scan_.name) : io::CloudFacts();
  listing_ = {scan_.text(), ReadChoice().unitOfReports(options.unit, facts.unit), facts.coordinate_system.name};
  if (options.cluster_distance > 0) listing_.cluster_distance = options.cluster_distance;
  listing_.previous = options.previous;
  listing_.readEarlier(obstacles_, warnings_);
}

const io::CloudSource& SceneClashList::sourceOf(const std::string& cloud) const
{
  return *std::find_if(file_.clouds.begin(), file_.clouds.end(),
                       [&](const io::CloudSource& source) { return source.name == cloud; });
}

/// The shape of a cloud. Its hierarchy is built once, and copies share it.
Shape SceneClashList::shapeOf(const io::CloudSource& source)
{
  const auto [place, is_new] = shapes_.try_emplace(source.name);
  if (is_new) {
    place->second = world_.obstacle(source.name).shape(source.text());
    place->second.hierarchy(source.uncertainty, file_.options.threads);
  }
  return place->second;
}

/// Each part of the object is an obstacle. Where no rule tests it against the scan, it is listed as ignored.
void SceneClashList::addObject(ObjectId object)
{
  const io::ObjectEntry& entry = file_.objects[object];
  const std::optional<double> clearance = world_.scene().clearanceOf(static_cast<ObjectId>(file_.clashes->of), object);
  for (std::uint32_t part = 0; part < entry.parts.size(); ++part) {
    const io::CloudSource& source = sourceOf(entry.parts[part].cloud);
    PlacedShape placed = {shapeOf(source)};
    placed.clearance = clearance;
    placed.solid = entry.parts[part].solid;
    placed.uncertainty = source.uncertainty;
    placed.ignores_input = !clearance;
    parts_.emplace_back(object, part);
    obstacles_.push_back({entry.parts.size() > 1 ? entry.name + '/' + entry.parts[part].name : entry.name,
                          source.text(), world_.obstacle(source.name), world_.facts(source.name)});
    obstacles_.back().question = questionOf(question_, placed);
    placed_.push_back(std::move(placed));
  }
}

void SceneClashList::addStep()
{
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    if (!placed_[i].path) placed_[i].path.emplace();
    placed_[i].path->push_back(world_.scene().worldPose(parts_[i].first, parts_[i].second));
  }
}

/// Gives each obstacle its path; after one step alone, its pose.
void SceneClashList::setPaths()
{
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    if (placed_[i].path->size() == 1) {
      placed_[i].pose = placed_[i].path->front();
      placed_[i].path.reset();
    }
    obstacles_[i].question = questionOf(question_, placed_[i]);
  }
}

/// Compares obstacles with each other. Pairs have the clearances of the scene's rules, and pairs of one clearance are
/// asked about together.
void SceneClashList::compareOthers()
{
  const auto clearanceOf = [&](std::uint32_t i, std::uint32_t k) {
    const ObjectId one = parts_[i].first, other = parts_[k].first;
    return one == other ? std::nullopt : world_.scene().clearanceOf(one, other);
  };
  std::set<double> clearances;
  for (std::uint32_t i = 0; i < parts_.size(); ++i)
    for (std::uint32_t k = i + 1; k < parts_.size(); ++k)
      if (const auto clearance = clearanceOf(i, k)) clearances.insert(*clearance);
  std::vector<PlacedShape> alike = placed_;
  for (const double clearance : clearances) {
    for (PlacedShape& one : alike) one.clearance = clearance;
    const auto wanted = [&](std::uint32_t i, std::uint32_t k) { return clearanceOf(i, k) == clearance; };
    for (const ObstaclePair& pair : askBetween(question_, alike, wanted))
      listing_.between.push_back({obstacles_[pair.first].name, obstacles_[pair.second].name, pair});
  }
  std::sort(listing_.between.begin(), listing_.between.end(), [](const auto& one, const auto& other) {
    return std::pair(one.pair.first, one.pair.second) < std::pair(other.pair.first, other.pair.second);
  });
}

void SceneClashList::finish()
{
  Step step("Listing clashes");
  setPaths();
  Shape scan = shapeOf(scan_);
  std::vector<const SphereHierarchy*> hierarchies;
  const ObstaclesAnswer found = inScene(file_, [&] {
    question_.progress = [&](double done) { return step.share(done); };
    ObstaclesAnswer answer = io::askAbout(question_, scan, placed_, obstacles_);
    if (file_.clashes->between) compareOthers();
    question_.progress = nullptr;
    return answer;
  });
  for (const PlacedShape& one : placed_) hierarchies.push_back(&one.shape.hierarchy());
  addTexts(found.all.warnings, warnings_);
  const io::ClashLists lists = io::listOf(listing_, scan.hierarchy(), hierarchies, obstacles_, found.all, warnings_);
  options_.write(lists, warnings_);
  present_ = lists.present();
  perhaps_ = lists.perhaps();
  counts_ = io::clashCounts(lists);
  step.done(counts_);
}

std::string SceneClashList::summary() const
{
  return io::summaryOf(obstacles_, listing_.between, "point") + counts_ + '\n';
}

nlohmann::ordered_json SceneClashList::json() const
{
  nlohmann::ordered_json json = {{"of", file_.objects[file_.clashes->of].name},
                                 {"clashes", present_ - perhaps_},
                                 {"clashes_perhaps", perhaps_},
                                 {"obstacles", nlohmann::ordered_json::array()},
                                 {"between", nlohmann::ordered_json::array()}};
  for (const io::ComparedObstacle& one : obstacles_) json["obstacles"].push_back(io::obstacleJson(one, listing_.input));
  for (const io::BetweenObstacles& two : listing_.between) json["between"].push_back(io::betweenJson(two));
  return json;
}

} // namespace pcl_bsh::cli
