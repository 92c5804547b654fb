// SPDX-License-Identifier: BSD-3-Clause
// Neighbours of points, by everyone who finds them: build, within a radius, k nearest, the nearest in a radius, balls
// that hold a point or not. Times, ratios, and whether all racers agree.
#include "program.h"
#include "search_racers.h"
#include "workload/random.h"
#include "workload/scenes.h"

#include <algorithm>
#include <cmath>
#include <functional>

using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::vector<std::string> scenes = {"terrain", "autzen"};
  std::vector<std::string> orders = {"scan", "shuffled"};
  std::vector<std::string> tasks = {"build", "radius30", "radius300", "radius30_1", "knn1", "knn8", "knn30", "probes"};
  std::vector<std::string> racers = kSearchRacers;
  std::size_t size = 1000000;
  std::size_t queries = 200000;
  std::string folder = PCL_BSH_SHARED_DIR "/data";
};

/// The questions about one cloud.
struct Workload {
  Points cloud;
  double spacing = 0.0;
  Points queries; ///< in scan order: points of the cloud, as filters ask; shuffled: half of them off the surface
  Points centers; ///< of balls, five times as many
  std::vector<float> radii; ///< 2 to 20 spacings
};

/// `count` points of the cloud in its order.
Points sampled(const Points& cloud, std::size_t count)
{
  Points sample;
  count = std::min(count, cloud.size());
  for (std::size_t i = 0; i < count; ++i) sample.push_back(cloud[i * cloud.size() / count]);
  return sample;
}

/// Moves every other point by up to `reach` along each axis.
Points loosened(Points points, double reach, Random& random)
{
  for (std::size_t i = 0; i < points.size(); i += 2)
    for (float* x : {&points[i].x, &points[i].y, &points[i].z}) *x += static_cast<float>(random.uniform(-reach, reach));
  return points;
}

Workload workload(const ScanPair& pair, const std::string& order, std::size_t queries)
{
  Random random(11);
  Workload work;
  work.cloud = order == "scan" ? pair.a : shuffled(pair.a, 5);
  work.spacing = pair.spacing;
  work.queries = sampled(work.cloud, queries);
  if (order == "shuffled") work.queries = loosened(work.queries, 3 * pair.spacing, random);
  work.centers.reserve(5 * queries);
  for (std::size_t i = 0; i < 5 * queries; ++i) work.centers.push_back(work.cloud[random.below(work.cloud.size())]);
  work.centers = loosened(work.centers, 20 * pair.spacing, random);
  for (std::size_t i = 0; i < work.centers.size(); ++i)
    work.radii.push_back(static_cast<float>(pair.spacing * random.uniform(2, 20)));
  return work;
}

/// The radius within which points of the cloud have about `wanted` neighbours on average.
float radiusFor(const Workload& work, double wanted)
{
  const auto racer = makeSearchRacer("nanoflann");
  racer->adopt(work.cloud);
  racer->build();
  Random random(12);
  Points sample;
  for (int i = 0; i < 500; ++i) sample.push_back(work.cloud[random.below(work.cloud.size())]);
  double low = 0.0, high = 200 * work.spacing;
  for (int step = 0; step < 40; ++step) {
    const double middle = (low + high) / 2;
    const auto answer = racer->radius(sample, static_cast<float>(middle), 0);
    (static_cast<double>(answer->found) < wanted * static_cast<double>(sample.size()) ? low : high) = middle;
  }
  return static_cast<float>(high);
}

struct Entry {
  std::string name;
  std::unique_ptr<SearchRacer> racer;
  std::vector<double> seconds;
  std::optional<SearchAnswer> answer;
};

using Ask = std::function<std::optional<SearchAnswer>(const SearchRacer&)>;

/// Whether two racers found equal answers, except for rounding at the end of a radius.
bool agree(const SearchAnswer& x, const SearchAnswer& y)
{
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-3 * std::max(a, b); };
  return near(static_cast<double>(x.found), static_cast<double>(y.found)) &&
         (!x.squared_distances || !y.squared_distances || near(*x.squared_distances, *y.squared_distances));
}

class Race {
public:
  Race(const Options& options, const std::string& scene, const std::string& order, const ScanPair& pair, Table& table)
  : options_(options),
    scene_(scene),
    order_(order),
    work_(workload(pair, order, options.queries)),
    table_(table)
  {
    for (const auto& name : options.racers) {
      entries_.push_back({name, makeSearchRacer(name), {}, {}});
      entries_.back().racer->adopt(work_.cloud);
    }
  }

  bool run()
  {
    const float near = radiusFor(work_, 30), far = radiusFor(work_, 300);
    for (auto& entry : entries_) entry.racer->tune(near);
    for (unsigned repetition = 0; repetition < options_.repeat; ++repetition) {
      for (auto& entry : entries_) {
        entry.racer->release();
        const Stopwatch watch;
        entry.racer->build();
        entry.seconds.push_back(watch.seconds());
      }
    }
    report("build", 1);

    const auto within = [this](float radius, unsigned most) {
      return [this, radius, most](const SearchRacer& racer) { return racer.radius(work_.queries, radius, most); };
    };
    const auto nearest = [this](unsigned k) {
      return [this, k](const SearchRacer& racer) { return racer.nearest(work_.queries, k); };
    };
    const std::size_t count = work_.queries.size();
    race("radius30", count, within(near, 0));
    race("radius30_1", count, within(near, 1));
    for (auto& entry : entries_)
      if (entry.racer->tune(far)) entry.racer->build();
    race("radius300", count, within(far, 0));
    for (auto& entry : entries_)
      if (entry.racer->tune(near)) entry.racer->build();
    race("knn1", count, nearest(1));
    race("knn8", count, nearest(8));
    race("knn30", count, nearest(30));
    race("probes", work_.centers.size(),
         [this](const SearchRacer& racer) { return racer.probes(work_.centers, work_.radii); });
    return sound_;
  }

private:
  bool wanted(const std::string& task) const
  {
    return std::find(options_.tasks.begin(), options_.tasks.end(), task) != options_.tasks.end();
  }

  /// Repetitions go round the racers, so that a busy moment of the machine falls on all of them. The first round is not
  /// counted: caches, and what a library sets up when first asked.
  void race(const std::string& task, std::size_t queries, const Ask& ask)
  {
    if (!wanted(task)) return;
    for (auto& entry : entries_) entry.seconds.clear();
    for (unsigned repetition = 0; repetition <= options_.repeat; ++repetition) {
      for (auto& entry : entries_) {
        progress(scene_ + ' ' + order_ + ", " + task + ", " + entry.name + ", " + std::to_string(repetition) + '/' +
                 std::to_string(options_.repeat));
        const Stopwatch watch;
        entry.answer = ask(*entry.racer);
        const double seconds = watch.seconds();
        if (!entry.answer) continue;
        entry.answer = entry.racer->completed(*entry.answer);
        if (repetition > 0) entry.seconds.push_back(seconds);
      }
    }
    report(task, queries);
  }

  void report(const std::string& task, std::size_t queries)
  {
    if (!wanted(task)) return;
    const auto& first = entries_.front();
    for (const auto& entry : entries_) {
      if (entry.seconds.empty()) continue;
      const bool same = !entry.answer || !first.answer || agree(*entry.answer, *first.answer);
      sound_ = sound_ && same;
      const double seconds = median(entry.seconds);
      table_.add({scene_, std::to_string(work_.cloud.size()), order_, task, std::to_string(queries), entry.name,
                  text(1e3 * seconds, 4), text(1e9 * seconds / static_cast<double>(queries), 4),
                  text(seconds / median(first.seconds)),
                  entry.answer ? text(static_cast<double>(entry.answer->found) / static_cast<double>(queries)) : "-",
                  same ? "yes" : "NO"});
    }
  }

  const Options& options_;
  const std::string scene_, order_;
  const Workload work_;
  Table& table_;
  std::vector<Entry> entries_;
  bool sound_ = true;
};

bool raceAll(const Options& options, Table& table)
{
  bool sound = true;
  for (const auto& name : options.scenes) {
    progress(name + ": preparing");
    const auto pair = scene(name, options.size, options.folder);
    if (!pair) {
      progress(name + ": no such scan in " + options.folder + ": skipped");
      continue;
    }
    for (const auto& order : options.orders) sound = Race(options, name, order, *pair, table).run() && sound;
  }
  return sound;
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  std::vector<std::string> all_scenes = kMadeScenes;
  all_scenes.insert(all_scenes.end(), kRealScenes.begin(), kRealScenes.end());
  const std::vector<std::string> all_tasks = options.tasks;
  CLI::App app("Neighbours of points: pcl_bsh's search class against its peers, each on one thread.\n"
               "Medians of interleaved repetitions. Ratios are to the first racer.",
               "bench_search");
  app.footer("Example: bench_search --scene terrain,autzen --clock cpu --csv search.csv");
  app.add_option("--scene", options.scenes, "terrain, sweep, hall (made); lidar, lion, autzen (real)")
      ->delimiter(',')
      ->check(CLI::IsMember(all_scenes))
      ->capture_default_str();
  app.add_option("--size", options.size, "points of a made cloud")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--queries", options.queries, "queries of a task; five times as many balls")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--orders", options.orders,
                 "scan: cloud and queries as scanned, queries at points of the cloud; shuffled: both without order, "
                 "half of the queries off the surface")
      ->delimiter(',')
      ->check(CLI::IsMember({"scan", "shuffled"}))
      ->capture_default_str();
  app.add_option("--tasks", options.tasks,
                 "radius30: a radius with 30 neighbours on average; radius30_1: the nearest one in it; knn8: the 8 "
                 "nearest; probes: does a ball of 2 to 20 spacings hold a point")
      ->delimiter(',')
      ->check(CLI::IsMember(all_tasks))
      ->capture_default_str();
  app.add_option("--racers", options.racers, "who runs; the first is the one the others are compared with")
      ->delimiter(',')
      ->check(CLI::IsMember(kSearchRacers))
      ->capture_default_str();
  app.add_option("--folder", options.folder, "where the real scans are")->capture_default_str();
  Table table({"scene", "points", "order", "task", "queries", "racer", "time [ms]", "per query [ns]", "ratio",
               "found per query", "agree"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) { return raceAll(options, rows); });
}
