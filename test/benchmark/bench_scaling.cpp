// SPDX-License-Identifier: BSD-3-Clause
// How time and memory grow with the points: workload F at one distance, from 10^4 to 10^7 points.
#include "flags_racers.h"
#include "program.h"
#include "workload/scenes.h"

#include <algorithm>
#include <cmath>

using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::string scene = "terrain";
  std::string order = "scan";
  std::vector<std::size_t> sizes = {10000, 100000, 1000000, 10000000};
  double distance = 5;
  unsigned threads = 1;
  std::vector<std::string> racers = {"pcl_bsh", "pcl_bsh_warm", "grid", "nanoflann"};
};

void measure(const Options& options, Table& table)
{
  for (const std::size_t size : options.sizes) {
    progress("making " + options.scene + ", " + std::to_string(size) + " points");
    auto pair = scene(options.scene, size, "");
    if (options.order == "shuffled") pair = shuffled(*pair);
    const double d = static_cast<float>(options.distance * pair->spacing);
    const std::size_t both = pair->a.size() + pair->b.size();
    for (const auto& name : options.racers) {
      std::vector<double> build, query, bytes;
      for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
        progress(name + ", " + std::to_string(size) + " points, " + std::to_string(repetition + 1) + '/' +
                 std::to_string(options.repeat));
        // A fresh racer each time: what an earlier run left allocated would hide what this one needs.
        const auto racer = makeFlagsRacer(name);
        racer->adopt(pair->a, pair->b);
        racer->tune(d);
        const MemoryPeak peak;
        const FlagsRun run = racer->run(d, options.threads);
        bytes.push_back(static_cast<double>(peak.bytes()));
        build.push_back(run.build_seconds);
        query.push_back(run.query_seconds);
      }
      const double n = 0.5 * static_cast<double>(both), total = median(build) + median(query);
      table.add({options.scene, options.order, std::to_string(pair->a.size()), std::to_string(both),
                 std::to_string(options.threads), name, text(1e3 * median(build)), text(1e3 * median(query)),
                 text(1e9 * total / (n * std::log2(n))), text(median(bytes) / static_cast<double>(both))});
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("Time and peak memory of flags (A against B within d) as the clouds grow. Memory is what the process\n"
               "held at most beyond the clouds themselves, both indices and the result included; below 10^5 points it\n"
               "shows mostly the granularity of pages.",
               "bench_scaling");
  app.footer("Example: bench_scaling --sizes 10000,100000,1000000,10000000 --csv scaling.csv");
  app.add_option("--scene", options.scene, "made scene")->check(CLI::IsMember(kMadeScenes))->capture_default_str();
  app.add_option("--order", options.order, "scan or shuffled")
      ->check(CLI::IsMember({"scan", "shuffled"}))
      ->capture_default_str();
  app.add_option("--sizes", options.sizes, "points per cloud")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--distance", options.distance, "d in spacings")->check(CLI::NonNegativeNumber)->capture_default_str();
  app.add_option("--threads", options.threads, "threads")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--racers", options.racers, "who runs")
      ->delimiter(',')
      ->check(CLI::IsMember(kFlagsRacers))
      ->capture_default_str();
  Table table({"scene", "order", "points of A", "points of A + B", "threads", "racer", "build [ms]", "query [ms]",
               "total / (n log2 n) [ns]", "peak [bytes/point of A + B]"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    measure(options, rows);
    return true;
  });
}
