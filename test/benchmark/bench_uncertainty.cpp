// SPDX-License-Identifier: BSD-3-Clause
// Cost of verdicts that hold wherever points truly are: of a scan, plain, with one length for all points of both
// clouds, and with a length for each point.
#include "program.h"
#include "workload/random.h"
#include "workload/scenes.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/question/uncertainty.h>
#include <pcl_bsh/scene/scene.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::vector<std::string> scenes = {"terrain", "lion"};
  std::vector<double> clearances = {1.0, 5.0, 20.0};
  std::vector<std::string> queries = {"flags"};
  std::size_t size = 300000;
  std::string folder = PCL_BSH_SHARED_DIR "/data";
};

enum class Kind { plain, one_length, each_point, pose };
constexpr std::array<const char*, 4> kNames = {"plain", "one length", "a length per point", "the pose"};

/// Lengths up to a tenth of the clearance.
std::vector<float> lengths(std::size_t count, double clearance, std::uint64_t seed)
{
  std::vector<float> drawn(count);
  for (std::size_t i = 0; i < count; ++i) drawn[i] = static_cast<float>(0.1 * clearance * unit(mix(seed + i)));
  return drawn;
}

/// The uncertainty of a cloud's pose. On average its points move by as much as by the other two, the farthest by half
/// as much again, those about its middle by half of it.
Uncertainty ofPose(const Points& points, double clearance)
{
  Eigen::AlignedBox3d box;
  for (const Point& p : points) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  const Eigen::Vector3d middle = box.center();
  Uncertainty uncertainty;
  uncertainty.pose = {0.025 * clearance, 0.1 * clearance / box.diagonal().norm(), {middle.x(), middle.y(), middle.z()}};
  return uncertainty;
}

struct Cloud {
  Cloud(const Points& points, Kind kind, double clearance, std::uint64_t seed)
  : each(kind == Kind::each_point ? lengths(points.size(), clearance, seed) : std::vector<float>()),
    hierarchy(viewOf(points, kind, clearance, each))
  {
    hierarchy.buildAll();
  }

  static PointsView viewOf(const Points& points, Kind kind, double clearance, const std::vector<float>& each)
  {
    PointsView view = pcl_bsh::viewOf(&points.data()->x, points.size(), sizeof(Point));
    if (kind == Kind::one_length) view.uncertainty = 0.05 * clearance;
    if (kind == Kind::each_point) view.uncertainties = each.data();
    return kind == Kind::pose ? withUncertainty(view, {}, "cloud", ofPose(points, clearance)) : view;
  }

  std::vector<float> each;
  SphereHierarchy hierarchy;
};

struct Entry {
  std::vector<double> seconds;
  std::size_t colliding = 0, undecided = 0; ///< points of the first cloud; of any collision: whether it is so
};

/// The second cloud comes up from below, by half a clearance from pose to pose where there are 20.
std::vector<Eigen::Isometry3d> path(double clearance, int count = 20)
{
  std::vector<Eigen::Isometry3d> poses(static_cast<std::size_t>(count), Eigen::Isometry3d::Identity());
  for (int k = 0; k < count; ++k)
    poses[static_cast<std::size_t>(k)].translation().z() = -10.0 * clearance * (count - k) / count;
  return poses;
}

std::shared_ptr<SphereHierarchy> unowned(const SphereHierarchy& hierarchy)
{
  return {std::shared_ptr<void>(), const_cast<SphereHierarchy*>(&hierarchy)}; // nothing deforms it
}

void ask(const std::string& query, const SphereHierarchy& a, const SphereHierarchy& b, double clearance, Entry& entry)
{
  FlagsRequest request;
  request.clearance = clearance;
  if (query == "flags") {
    const FlagsResult found = collisionFlags({a}, {b}, request);
    entry.colliding = found.colliding_a;
    entry.undecided = found.undecided_a;
  }
  else if (query == "lists") {
    const CollidingIndices found = collidingIndices({a}, {b}, request);
    entry.colliding = found.a.size();
    entry.undecided = found.undecided_a.size();
  }
  else if (query == "path" || query == "path_distances" || query == "swept") {
    TrajectoryRequest along;
    along.clearance = clearance;
    along.distances = query == "path_distances";
    if (query == "swept") along.swept = 0.1 * clearance;
    const TrajectoryResult found = collideAlong({a}, b, path(clearance), along);
    entry.colliding = found.colliding;
    entry.undecided = found.undecided;
  }
  else if (query == "poses") {
    AnyRequest at_poses;
    at_poses.clearance = clearance;
    const auto found = anyCollisionAtPoses({a}, b, path(clearance, 1000), at_poses).flags;
    entry.colliding = countOf(found, Verdict::colliding);
    entry.undecided = countOf(found, Verdict::undecided);
  }
  else if (query == "scene") {
    SceneOptions effects;
    effects.clearance = clearance;
    effects.effects.flags = true;
    Scene scene(effects);
    scene.add(fixedObject("a", unowned(a)));
    const ObjectId moved = scene.add(object("b", unowned(b), path(clearance).front()));
    entry.colliding = entry.undecided = 0;
    for (const Eigen::Isometry3d& pose : path(clearance)) {
      scene.setPose(moved, pose);
      for (const FlaggedPart& part : scene.query().flags) {
        entry.colliding += countOf(part.flags, Verdict::colliding);
        entry.undecided += countOf(part.flags, Verdict::undecided);
      }
    }
  }
  else { // a search that ends early, and one that need not
    entry.colliding = entry.undecided = 0;
    for (const Eigen::Isometry3d& pose : path(clearance)) {
      const Verdict verdict = anyCollision({a}, {b, pose}, {clearance, {}}).verdict;
      entry.colliding += verdict == Verdict::colliding;
      entry.undecided += verdict == Verdict::undecided;
    }
  }
}

void measure(const std::string& name, const ScanPair& pair, double spacings, const std::string& query,
             const Options& options, Table& table)
{
  const double clearance = spacings * pair.spacing;
  std::array<Entry, kNames.size()> entries;
  for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      progress(name + ", " + query + ", clearance " + text(clearance) + ", " + kNames[k]);
      const auto kind = static_cast<Kind>(k);
      const Cloud a(pair.a, kind, clearance, 1), b(pair.b, kind, clearance, 1u << 30);
      ask(query, a.hierarchy, b.hierarchy, clearance, entries[k]); // builds what queries share
      const Stopwatch watch;
      ask(query, a.hierarchy, b.hierarchy, clearance, entries[k]);
      entries[k].seconds.push_back(watch.seconds());
    }
  }
  const double plain = quantile(entries[0].seconds, 0.0);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const double least = quantile(entries[k].seconds, 0.0);
    table.add({name, query, std::to_string(pair.a.size()), text(spacings), kNames[k], text(1e3 * least, 4),
               text(least / plain), std::to_string(entries[k].colliding), std::to_string(entries[k].undecided)});
  }
}

bool measureAll(const Options& options, Table& table)
{
  for (const auto& name : options.scenes) {
    const auto pair = scene(name, options.size, options.folder);
    if (!pair) {
      progress(name + ": no such scan in " + options.folder + ": skipped");
      continue;
    }
    for (const std::string& query : options.queries)
      for (const double spacings : options.clearances) measure(name, *pair, spacings, query, options, table);
  }
  return true;
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  std::vector<std::string> all_scenes = kMadeScenes;
  all_scenes.insert(all_scenes.end(), kRealScenes.begin(), kRealScenes.end());
  CLI::App app(
      "Questions about a scan whose points may be elsewhere: by up to a tenth of the clearance, drawn for each point "
      "of "
      "both clouds,\nor by half of that for all, or because the poses of both are uncertain, by as much on average. "
      "One thread, "
      "hierarchies built. Ratios are of the smallest times, "
      "to the plain query.",
      "bench_uncertainty");
  app.footer("Example: bench_uncertainty --scene terrain,lion --clock cpu --csv uncertainty.csv");
  app.add_option("--scene", options.scenes, "terrain, sweep, hall (made); lidar, lion, autzen (real)")
      ->delimiter(',')
      ->check(CLI::IsMember(all_scenes))
      ->capture_default_str();
  app.add_option(
         "--query", options.queries,
         "flags, lists (of colliding and undecided points), any (of two clouds at 20 poses, each alone), path "
         "(flags along these poses), path_distances (and the smallest distances), swept (flags of the motion between "
         "them), poses (any at 1000 of them, in one call), scene (flags at each of them)")
      ->delimiter(',')
      ->check(CLI::IsMember({"flags", "lists", "any", "path", "path_distances", "swept", "poses", "scene"}))
      ->capture_default_str();
  app.add_option("--size", options.size, "points of a made cloud")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--clearances", options.clearances, "in spacings of the cloud")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--folder", options.folder, "where the real scans are")->capture_default_str();
  Table table({"scene", "query", "points", "clearance [spacings]", "uncertainty", "least [ms]", "ratio", "colliding",
               "undecided"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) { return measureAll(options, rows); });
}
