// SPDX-License-Identifier: BSD-3-Clause
// Workload F: flag every point of A that has a point of B within d. Times, ratios, and whether all racers agree.
#include "flags_racers.h"
#include "program.h"
#include "workload/nearest.h"
#include "workload/scenes.h"

#include <algorithm>
#include <cmath>

using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::vector<std::string> scenes = {"terrain"};
  std::vector<std::size_t> sizes = {1000000};
  std::vector<double> distances = {1, 5, 20};
  std::vector<std::string> orders = {"scan", "shuffled"};
  std::vector<unsigned> threads = {1};
  std::vector<std::string> racers = {"pcl_bsh", "pcl_bsh_warm", "grid", "plain_grid", "nanoflann", "pcl_kdtree"};
  std::string folder = PCL_BSH_SHARED_DIR "/data";
};

/// The difference of two racers' answers.
struct Disagreement {
  std::size_t points = 0;
  std::size_t wrong = 0; ///< of these, not explained by float rounding: the distance is off d by more than 1e-5 d
};

/// Judged by the true distance in double; `flags` against the first racer's.
Disagreement compare(const std::vector<std::uint8_t>& flags, const std::vector<std::uint8_t>& first, const Points& a,
                     const NearestDistance& nearest, double d)
{
  Disagreement result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (flags[i] == first[i]) continue;
    ++result.points;
    result.wrong += std::abs(nearest.to(a[i]) - d) > 1e-5 * d;
  }
  return result;
}

struct Entry {
  std::string name;
  std::unique_ptr<FlagsRacer> racer;
  std::vector<double> build, query, total;
  FlagsRun last;
};

/// `value` over the median of the racer named, or a dash when that one does not run.
std::string ratio(double value, const std::vector<Entry>& entries, const std::string& name,
                  std::vector<double> Entry::*times)
{
  const auto it = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == name; });
  return it == entries.end() ? "-" : text(value / median((*it).*times));
}

/// One order of one scene: all distances and thread counts. Repetitions go round the racers, so that a busy moment of
/// the machine falls on all of them.
bool race(const Options& options, const std::string& scene_name, const std::string& order, const ScanPair& pair,
          Table& table)
{
  bool sound = true;
  const NearestDistance nearest(pair.b);
  std::vector<Entry> entries;
  for (const auto& name : options.racers) {
    entries.push_back({name, makeFlagsRacer(name), {}, {}, {}, {}});
    entries.back().racer->adopt(pair.a, pair.b);
  }
  for (const double spacings : options.distances) {
    const double d = static_cast<float>(spacings * pair.spacing); // the same number for float and double racers
    for (auto& entry : entries) entry.racer->tune(d);
    for (const unsigned threads : options.threads) {
      for (auto& entry : entries) entry.build.clear(), entry.query.clear(), entry.total.clear();
      for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
        for (auto& entry : entries) {
          progress(scene_name + ' ' + order + ", d = " + text(spacings) + " spacings, " + std::to_string(threads) +
                   " threads, " + entry.name + ", " + std::to_string(repetition + 1) + '/' +
                   std::to_string(options.repeat));
          entry.last = entry.racer->run(d, threads);
          entry.build.push_back(entry.last.build_seconds);
          entry.query.push_back(entry.last.query_seconds);
          entry.total.push_back(entry.last.totalSeconds());
        }
      }
      for (const auto& entry : entries) {
        const Disagreement off = compare(entry.last.flags, entries.front().last.flags, pair.a, nearest, d);
        sound = sound && off.wrong == 0;
        const double build = median(entry.build), query = median(entry.query), total = median(entry.total);
        table.add({scene_name, std::to_string(pair.a.size()), order, text(spacings), std::to_string(threads),
                   entry.name, text(1e3 * build, 4), text(1e3 * query, 4), text(1e3 * total, 4),
                   ratio(total, entries, "pcl_bsh", &Entry::total),
                   ratio(query, entries, "pcl_bsh_warm", &Entry::query),
                   std::to_string(std::count(entry.last.flags.begin(), entry.last.flags.end(), 1)),
                   std::to_string(off.points), std::to_string(off.wrong), entry.last.remark});
      }
    }
  }
  return sound;
}

bool raceAll(const Options& options, Table& table)
{
  bool sound = true;
  for (const auto& name : options.scenes) {
    const bool made = std::count(kMadeScenes.begin(), kMadeScenes.end(), name) > 0;
    for (const std::size_t size : made ? options.sizes : std::vector<std::size_t>{0}) {
      progress(name + ": preparing");
      const auto pair = scene(name, size, options.folder);
      if (!pair) {
        progress(name + ": no such scans in " + options.folder + ": skipped");
        continue;
      }
      for (const auto& order : options.orders)
        sound = race(options, name, order, order == "scan" ? *pair : shuffled(*pair), table) && sound;
    }
  }
  return sound;
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  std::vector<std::string> all_scenes = kMadeScenes;
  all_scenes.insert(all_scenes.end(), kRealScenes.begin(), kRealScenes.end());
  CLI::App app("Flags every point of A with a point of B within d: pcl_bsh against its peers.\n"
               "Medians of interleaved repetitions; the peers index B only, pcl_bsh both clouds.",
               "bench_flags");
  app.footer("Example: bench_flags --scene terrain --sizes 1000000 --distances 1,5,20 --threads 1,2 --csv flags.csv");
  app.add_option("--scene", options.scenes, "terrain, sweep, hall (made); lidar, lion, autzen (real)")
      ->delimiter(',')
      ->check(CLI::IsMember(all_scenes))
      ->capture_default_str();
  app.add_option("--sizes", options.sizes, "points per cloud, made scenes")
      ->delimiter(',')
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
  app.add_option("--threads", options.threads, "numbers of threads")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--racers", options.racers, "who runs; the first is the one the others are compared with")
      ->delimiter(',')
      ->check(CLI::IsMember(kFlagsRacers))
      ->capture_default_str();
  Table table({"scene", "points", "order", "d [spacings]", "threads", "racer", "build [ms]", "query [ms]", "total [ms]",
               "total / pcl_bsh", "query / pcl_bsh_warm", "flagged", "disagree", "wrong", "remark"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) { return raceAll(options, rows); });
}
