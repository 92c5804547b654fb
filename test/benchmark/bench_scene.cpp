// SPDX-License-Identifier: BSD-3-Clause
// Scenes of many objects: what a step costs, the grid against comparing all pairs of root spheres, a scene's one effect
// against its bare query, and an update against building anew. An object that is dragged by hand.
#include "program.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/hierarchy/update.h>
#include <pcl_bsh/scene/dragged_object.h>
#include <pcl_bsh/scene/scene.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::size_t objects = 1000;
  std::size_t points = 10000;
  std::size_t steps = 100;
  std::size_t many = 5000;
  std::size_t cloud = 10000000;
  std::size_t scan = 1000000;
  std::size_t dragged = 100000;
  std::size_t events = 600;
  unsigned threads = 2;
  std::string part = "all";
  std::string order = "scan";
};

double uniform(std::uint64_t& state)
{
  state = state * 6364136223846793005u + 1442695040888963407u;
  return std::ldexp(static_cast<double>(state >> 11), -53);
}

/// x y z of points on a sphere's surface.
std::vector<float> ball(std::size_t count, double radius)
{
  std::vector<float> xyz;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double r = std::sqrt(1.0 - z * z), angle = 2.399963229728653 * static_cast<double>(i);
    for (const double x : {r * std::cos(angle), r * std::sin(angle), z}) xyz.push_back(static_cast<float>(radius * x));
  }
  return xyz;
}

/// Balls of radius 0.5 at random places, about one to three units of volume: many of them touch.
class Crowd {
public:
  Crowd(std::size_t count, std::size_t points, const SceneOptions& options, bool shared)
  : scene(options),
    side_(1.5 * std::cbrt(static_cast<double>(count))),
    poses_(count, Eigen::Isometry3d::Identity())
  {
    for (std::size_t i = 0; i < count; ++i) {
      if (i == 0 || !shared) {
        clouds_.push_back(ball(points, 0.5));
        hierarchies_.push_back(
            std::make_shared<SphereHierarchy>(viewOf(clouds_.back().data(), clouds_.back().size() / 3)));
      }
      for (int k = 0; k < 3; ++k) poses_[i].translation()[k] = side_ * uniform(state_);
      scene.add(object("ball " + std::to_string(i), hierarchies_.back(), poses_[i]));
    }
  }

  /// Moves a share of the balls by up to 0.1 along each axis.
  void stir(double share)
  {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (uniform(state_) >= share) continue;
      for (int k = 0; k < 3; ++k)
        poses_[i].translation()[k] =
            std::clamp(poses_[i].translation()[k] + 0.1 * (2.0 * uniform(state_) - 1.0), 0.0, side_);
      scene.setPose(static_cast<ObjectId>(i), poses_[i]);
    }
  }

  Scene scene;

  const std::vector<Eigen::Isometry3d>& poses() const { return poses_; }

private:
  double side_;
  std::uint64_t state_ = 1;
  std::vector<std::vector<float>> clouds_;
  std::vector<std::shared_ptr<SphereHierarchy>> hierarchies_;
  std::vector<Eigen::Isometry3d> poses_;
};

SceneOptions anyOnly(unsigned threads)
{
  SceneOptions options;
  options.effects.any = true;
  options.clearance = 0.01;
  options.threads = threads;
  return options;
}

void measureSteps(const Options& options, Table& table)
{
  for (const unsigned threads : {1u, options.threads}) {
    progress("steps, " + std::to_string(threads) + " threads");
    Crowd crowd(options.objects, options.points, anyOnly(threads), false);
    crowd.scene.query();
    std::vector<double> seconds;
    std::size_t colliding = 0, asked = 0, reused = 0;
    for (std::size_t step = 0; step < options.steps; ++step) {
      const Stopwatch watch;
      crowd.stir(0.1);
      const SceneResult result = crowd.scene.query();
      seconds.push_back(watch.seconds());
      colliding += result.any.size();
      asked += result.cost(Effect::any).pairs;
      reused += result.cost(Effect::any).reused;
    }
    table.add({"step, 10 % moving, any", std::to_string(options.objects) + " x " + std::to_string(options.points),
               std::to_string(threads), text(1e3 * median(seconds)), text(1.0 / median(seconds)) + " steps/s",
               std::to_string(colliding / options.steps) + " pairs collide, " + std::to_string(asked / options.steps) +
                   " asked, " + std::to_string(reused / options.steps) + " known"});
    if (options.threads == 1) break;
  }
}

/// All pairs of root spheres, as four arrays: the fair rival of a grid.
std::size_t compareAllPairs(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z,
                            float reach)
{
  std::size_t near = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    unsigned count = 0;
    for (std::size_t j = i + 1; j < x.size(); ++j) {
      const float dx = x[i] - x[j], dy = y[i] - y[j], dz = z[i] - z[j];
      count += dx * dx + dy * dy + dz * dz <= reach * reach ? 1u : 0u;
    }
    near += count;
  }
  return near;
}

/// The test in its plainest form, without vectors: a pair, two poses, a test.
std::size_t comparePairByPair(const std::vector<Eigen::Isometry3d>& poses, double reach)
{
  std::size_t near = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (std::size_t j = i + 1; j < poses.size(); ++j)
      near += (poses[i].translation() - poses[j].translation()).squaredNorm() <= reach * reach ? 1 : 0;
  return near;
}

void measureBroadPhase(const Options& options, Table& table)
{
  for (const double share : {0.1, 1.0}) {
    progress("broad phase, " + text(100 * share) + " % moving");
    Crowd crowd(options.many, 200, anyOnly(1), true);
    crowd.scene.query();
    std::vector<double> grid, all, plain;
    std::size_t candidates = 0, near = 0;
    for (std::size_t step = 0; step < std::max<std::size_t>(options.steps / 5, 3); ++step) {
      crowd.stir(share);
      const SceneResult result = crowd.scene.query();
      grid.push_back(result.broad_phase.seconds);
      candidates = result.broad_phase.candidates;
      std::vector<float> x, y, z;
      for (const Eigen::Isometry3d& pose : crowd.poses()) {
        x.push_back(static_cast<float>(pose.translation().x()));
        y.push_back(static_cast<float>(pose.translation().y()));
        z.push_back(static_cast<float>(pose.translation().z()));
      }
      const Stopwatch watch;
      near = compareAllPairs(x, y, z, 1.01f);
      all.push_back(watch.seconds());
      const Stopwatch plain_watch;
      near = std::max(near, comparePairByPair(crowd.poses(), 1.01));
      plain.push_back(plain_watch.seconds());
    }
    // The grid's own clock is the wall's: the fastest tenth is what a busy machine disturbs least.
    const double of_grid = quantile(grid, 0.1), of_all = quantile(all, 0.1), of_plain = quantile(plain, 0.1);
    table.add({"grid, " + text(100 * share) + " % moving", std::to_string(options.many), "1", text(1e3 * of_grid),
               text(of_plain / of_grid) + " and " + text(of_all / of_grid) + " x cheaper than all pairs",
               std::to_string(candidates) + " candidates"});
    table.add({"all pairs of root spheres, one by one", std::to_string(options.many), "1", text(1e3 * of_plain), "",
               std::to_string(near) + " near"});
    table.add({"the same, vectorised", std::to_string(options.many), "1", text(1e3 * of_all), "", ""});
  }
}

/// Equal queries, asked by a scene of one effect and without a scene.
void measureOneEffect(const Options& options, Table& table)
{
  progress("one effect");
  SceneOptions forgetful = anyOnly(1);
  forgetful.remember = false;
  const std::size_t count = std::max<std::size_t>(options.objects / 2, 2);
  Crowd crowd(count, options.points / 4, forgetful, true);
  crowd.scene.query();
  AnyRequest request;
  request.clearance = forgetful.clearance;
  std::vector<double> scene_seconds, bare_seconds;
  bool same = true;
  for (std::size_t step = 0; step < std::max<std::size_t>(options.steps / 5, 3); ++step) {
    crowd.stir(1.0);
    const Stopwatch scene_watch;
    const SceneResult result = crowd.scene.query();
    scene_seconds.push_back(scene_watch.seconds());
    const Stopwatch bare_watch;
    std::size_t colliding = 0;
    const SphereHierarchy& hierarchy = *crowd.scene[0].parts[0].hierarchy;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j) {
        // A box test, for balls.
        const Eigen::Vector3d apart = crowd.poses()[i].translation() - crowd.poses()[j].translation();
        if (apart.cwiseAbs().maxCoeff() > 1.0 + request.clearance) continue;
        colliding +=
            anyCollision({hierarchy, crowd.poses()[i]}, {hierarchy, crowd.poses()[j]}, request).pair.has_value();
      }
    bare_seconds.push_back(bare_watch.seconds());
    same = same && colliding == result.any.size();
  }
  table.add({"scene with one effect, any", std::to_string(count), "1", text(1e3 * median(scene_seconds)),
             text(median(scene_seconds) / median(bare_seconds)) + " of the bare queries",
             same ? "same answers" : "other answers"});
}

/// A point each 5 cm.
double terrainSide(std::size_t count)
{
  return std::sqrt(static_cast<double>(count)) * 0.05;
}

double heightAt(double x, double y, double height)
{
  return height * std::sin(0.11 * x) * std::cos(0.07 * y);
}

/// @param order scan: row by row, as scanners go
std::vector<float> terrain(std::size_t count, double height, const std::string& order, std::uint64_t& state)
{
  const double side = terrainSide(count);
  std::vector<float> xyz;
  xyz.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    double x = side * uniform(state), y = side * uniform(state);
    if (order == "scan") {
      const double row = std::floor(std::sqrt(static_cast<double>(count)));
      y = 0.05 * std::floor(static_cast<double>(i) / row);
      x = 0.05 * (static_cast<double>(i) - row * std::floor(static_cast<double>(i) / row)) + 0.02 * uniform(state);
    }
    for (const double c : {x, y, heightAt(x, y, height)}) xyz.push_back(static_cast<float>(c));
  }
  return xyz;
}

/// x y z of points on the surface of a cube about the origin, row by row of each face.
std::vector<float> crate(std::size_t count, double side)
{
  const auto row = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count) / 6.0)));
  const double spacing = side / static_cast<double>(row);
  std::vector<float> xyz;
  std::uint64_t state = 7;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t face = i / (row * row), place = i % (row * row);
    const auto at = [&](std::size_t k) { return spacing * (static_cast<double>(k) + uniform(state)) - 0.5 * side; };
    double p[3] = {at(place % row), at(place / row), face % 2 ? 0.5 * side : -0.5 * side};
    std::rotate(p, p + face / 2, p + 3);
    for (const double c : p) xyz.push_back(static_cast<float>(c));
  }
  return xyz;
}

/// A hand leads a crate over a floor that is hardly bent, 3 cm with each event, down into it and up again.
void measureDrag(const Options& options, Table& table)
{
  constexpr double clearance = 0.02, bend = 0.1;
  std::uint64_t state = 3;
  const std::vector<float> floor = terrain(options.scan, bend, "scan", state);
  const auto scan = std::make_shared<SphereHierarchy>(viewOf(floor.data(), options.scan));
  scan->buildAll();
  const double reach = 0.3 * terrainSide(options.scan);
  const auto poseAt = [&](std::size_t event, double size, bool turns) {
    const auto t = static_cast<double>(event);
    const double turn = 0.03 * t / reach, x = reach * (1.7 + std::cos(turn)), y = reach * (1.7 + std::sin(turn));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() =
        Eigen::Vector3d(x, y, heightAt(x, y, bend) + 0.5 * size + clearance + 0.06 * std::sin(0.4 * t));
    if (turns)
      pose.rotate(Eigen::AngleAxisd(0.02 * t, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(0.02 * std::sin(0.13 * t), Eigen::Vector3d::UnitX()));
    return pose;
  };
  for (const double size : {0.6, 3.0}) {
    const std::vector<float> cloud = crate(options.dragged, size);
    const auto led = std::make_shared<SphereHierarchy>(viewOf(cloud.data(), options.dragged));
    led->buildAll();
    for (const Response response : {Response::stop, Response::slide})
      for (const bool turns : {false, true}) {
        const std::string name = "drag a crate of " + text(size, 2) + " m, " +
                                 (response == Response::stop ? "stop" : "slide") + (turns ? ", turning" : "");
        progress(name);
        SceneOptions of_scene;
        of_scene.effects.response = response;
        of_scene.clearance = clearance;
        of_scene.tolerance = 1e-3;
        of_scene.threads = 1;
        Scene scene(of_scene);
        scene.add(fixedObject("floor", scan));
        Eigen::Isometry3d above = poseAt(0, size, turns);
        above.translation().z() += 0.5;
        DraggedObject hand(scene, scene.add(object("crate", led, above)));
        std::vector<double> seconds;
        std::size_t touching = 0, held = 0;
        for (std::size_t event = 0; event < options.events; ++event) {
          const Stopwatch watch;
          const DragStep& now = hand.moveTo(poseAt(event, size, turns));
          seconds.push_back(watch.seconds());
          touching += now.contacts.empty() ? 0 : 1;
          held += now.held ? 1 : 0;
        }
        table.add({name, std::to_string(options.scan) + ", " + std::to_string(options.dragged), "1",
                   text(1e3 * median(seconds)), text(1e3 * quantile(seconds, 0.99)) + " ms at 99 % of the steps",
                   std::to_string(touching) + " of " + std::to_string(options.events) + " in contact, " +
                       std::to_string(held) + " held"});
      }
  }
}

void measureUpdate(const Options& options, Table& table)
{
  progress("update, " + std::to_string(options.cloud) + " points");
  const double side = terrainSide(options.cloud);
  std::uint64_t state = 3;
  std::vector<float> xyz = terrain(options.cloud, 2.0, options.order, state);
  const PointsView view = viewOf(xyz.data(), options.cloud);
  std::vector<double> sort_seconds, build_seconds, update_seconds, rebuild_seconds, scattered_seconds;
  UpdateReport report, scattered;
  for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
    progress("update, " + std::to_string(repetition + 1) + '/' + std::to_string(options.repeat));
    const Stopwatch sorting;
    SphereHierarchy hierarchy(view);
    sort_seconds.push_back(sorting.seconds());
    hierarchy.buildAll();
    build_seconds.push_back(sorting.seconds());

    // A tenth of either side: 1 % of the points get new heights, as from a new scan of the place.
    std::vector<std::int32_t> changed;
    const double low = side * (0.1 + 0.2 * repetition / options.repeat);
    for (std::size_t i = 0; i < options.cloud; ++i)
      if (xyz[3 * i] > low && xyz[3 * i] < low + 0.1 * side && xyz[3 * i + 1] > low &&
          xyz[3 * i + 1] < low + 0.1 * side)
        changed.push_back(static_cast<std::int32_t>(i));
    const auto change = [&](const std::vector<std::int32_t>& records, UpdateReport& done) {
      const Stopwatch before;
      HierarchyUpdate update(hierarchy, records.data(), records.size());
      const double first = before.seconds();
      for (const std::int32_t i : records) {
        const auto at = 3 * static_cast<std::size_t>(i) + 2;
        xyz[at] += static_cast<float>(0.02 * (uniform(state) - 0.5));
      }
      const Stopwatch after;
      done = update.commit(view);
      return first + after.seconds();
    };
    double seconds = change(changed, report);
    update_seconds.push_back(seconds);
    const Stopwatch building;
    hierarchy.buildAll(); // what is left to build: the touched voxels
    rebuild_seconds.push_back(seconds + building.seconds());

    std::vector<std::int32_t> anywhere;
    for (std::size_t i = 0; i < options.cloud / 100; ++i) anywhere.push_back(static_cast<std::int32_t>(100 * i));
    const double spread = change(anywhere, scattered);
    const Stopwatch all;
    hierarchy.buildAll();
    scattered_seconds.push_back(spread + all.seconds());
  }
  const std::string size = std::to_string(options.cloud) + ", " + options.order;
  const double sort = median(sort_seconds), build = median(build_seconds), update = median(update_seconds),
               rebuild = median(rebuild_seconds), spread = median(scattered_seconds);
  table.add({"sort into voxels", size, "1", text(1e3 * sort), "", ""});
  table.add({"sort and build all", size, "1", text(1e3 * build), "", ""});
  table.add(
      {"replace 1 % in one place", size, "1", text(1e3 * update), text(sort / update) + " x faster than sorting",
       std::to_string(report.voxels_touched) + " voxels, " + std::to_string(report.points_read) + " points read"});
  table.add(
      {"the same, and build it", size, "1", text(1e3 * rebuild), text(build / rebuild) + " x faster than all", ""});
  table.add({"replace 1 % anywhere, and build it", size, "1", text(1e3 * spread),
             text(build / spread) + " x faster than all",
             scattered.sorted_anew ? "sorted anew" : std::to_string(scattered.voxels_touched) + " voxels"});
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app(
      "Scenes of many objects: steps with 10 % of the objects moving; the grid against comparing all pairs of\n"
      "root spheres; a scene of one effect against its bare queries; replacing points of a large cloud against\n"
      "building anew; a crate that is dragged over a scanned floor.",
      "bench_scene");
  app.footer("Example: bench_scene --part steps --objects 1000 --points 10000 --threads 2");
  app.add_option("--part", options.part, "what to measure")
      ->check(CLI::IsMember({"all", "steps", "grid", "effect", "update", "drag"}))
      ->capture_default_str();
  app.add_option("--objects", options.objects, "objects that are queried")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--points", options.points, "of each object")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--steps", options.steps, "steps")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--many", options.many, "objects in the grid")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--cloud", options.cloud, "points of the cloud that is updated")
      ->check(CLI::Range(std::size_t{100}, std::size_t{2000000000}))
      ->capture_default_str();
  app.add_option("--scan", options.scan, "points of the scan that an object is dragged in")
      ->check(CLI::Range(std::size_t{100}, std::size_t{2000000000}))
      ->capture_default_str();
  app.add_option("--dragged", options.dragged, "points of that object")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--events", options.events, "times that the hand goes on")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--order", options.order, "of that cloud: scan or shuffled")
      ->check(CLI::IsMember({"scan", "shuffled"}))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "threads")->check(CLI::PositiveNumber)->capture_default_str();
  Table table({"what", "size", "threads", "median [ms]", "that is", "counted"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    const auto asked = [&](const char* part) { return options.part == "all" || options.part == part; };
    if (asked("steps")) measureSteps(options, rows);
    if (asked("grid")) measureBroadPhase(options, rows);
    if (asked("effect")) measureOneEffect(options, rows);
    if (asked("update")) measureUpdate(options, rows);
    if (asked("drag")) measureDrag(options, rows);
    return true;
  });
}
