// SPDX-License-Identifier: BSD-3-Clause
// Workload C: a process that meets two clouds once. Every run is a process of its own, which is given the clouds in
// memory and measures from there to the answer; racers take turns.
#include "flags_racers.h"
#include "one_shot.h"
#include "program.h"
#include "workload/scenes.h"

#include <algorithm>
#include <cmath>

using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::string scene = "terrain";
  std::size_t size = 1000000;
  std::vector<double> distances = {1, 5, 20};
  std::vector<std::string> orders = {"scan"};
  std::vector<std::string> questions = {"flags", "any"};
  std::vector<std::string> racers = {"pcl_bsh", "fitted_grid", "grid", "nanoflann"};
  std::string folder = PCL_BSH_SHARED_DIR "/data";
};

struct Entry {
  OneShot shot;
  std::vector<OneShotResult> results;

  double medianOf(double OneShotResult::*value) const
  {
    std::vector<double> values;
    for (const OneShotResult& result : results) values.push_back(result.*value);
    return median(std::move(values));
  }
  double leastOf(double OneShotResult::*value) const
  {
    const auto least = std::min_element(results.begin(), results.end(),
                                        [&](const auto& l, const auto& r) { return l.*value < r.*value; });
    return (*least).*value;
  }
};

std::string per(double value, double other)
{
  return text(value / other);
}

/// Asks one question at one distance. Returns whether all racers found as many points, except some in 10,000: float32
/// comparisons of distances differ about these.
bool race(const Options& options, const std::string& order, const std::string& question, double spacings,
          const ScanPair& pair, const CloudsInMemory& clouds, Table& table)
{
  const double d = static_cast<float>(spacings * pair.spacing);
  std::vector<Entry> entries;
  for (const std::string& name : options.racers) {
    progress(order + " " + question + ", d = " + text(spacings) + " spacings: tuning " + name);
    const auto racer = makeFlagsRacer(name);
    racer->adopt(pair.a, pair.b);
    racer->tune(d);
    entries.push_back({{name, question, d, racer->tuning()}, {}});
  }
  for (unsigned round = 0; round < options.repeat; ++round) {
    progress(order + " " + question + ", d = " + text(spacings) + " spacings, " + std::to_string(round + 1) + '/' +
             std::to_string(options.repeat));
    for (Entry& entry : entries) entry.results.push_back(runInNewProcess(entry.shot, clouds));
  }
  const Entry& first = entries.front();
  const auto points = static_cast<double>(pair.a.size() + pair.b.size());
  bool agree = true;
  for (const Entry& entry : entries) {
    const OneShotResult& last = entry.results.back();
    const double off = std::abs(static_cast<double>(last.found) - static_cast<double>(first.results.back().found));
    agree = agree && off <= 1e-4 * static_cast<double>(pair.a.size());
    table.add({order, question, text(spacings), entry.shot.racer, text(entry.medianOf(&OneShotResult::wall_ms), 4),
               text(entry.medianOf(&OneShotResult::cpu_ms), 4), text(entry.leastOf(&OneShotResult::cpu_ms), 4),
               text(entry.medianOf(&OneShotResult::build_cpu_ms), 4),
               per(first.medianOf(&OneShotResult::cpu_ms), entry.medianOf(&OneShotResult::cpu_ms)),
               per(first.leastOf(&OneShotResult::cpu_ms), entry.leastOf(&OneShotResult::cpu_ms)),
               text(entry.medianOf(&OneShotResult::build_faults), 6), text(entry.medianOf(&OneShotResult::faults), 6),
               text(entry.medianOf(&OneShotResult::peak_bytes) / points), std::to_string(last.found), last.remark});
  }
  return agree;
}

bool raceAll(const Options& options, Table& table)
{
  progress(options.scene + ": preparing");
  const auto pair = scene(options.scene, options.size, options.folder);
  if (!pair) throw std::runtime_error("scene '" + options.scene + "' has no scans in " + options.folder);
  bool agree = true;
  for (const std::string& order : options.orders) {
    const ScanPair ordered = order == "scan" ? *pair : shuffled(*pair);
    const CloudsInMemory clouds(ordered.a, ordered.b);
    for (const std::string& question : options.questions)
      for (const double spacings : options.distances)
        agree = race(options, order, question, spacings, ordered, clouds, table) && agree;
  }
  return agree;
}

} // namespace

int main(int argc, char** argv)
{
  if (isOneShot(argc, argv)) return runOneShot(argc, argv);
  Options options;
  options.repeat = 11;
  CLI::App app("A new process for each run: from two clouds in memory to the answer, everything touched for the first "
               "time.\nOne thread; racers in turns. cpu: user and system time. faults: minor page faults, of 4 kB and "
               "of huge\npages alike. peak: highest resident memory above what it was with the clouds, per point of "
               "both clouds.",
               "bench_cold");
  app.footer("Example: bench_cold --distances 1,5,20 --repeat 11 --csv cold.csv");
  app.add_option("--scene", options.scene, "terrain, sweep, hall (made); lidar, lion, autzen (real)")
      ->capture_default_str();
  app.add_option("--size", options.size, "points per cloud, made scenes")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--distances", options.distances, "d in spacings")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--folder", options.folder, "where the real scans are")->capture_default_str();
  app.add_option("--orders", options.orders, "order of the points in memory")
      ->delimiter(',')
      ->check(CLI::IsMember({"scan", "shuffled"}))
      ->capture_default_str();
  app.add_option("--questions", options.questions, "flags, any")
      ->delimiter(',')
      ->check(CLI::IsMember({"flags", "any"}))
      ->capture_default_str();
  app.add_option("--racers", options.racers, "who runs; the first is the one the others are compared with")
      ->delimiter(',')
      ->check(CLI::IsMember(kFlagsRacers))
      ->capture_default_str();
  Table table({"order", "question", "d [spacings]", "racer", "wall [ms]", "cpu [ms]", "least cpu [ms]",
               "build cpu [ms]", "first's cpu / its", "first's least / its", "build faults", "faults", "peak [B/point]",
               "found", "remark"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) { return raceAll(options, rows); });
}
