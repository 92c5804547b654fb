// SPDX-License-Identifier: BSD-3-Clause
// How time and memory grow with the points of a site: scanned tunnels of any length in points, made to sites, and the
// way of one wagon through each. Each question is a program of its own, so that its memory and processor time are
// known.
#include "program.h"

#ifdef PCL_BSH_BENCH_CHARTS
#include <pcl_bsh/vtk/chart.h>
#endif

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

using namespace pcl_bsh::bench;

namespace {

namespace fs = std::filesystem;

struct Options : ProgramOptions {
  fs::path folder;
  std::vector<double> scales = {0.53, 5.3};
  std::string clearance = "0.05", memory = "2G", tile_points = "4M";
  unsigned ranks = 1, parts = 0, threads = 1;
  std::string chart;
};

/// Cost of a program, medians of some runs.
struct Cost {
  double wall = 0.0, processor = 0.0; ///< seconds
  double megabytes = 0.0;             ///< resident, of its largest process
};

/// Results of one size.
struct Growth {
  double points = 0.0;
  Cost make, path;
};

Cost costOf(const std::vector<std::string>& command)
{
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const Stopwatch watch;
  const pid_t id = fork();
  if (id == 0) {
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  rusage usage = {};
  wait4(id, &status, 0, &usage);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(command[0] + " " + command[1] + ": failed: run it by hand");
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {watch.seconds(), seconds(usage.ru_utime) + seconds(usage.ru_stime),
          static_cast<double>(usage.ru_maxrss) / 1024.0};
}

/// Writes pipes of 400 triangles each, as parts along a path of poses of a tunnel's axis.
void writeParts(const fs::path& file, const fs::path& poses, unsigned count)
{
  std::vector<std::array<double, 12>> frames; // upper rows of matrices
  std::ifstream in(poses);
  for (std::string line; std::getline(in, line);) {
    std::istringstream numbers(line);
    std::array<double, 12> frame;
    if (std::all_of(frame.begin(), frame.end(), [&](double& x) { return bool(numbers >> x); })) frames.push_back(frame);
  }
  std::mt19937 random(5);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  std::ofstream out(file);
  constexpr int rings = 25, corners = 8;
  for (unsigned i = 0; i < count; ++i) {
    const std::array<double, 12>& frame = frames[(2 * std::size_t{i} + 1) * frames.size() / (2 * std::size_t{count})];
    const double y = between(-3.6, 3.6), z = between(-1.5, 4.0), radius = between(0.05, 0.3);
    const double length = between(0.3, 1.5);
    out << "o part" << i << '\n';
    for (int ring = 0; ring < rings; ++ring) {
      for (int corner = 0; corner < corners; ++corner) {
        const double angle = 0.785398163397 * corner, x = length * ring / (rings - 1);
        const double p[] = {x, y + radius * std::cos(angle), z + radius * std::sin(angle)};
        out << 'v';
        for (std::size_t k = 0; k < 12; k += 4)
          out << ' ' << text(frame[k] * p[0] + frame[k + 1] * p[1] + frame[k + 2] * p[2] + frame[k + 3], 9);
        out << '\n';
      }
    }
    const int first = static_cast<int>(i) * rings * corners + 1;
    const auto at = [&](int ring, int corner) { return first + ring * corners + corner % corners; };
    for (int ring = 0; ring + 1 < rings; ++ring)
      for (int c = 0; c < corners; ++c)
        out << "f " << at(ring, c) << ' ' << at(ring, c + 1) << ' ' << at(ring + 1, c + 1) << ' ' << at(ring + 1, c)
            << '\n';
    for (const int ring : {0, rings - 1}) {
      out << 'f';
      for (int c = 0; c < corners; ++c) out << ' ' << at(ring, ring == 0 ? corners - 1 - c : c);
      out << '\n';
    }
  }
}

class Sites {
public:
  Sites(const Options& options, Table& table) : options_(options), table_(table)
  {
    fs::create_directories(options.folder);
  }

  Growth measure(double scale)
  {
    const fs::path tunnel = tunnelOf(scale), site = options_.folder / ("site_" + text(scale));
    const fs::path asker = tunnelOf(*std::max_element(options_.scales.begin(), options_.scales.end()));
    std::vector<std::string> make = {site_program, "make"};
    for (const auto& entry : fs::directory_iterator(tunnel))
      if (entry.path().extension() == ".pcd") make.push_back(entry.path().string());
    std::sort(make.begin() + 2, make.end());
    make.insert(make.end(),
                {"--out", site.string(), "--memory", options_.memory, "--tile-points", options_.tile_points});
    Growth growth;
    growth.make = medianOf("make", scale, [&] {
      fs::remove_all(site);
      return costOf(make);
    });
    std::vector<std::string> path;
    if (options_.ranks > 1) path = {"mpirun", "-n", std::to_string(options_.ranks)};
    const fs::path report = options_.folder / "report.json";
    path.insert(path.end(), {site_program, "collide", site.string(), (asker / "wagon.ply").string(), "--clearance",
                             options_.clearance, "--trajectory", (asker / "poses.txt").string(), "--memory",
                             options_.memory, "--report", report.string()});
    growth.path = medianOf("path", scale, [&] { return costOf(path); });
    growth.points = nlohmann::json::parse(std::ifstream(report)).at("points").get<double>();
    add(growth, "make", 1, growth.make);
    add(growth, "path", options_.ranks, growth.path);
    if (options_.parts > 0) {
      const fs::path parts = options_.folder / "parts.obj";
      writeParts(parts, tunnel / "poses.txt", options_.parts);
      const std::string list = (options_.folder / "clashes.json").string();
      std::vector<std::string> ask = {site_program, "collide", site.string()};
      ask.insert(ask.end(), {"--obstacle", "plant=" + parts.string() + ";parts=true", "--clearance", options_.clearance,
                             "--memory", options_.memory, "--threads", std::to_string(options_.threads), "--clashes",
                             list, "--report", report.string()});
      add(growth, "parts", 1, medianOf("parts", scale, [&] { return costOf(ask); }));
      const std::string one = "plant/part" + std::to_string(options_.parts / 2);
      ask.insert(ask.end(), {"--only", one, "--previous", list});
      add(growth, "a part", 1, medianOf("a part", scale, [&] { return costOf(ask); }));
    }
    fs::remove_all(site);
    return growth;
  }

private:
  static constexpr auto site_program = PCL_BSH_BENCH_PROGRAMS "/pcl_bsh_site";

  fs::path tunnelOf(double scale) const
  {
    const fs::path folder = options_.folder / ("tunnel_" + text(scale));
    if (fs::exists(folder / "poses.txt")) return folder;
    progress("making the tunnel of scale " + text(scale));
    costOf({PCL_BSH_BENCH_PROGRAMS "/pcl_bsh_tunnel", folder.string(), "--scale", text(scale), "--pieces", "20"});
    return folder;
  }

  template <typename Run>
  Cost medianOf(const char* what, double scale, const Run& run) const
  {
    std::vector<double> wall, processor, megabytes;
    for (unsigned i = 0; i < options_.repeat; ++i) {
      progress(std::string(what) + ", scale " + text(scale) + ", " + std::to_string(i + 1) + '/' +
               std::to_string(options_.repeat));
      const Cost cost = run();
      wall.push_back(cost.wall);
      processor.push_back(cost.processor);
      megabytes.push_back(cost.megabytes);
    }
    return {median(wall), median(processor), median(megabytes)};
  }

  void add(const Growth& growth, const char* question, unsigned ranks, const Cost& cost)
  {
    table_.add({text(growth.points), question, std::to_string(ranks), text(cost.wall), text(cost.processor),
                text(cost.megabytes), text(growth.points / cost.wall / 1e6)});
  }

  const Options& options_;
  Table& table_;
};

#ifdef PCL_BSH_BENCH_CHARTS
using namespace pcl_bsh::vtk;

/// Powers of ten around all values.
/// @param unit empty: large numbers, written as 1e9
std::vector<Tick> ticksAround(const std::vector<double>& values, const std::string& unit)
{
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  std::vector<Tick> ticks;
  for (double decade = std::floor(std::log10(*least)); ticks.size() < 2 || decade - 1.0 < std::log10(*most); ++decade) {
    std::ostringstream number;
    if (unit.empty())
      number << "1e" << decade;
    else
      number << std::pow(10.0, decade) << unit;
    ticks.push_back({std::pow(10.0, decade), number.str()});
  }
  return ticks;
}

template <typename ValueOf>
Chart chartOf(const std::vector<Growth>& sizes, const std::string& title, const std::string& unit,
              const ValueOf& valueOf)
{
  Chart chart;
  chart.title = title;
  std::vector<double> points, values;
  for (const bool is_path : {false, true}) {
    Series series;
    series.name = is_path ? "one wagon's path past it" : "make";
    series.color = distinctColor(is_path ? 1 : 0);
    series.mark = is_path ? Mark::circle : Mark::square;
    series.joined = true;
    for (const Growth& size : sizes) {
      const double value = valueOf(is_path ? size.path : size.make);
      series.points.push_back({size.points, value, text(value) + unit});
      points.push_back(size.points);
      values.push_back(value);
    }
    chart.series.push_back(std::move(series));
  }
  chart.x = {"points of the site", ticksAround(points, "")};
  chart.y = {title, ticksAround(values, unit)};
  return chart;
}

void draw(const std::vector<Growth>& sizes, const fs::path& file)
{
  writeChartsPng({chartOf(sizes, "processor time", " s", [](const Cost& cost) { return cost.processor; }),
                  chartOf(sizes, "peak of memory", " MB", [](const Cost& cost) { return cost.megabytes; })},
                 1200, 520, file);
}
#endif

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("Time and memory of sites as they grow: pcl_bsh_site makes one of a tunnel that pcl_bsh_tunnel has\n"
               "written, and asks where the wagon of the largest one comes near on its way. At scale 53 a tunnel has\n"
               "10^9 points, which with its site take 33 GB.",
               "bench_sites");
  app.footer("Example: bench_sites work --scales 0.53,5.3,53 --repeat 1 --csv sites.csv --chart sites.png");
  app.add_option("FOLDER", options.folder, "where tunnels are written, which stay, and sites")->required();
  app.add_option("--scales", options.scales, "of the tunnels")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--ranks", options.ranks, "of the path, by mpirun")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--clearance", options.clearance, "in metres")->capture_default_str();
  app.add_option("--parts", options.parts, "parts of an .obj along the tunnel, which are asked about in one question")
      ->capture_default_str();
  app.add_option("--threads", options.threads, "of that question")->capture_default_str();
  app.add_option("--memory", options.memory, "of each process")->capture_default_str();
  app.add_option("--tile-points", options.tile_points, "of a tile, at most")->capture_default_str();
#ifdef PCL_BSH_BENCH_CHARTS
  app.add_option("--chart", options.chart, "draw both, a PNG");
#endif
  const Table table({"points", "question", "ranks", "wall [s]", "user + system [s]", "peak of a process [MB]",
                     "million points a second"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    Sites sites(options, rows);
    std::vector<Growth> sizes;
    for (const double scale : options.scales) sizes.push_back(sites.measure(scale));
#ifdef PCL_BSH_BENCH_CHARTS
    if (!options.chart.empty()) draw(sizes, options.chart);
#endif
    return true;
  });
}
