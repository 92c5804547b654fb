// SPDX-License-Identifier: BSD-3-Clause
// How far is each point of a cloud from another cloud? From two clouds in memory to a distance for each point: ours
// builds two hierarchies, the others one index, and ask it point by point.
#include "program.h"
#include "search_racers.h"
#include "workload/scenes.h"

#include <pcl_bsh/distances/point_distances.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

using namespace pcl_bsh::bench;

namespace {

const std::vector<std::string> kRacers = {"pcl_bsh",           "pcl_bsh_query", "pcl_bsh_both",
                                          "pcl_bsh_hausdorff", "nanoflann",     "pcl_kdtree"};

struct Options : ProgramOptions {
  std::vector<std::string> scenes = {"terrain", "lion", "autzen"};
  std::vector<std::string> orders = {"scan"};
  std::vector<double> limits = {0.0, 5.0};
  std::vector<std::string> racers = kRacers;
  std::size_t size = 1000000;
  unsigned threads = 1;
  std::string folder = PCL_BSH_SHARED_DIR "/data";
};

/// Answers that racers must share: in one direction within rounding, in both directions the equal double.
struct Answer {
  std::optional<std::size_t> measured;
  double squared_distances = 0.0;
  std::optional<double> hausdorff; ///< NaN where a limit hides it
};

struct Entry {
  std::string name;
  std::vector<double> seconds;
  Answer answer;
};

class Race {
public:
  /// @param limit of distances, infinity for none
  Race(const Options& options, const ScanPair& pair, double limit) : options_(options), pair_(pair), limit_(limit)
  {
    request_.max_distance = limit;
    request_.threads = options.threads;
  }

  void run(Entry& entry) const
  {
    if (entry.name == "nanoflann" || entry.name == "pcl_kdtree") return runPeer(entry);
    const auto build = [](const Points& points) {
      return pcl_bsh::SphereHierarchy(pcl_bsh::viewOf(&points.data()->x, points.size(), sizeof(Point)));
    };
    std::optional<Stopwatch> watch(std::in_place);
    const pcl_bsh::SphereHierarchy a = build(pair_.a), b = build(pair_.b);
    if (entry.name == "pcl_bsh_query") {
      pcl_bsh::pointDistances(a, b, request_); // which builds what a query visits
      watch.emplace();
    }
    if (entry.name == "pcl_bsh_hausdorff") {
      pcl_bsh::HausdorffRequest request;
      request.threads = request_.threads;
      entry.answer.hausdorff = pcl_bsh::hausdorffDistance(a, b, request).distance;
      entry.seconds.push_back(watch->seconds());
      return;
    }
    pcl_bsh::PointDistances found;
    std::optional<double> hausdorff;
    if (entry.name == "pcl_bsh_both") {
      pcl_bsh::SymmetricDistances both = pcl_bsh::symmetricDistances(a, b, request_);
      found = std::move(both.a);
      hausdorff = both.hausdorff;
    }
    else
      pcl_bsh::pointDistances(a, b, request_, found);
    entry.seconds.push_back(watch->seconds());
    entry.answer = {found.measured, 0.0, hausdorff};
    for (const double distance : found.distance)
      if (!std::isnan(distance)) entry.answer.squared_distances += distance * distance;
  }

private:
  void runPeer(Entry& entry) const
  {
    const auto racer = makeSearchRacer(entry.name);
    racer->adopt(pair_.b);
    const Stopwatch watch;
    racer->build();
    const std::optional<SearchAnswer> found =
        std::isinf(limit_) ? racer->nearest(pair_.a, 1) : racer->radius(pair_.a, static_cast<float>(limit_), 1);
    entry.seconds.push_back(watch.seconds());
    entry.answer = {found->found, found->squared_distances.value_or(0.0), {}};
  }

  const Options& options_;
  const ScanPair& pair_;
  const double limit_;
  pcl_bsh::PointDistancesRequest request_;
};

bool agree(const Answer& x, const Answer& y)
{
  const auto near = [](double p, double q) { return std::abs(p - q) <= 1e-4 * std::max(p, q); };
  const bool direction = !x.measured || !y.measured ||
                         (near(static_cast<double>(*x.measured), static_cast<double>(*y.measured)) &&
                          near(x.squared_distances, y.squared_distances));
  const bool both = !x.hausdorff || !y.hausdorff || std::isnan(*x.hausdorff) || std::isnan(*y.hausdorff) ||
                    *x.hausdorff == *y.hausdorff;
  return direction && both;
}

bool raceAll(const Options& options, Table& table)
{
  bool sound = true;
  for (const auto& name : options.scenes) {
    progress(name + ": preparing");
    const auto given = scene(name, options.size, options.folder);
    if (!given) {
      progress(name + ": no such scan in " + options.folder + ": skipped");
      continue;
    }
    for (const auto& order : options.orders) {
      const ScanPair pair = order == "scan" ? *given : shuffled(*given);
      for (const double spacings : options.limits) {
        const double limit = spacings > 0.0 ? spacings * pair.spacing : std::numeric_limits<double>::infinity();
        const Race race(options, pair, limit);
        std::vector<Entry> entries;
        for (const auto& racer : options.racers) entries.push_back({racer, {}, {}});
        for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
          for (Entry& entry : entries) {
            progress(name + ' ' + order + ", " + entry.name + ", " + std::to_string(repetition + 1) + '/' +
                     std::to_string(options.repeat));
            race.run(entry);
          }
        }
        for (const Entry& entry : entries) {
          const bool same = std::all_of(entries.begin(), entries.end(),
                                        [&](const Entry& other) { return agree(entry.answer, other.answer); });
          sound = sound && same;
          const double least = quantile(entry.seconds, 0.0);
          table.add({name, std::to_string(pair.a.size()), order, spacings > 0.0 ? text(spacings) : "none", entry.name,
                     text(1e3 * least, 4), text(1e3 * median(entry.seconds), 4),
                     text(least / quantile(entries.front().seconds, 0.0)),
                     entry.answer.measured ? std::to_string(*entry.answer.measured) : "-", same ? "yes" : "NO"});
        }
      }
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
  CLI::App app("The distance of each point of a cloud to the nearest point of another one: pcl_bsh against its peers.\n"
               "Times from clouds in memory to distances; repetitions go round the racers. Ratios are of the smallest "
               "times, to the first racer.",
               "bench_distances");
  app.footer("Example: bench_distances --scene terrain,lion --clock cpu --csv distances.csv");
  app.add_option("--scene", options.scenes, "terrain, sweep, hall (made); lidar, lion, autzen (real)")
      ->delimiter(',')
      ->check(CLI::IsMember(all_scenes))
      ->capture_default_str();
  app.add_option("--size", options.size, "points of a made cloud")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--orders", options.orders, "scan, shuffled")
      ->delimiter(',')
      ->check(CLI::IsMember({"scan", "shuffled"}))
      ->capture_default_str();
  app.add_option("--limits", options.limits, "greatest distances in spacings of the cloud; 0: none")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option(
         "--racers", options.racers,
         "who runs; the first is the one the others are compared with. pcl_bsh_query: hierarchies built before; "
         "pcl_bsh_both: both directions; pcl_bsh_hausdorff: the greatest of both directions alone, without a limit")
      ->delimiter(',')
      ->check(CLI::IsMember(kRacers))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "of pcl_bsh")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--folder", options.folder, "where the real scans are")->capture_default_str();
  Table table({"scene", "points", "order", "limit [spacings]", "racer", "least [ms]", "median [ms]", "ratio",
               "measured", "agree"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) { return raceAll(options, rows); });
}
