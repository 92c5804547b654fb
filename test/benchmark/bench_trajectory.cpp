// SPDX-License-Identifier: BSD-3-Clause
// Workload T: a model along thousands of poses through a scan. Which scan points come within the clearance?
#include "peer/path_peers.h"
#include "program.h"
#include "workload/nearest.h"
#include "workload/path_scene.h"

#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <cmath>

using namespace pcl_bsh::bench;
using pcl_bsh::SphereHierarchy;

namespace {

struct Options : ProgramOptions {
  std::vector<std::string> scenes = {"tunnel", "tight", "crane"};
  double scale = 0.1;
  std::vector<unsigned> threads = {1, 2};
  std::vector<std::string> racers = {"pcl_bsh", "boxes", "model_points"};
  std::vector<double> densities = {0.1, 1, 10};
  std::vector<double> clearances = {0.0, 0.05, 0.1, 0.2, 0.3, 0.4};
  std::size_t published_poses = 20;
  std::size_t warm_poses = 200;
};

pcl_bsh::PointsView viewOf(const Points& points)
{
  return pcl_bsh::viewOf(&points.data()->x, points.size());
}

/// Several runs of one racer.
struct Result {
  std::string racer;
  unsigned threads = 1;
  std::vector<double> build, query, total, bytes;
  std::vector<std::uint8_t> flags;
  double extrapolated = 1.0; ///< the query ran on so small a part of the poses; its times are multiplied

  void add(double build_seconds, double query_seconds, std::size_t peak)
  {
    build.push_back(build_seconds);
    query.push_back(query_seconds * extrapolated);
    total.push_back(build.back() + query.back());
    bytes.push_back(static_cast<double>(peak));
  }
};

/// From the bare clouds to the flags: voxels that the query enters are built by it, and count as query.
void runOurs(const PathScene& scene, unsigned threads, Result& result)
{
  const MemoryPeak peak;
  const Stopwatch build;
  pcl_bsh::HierarchyOptions options;
  options.threads = threads;
  const SphereHierarchy scan(viewOf(scene.scan), options), model(viewOf(scene.model), options);
  const double build_seconds = build.seconds();
  const Stopwatch query;
  pcl_bsh::TrajectoryRequest request;
  request.clearance = scene.clearance;
  request.threads = threads;
  pcl_bsh::TrajectoryResult found = collideAlong({scan}, model, scene.poses, request);
  result.add(build_seconds, query.seconds(), peak.bytes());
  result.flags = numbersOf(found.flags);
}

void runPeer(const std::string& name, const PathScene& scene, const std::vector<RigidPose>& poses, std::size_t stride,
             Result& result)
{
  const MemoryPeak peak;
  PathFlags found = name == "boxes" ? flagsByBoxes(scene.scan, scene.model, poses, scene.clearance)
                                    : flagsByModelPoints(scene.scan, scene.model, poses, scene.clearance, stride);
  result.add(found.build_seconds, found.query_seconds, peak.bytes());
  result.flags = std::move(found.flags);
}

/// How many points two racers flag differently, and how many of these not for rounding: peers round posed points to
/// float, which moves them by less than 0.1 mm even at the tunnel's far end.
struct Disagreement {
  std::size_t points = 0;
  std::size_t wrong = 0;
};

Disagreement compare(const Result& peer, const Result& ours, const PathScene& scene,
                     const std::vector<RigidPose>& poses)
{
  Disagreement off;
  if (peer.extrapolated != 1.0) { // of some poses only: it must not flag what ours does not
    for (std::size_t i = 0; i < scene.scan.size(); ++i) off.points += peer.flags[i] > ours.flags[i];
    off.wrong = off.points > 10 + ours.flags.size() / 1000 ? off.points : 0;
    return off;
  }
  const NearestDistance model(scene.model);
  for (std::size_t i = 0; i < scene.scan.size(); ++i) {
    if (peer.flags[i] == ours.flags[i]) continue;
    ++off.points;
    double nearest = std::numeric_limits<double>::infinity();
    for (const RigidPose& pose : poses) nearest = std::min(nearest, model.to(pose.inverse().apply(scene.scan[i])));
    off.wrong += std::abs(nearest - scene.clearance) > 1e-4;
  }
  return off;
}

std::vector<std::string> row(const std::string& scene_name, const PathScene& scene, const std::string& racer,
                             unsigned threads)
{
  return {scene_name,
          std::to_string(scene.scan.size()),
          std::to_string(scene.model.size()),
          std::to_string(scene.poses.size()),
          std::to_string(threads),
          racer};
}

bool race(const Options& options, const std::string& scene_name, Table& table)
{
  progress("making " + scene_name + " at scale " + text(options.scale));
  const PathScene scene = pathScene(scene_name, options.scale);
  std::vector<RigidPose> poses;
  for (const auto& pose : scene.poses) poses.push_back(rigidPose(pose));
  const std::size_t stride = std::max<std::size_t>(1, poses.size() / options.published_poses);

  std::vector<Result> results;
  for (const std::string& racer : options.racers) {
    for (const unsigned threads : racer == "pcl_bsh" ? options.threads : std::vector<unsigned>{1}) {
      Result result{racer, threads, {}, {}, {}, {}, {}, 1.0};
      if (racer == "model_points") {
        const std::size_t asked = (poses.size() + stride - 1) / stride;
        result.extrapolated = static_cast<double>(poses.size()) / static_cast<double>(asked);
      }
      for (unsigned repetition = 0; repetition < (racer == "pcl_bsh" ? options.repeat : 1); ++repetition) {
        progress(scene_name + ", " + racer + ", " + std::to_string(threads) + " threads, " +
                 std::to_string(repetition + 1));
        if (racer == "pcl_bsh")
          runOurs(scene, threads, result);
        else
          runPeer(racer, scene, poses, stride, result);
      }
      results.push_back(std::move(result));
    }
  }

  bool right = true;
  const Result& ours = results.front();
  for (const Result& result : results) {
    const Disagreement off = compare(result, ours, scene, poses);
    right = right && off.wrong == 0;
    std::vector<std::string> cells = row(scene_name, scene, result.racer, result.threads);
    for (const double seconds : {median(result.build), median(result.query), median(result.total)}) {
      cells.push_back(text(1e3 * seconds, 4));
    }
    cells.push_back(text(median(result.total) / median(ours.total)));
    cells.push_back(text(median(result.bytes) / static_cast<double>(scene.scan.size())));
    cells.push_back(std::to_string(std::count(result.flags.begin(), result.flags.end(), 1)));
    cells.push_back(std::to_string(off.points));
    cells.push_back(std::to_string(off.wrong));
    cells.push_back(
        result.extrapolated == 1.0 ? "" : "query extrapolated from 1/" + text(result.extrapolated) + " of the poses");
    table.add(cells);
  }
  return right;
}

void addOurs(const std::string& scene_name, const PathScene& scene, const std::string& racer, double build,
             double query, const std::string& ratio, const std::string& remark, Table& table)
{
  std::vector<std::string> cells = row(scene_name, scene, racer, 1);
  for (const double seconds : {build, query, build + query}) cells.push_back(text(1e3 * seconds, 4));
  for (const std::string& cell :
       {ratio, std::string("-"), std::string("-"), std::string("-"), std::string("-"), remark}) {
    cells.push_back(cell);
  }
  table.add(cells);
}

/// More poses over the same way: each time against the density before.
void showDensities(const Options& options, const std::string& scene_name, Table& table)
{
  double before = 0.0;
  for (const double denser : options.densities) {
    progress(scene_name + ", " + text(denser) + " times the poses");
    const PathScene scene = pathScene(scene_name, options.scale, denser);
    Result result;
    for (unsigned repetition = 0; repetition < options.repeat; ++repetition) runOurs(scene, 1, result);
    const double total = median(result.total);
    addOurs(scene_name, scene, "pcl_bsh", median(result.build), median(result.query),
            before > 0 ? text(total / before) : "-", text(denser) + " times the poses; ratio: to the row before",
            table);
    before = total;
  }
}

/// Costs of other questions than flags, and of clearances along a wall, against the scene's own question.
void showQuestions(const Options& options, const std::string& scene_name, Table& table)
{
  const PathScene scene = pathScene(scene_name, options.scale);
  pcl_bsh::TrajectoryRequest flags;
  flags.clearance = scene.clearance;
  double own = 0.0;
  const auto show = [&](const pcl_bsh::TrajectoryRequest& request, const std::string& what) {
    progress(scene_name + ", " + what);
    std::vector<double> seconds;
    pcl_bsh::Work work;
    for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
      const SphereHierarchy scan(viewOf(scene.scan)), model(viewOf(scene.model));
      const Stopwatch query;
      work = collideAlong({scan}, model, scene.poses, request).work;
      seconds.push_back(query.seconds());
    }
    if (own == 0.0) own = median(seconds);
    addOurs(scene_name, scene, "pcl_bsh", 0.0, median(seconds), text(median(seconds) / own),
            what + "; node pairs " + std::to_string(work.node_pairs) + "; ratio: to the flags", table);
  };
  show(flags, "flags");
  pcl_bsh::TrajectoryRequest request = flags;
  request.distances = true;
  show(request, "distances");
  request.first_poses = request.closest_poses = request.pose_summaries = true;
  show(request, "all that a list of clashes asks");
  request.pose_summaries = false;
  request.swept = 0.01;
  show(request, "swept by 1 cm, with distances");
  for (const double clearance : options.clearances) {
    request = flags;
    request.clearance = clearance;
    show(request, "flags at a clearance of " + text(clearance) + " m");
  }
}

/// One pose at a time, everything built: what a user who drags the model waits for.
void showOnePose(const Options& options, const std::string& scene_name, Table& table)
{
  progress(scene_name + ", one pose at a time");
  const PathScene scene = pathScene(scene_name, options.scale);
  const SphereHierarchy scan(viewOf(scene.scan)), model(viewOf(scene.model));
  scan.buildAll();
  model.buildAll();
  pcl_bsh::FlagsRequest request;
  request.clearance = scene.clearance;
  const auto poseAt = [&](std::size_t i) { return scene.poses[i * scene.poses.size() / options.warm_poses]; };
  for (std::size_t i = 0; i < options.warm_poses; ++i)
    pcl_bsh::anyCollision({scan}, {model, poseAt(i)}, {scene.clearance, {}}); // fits slabs
  std::vector<double> flags, indices, any;
  pcl_bsh::FlagsResult result;
  pcl_bsh::CollidingIndices list;
  for (std::size_t i = 0; i < options.warm_poses; ++i) {
    const auto pose = poseAt(i);
    const Stopwatch for_any;
    pcl_bsh::anyCollision({scan}, {model, pose}, {scene.clearance, {}});
    any.push_back(for_any.seconds());
    const Stopwatch for_flags;
    collisionFlags({scan}, {model, pose}, request, result);
    flags.push_back(for_flags.seconds());
    const Stopwatch for_indices;
    collidingIndices({scan}, {model, pose}, request, list);
    indices.push_back(for_indices.seconds());
  }
  addOurs(scene_name, scene, "pcl_bsh warm", 0.0, median(flags), "-", "flags at one pose, median", table);
  addOurs(scene_name, scene, "pcl_bsh warm", 0.0, median(indices), text(median(indices) / median(flags)),
          "indices at one pose, median; ratio: to the flags", table);
  addOurs(scene_name, scene, "pcl_bsh warm", 0.0, median(any), "-", "any at one pose, median", table);
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app(
      "A model along a path through a scan: flags of the scan's points, from the bare clouds, builds included.\n"
      "tunnel: a wagon that fills its box; tight: one long bend in which the vault grazes it, in random order; crane: "
      "an L whose box is full of what it never nears.\n"
      "boxes: cells and the model's box, then a tree over the model; model_points: every model point of every\n"
      "pose asks a tree over the scan (extrapolated from some poses).",
      "bench_trajectory");
  app.footer("Example: bench_trajectory --scale 0.1 --csv trajectory.csv");
  app.add_option("--scenes", options.scenes, "tunnel, tight, crane")
      ->delimiter(',')
      ->check(CLI::IsMember({"tunnel", "tight", "crane"}))
      ->capture_default_str();
  app.add_option("--scale", options.scale, "1: 18.92 M scan points, 2.5 M model points, 19,392 poses in the tunnel")
      ->check(CLI::Range(1e-4, 10.0))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "threads of pcl_bsh; the peers run on one")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--racers", options.racers, "who runs; the first is what others are compared with")
      ->delimiter(',')
      ->check(CLI::IsMember({"pcl_bsh", "boxes", "model_points"}))
      ->capture_default_str();
  app.add_option("--densities", options.densities, "multiples of the poses, for the first scene; 0: none")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--clearances", options.clearances, "flags at each, for the tight tunnel")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--published-poses", options.published_poses, "poses that model_points really asks")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--warm-poses", options.warm_poses, "poses asked one at a time, for the first scene")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  Table table({"scene", "scan", "model", "poses", "threads", "racer", "build [ms]", "query [ms]", "total [ms]",
               "times ours", "memory [B/scan point]", "colliding", "differ", "wrong", "remark"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    bool right = true;
    for (const auto& scene : options.scenes) right = race(options, scene, rows) && right;
    if (options.densities != std::vector<double>{0}) showDensities(options, options.scenes.front(), rows);
    if (std::find(options.scenes.begin(), options.scenes.end(), "tight") != options.scenes.end())
      showQuestions(options, "tight", rows);
    showOnePose(options, options.scenes.front(), rows);
    return right;
  });
}
