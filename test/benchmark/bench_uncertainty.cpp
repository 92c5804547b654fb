// SPDX-License-Identifier: BSD-3-Clause
// What verdicts cost that hold wherever points truly are: flags of a scan, plain, with one length for all points of
// both clouds, and with a length for each point.
#include "program.h"
#include "workload/random.h"
#include "workload/scenes.h"

#include <pcl_bsh/collision/collision_flags.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::vector<std::string> scenes = {"terrain", "lion"};
  std::vector<double> clearances = {1.0, 5.0, 20.0};
  std::size_t size = 300000;
  std::string folder = PCL_BSH_SHARED_DIR "/data";
};

enum class Kind { plain, one_length, each_point };
constexpr std::array<const char*, 3> kNames = {"plain", "one length", "a length per point"};

/// Lengths up to a tenth of the clearance.
std::vector<float> lengths(std::size_t count, double clearance, std::uint64_t seed)
{
  std::vector<float> drawn(count);
  for (std::size_t i = 0; i < count; ++i) drawn[i] = static_cast<float>(0.1 * clearance * unit(mix(seed + i)));
  return drawn;
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
    return view;
  }

  std::vector<float> each;
  SphereHierarchy hierarchy;
};

struct Entry {
  std::vector<double> seconds;
  FlagsResult found;
};

void measure(const std::string& name, const ScanPair& pair, double spacings, const Options& options, Table& table)
{
  const double clearance = spacings * pair.spacing;
  std::array<Entry, kNames.size()> entries;
  for (unsigned repetition = 0; repetition < options.repeat; ++repetition) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      progress(name + ", clearance " + text(clearance) + ", " + kNames[k]);
      const auto kind = static_cast<Kind>(k);
      const Cloud a(pair.a, kind, clearance, 1), b(pair.b, kind, clearance, 1u << 30);
      FlagsRequest request;
      request.clearance = clearance;
      collisionFlags({a.hierarchy}, {b.hierarchy}, request, entries[k].found); // builds what queries share
      const Stopwatch watch;
      collisionFlags({a.hierarchy}, {b.hierarchy}, request, entries[k].found);
      entries[k].seconds.push_back(watch.seconds());
    }
  }
  const double plain = quantile(entries[0].seconds, 0.0);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const double least = quantile(entries[k].seconds, 0.0);
    table.add({name, std::to_string(pair.a.size()), text(spacings), kNames[k], text(1e3 * least, 4),
               text(least / plain), std::to_string(entries[k].found.colliding_a),
               std::to_string(entries[k].found.undecided_a)});
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
    for (const double spacings : options.clearances) measure(name, *pair, spacings, options, table);
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
      "Flags of a scan whose points may be elsewhere: by up to a tenth of the clearance, drawn for each point of "
      "both clouds,\nor by half of that for all. One thread, hierarchies built. Ratios are of the smallest times, "
      "to the plain query.",
      "bench_uncertainty");
  app.footer("Example: bench_uncertainty --scene terrain,lion --clock cpu --csv uncertainty.csv");
  app.add_option("--scene", options.scenes, "terrain, sweep, hall (made); lidar, lion, autzen (real)")
      ->delimiter(',')
      ->check(CLI::IsMember(all_scenes))
      ->capture_default_str();
  app.add_option("--size", options.size, "points of a made cloud")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--clearances", options.clearances, "in spacings of the cloud")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--folder", options.folder, "where the real scans are")->capture_default_str();
  Table table(
      {"scene", "points", "clearance [spacings]", "uncertainty", "least [ms]", "ratio", "colliding", "undecided"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) { return measureAll(options, rows); });
}
