// SPDX-License-Identifier: BSD-3-Clause
// How long a gauging run takes: a scanned line from a LAS file to its tables.
#include "program.h"

#include "io/clouds/las_sample.h"
#include "support/random_clouds.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/reports/gauge_run.h>
#include <pcl_bsh/search/cloud_view.h>

#include <cmath>
#include <limits>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

constexpr double pitch = 0.001; ///< of coordinates in the file

struct Options : ProgramOptions {
  std::size_t points = 2'000'000;
};

/// 1 km: straights, clothoids and an arc, with cant and grades. @param aside to the right of the first one
AxisDescription line(double aside)
{
  const double radius = 400 - aside;
  AxisDescription description;
  description.plan = {{200, 0, 0, AxisStart{1000, 2000 - aside, 0}},
                      {100, 0, 1 / radius},
                      {radius, 1 / radius, 1 / radius},
                      {100, 1 / radius, 0},
                      {200, 0, 0}};
  description.grades = {{0, 30}, {500, 35, 200}, {1000, 30}};
  description.cants = {{200, 0}, {300, 0.12}, {700, 0.12}, {800, 0}};
  return description;
}

/// Points of it, 5 m apart, and arcs between them. They are on the low rail's height, as cant turns about it.
Axis measured(AxisDescription description)
{
  const Axis canted(description);
  description.cants.clear();
  const Axis flat(description);
  std::vector<AxisPoint> points;
  for (double at = 0; at <= flat.length(); at += 5) points.push_back({at, flat.frame(at).origin, canted.cant(at)});
  return Axis::through(points);
}

struct Truth {
  double offset, height;
};

/// Walls and floor of a tunnel beside the axis.
io::LasSample scanOf(const Axis& axis, std::size_t points, std::vector<Truth>& truth)
{
  io::LasSample sample(4, 6);
  sample.scale = {pitch, pitch, pitch};
  sample.offset = {0, 0, 0};
  test::Random random(3);
  std::string record(sample.length(), '\0');
  for (std::size_t i = 0; i < points; ++i) {
    const AxisFrame frame = axis.frame(1 + 0.98 * axis.length() * static_cast<double>(i) / static_cast<double>(points));
    const double around = random.uniform(0, 6.28), radius = random.uniform(2.6, 2.8);
    const Truth at{radius * std::cos(around), 2.1 + radius * std::sin(around)};
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = frame.origin[k] + at.offset * frame.right[k] + at.height * frame.up[k];
      io::put(record, 4 * k, static_cast<std::int32_t>(std::lround(x / pitch)));
    }
    sample.points.push_back(record);
    truth.push_back(at);
  }
  return sample;
}

std::vector<Envelope> profiles(std::size_t count)
{
  const std::vector<SectionPoint> gauge = {{-1.6, 0.1}, {1.6, 0.1},  {1.8, 1.2},  {1.8, 3.1},  {1.3, 3.9},
                                           {0.9, 4.3},  {-0.9, 4.3}, {-1.3, 3.9}, {-1.8, 3.1}, {-1.8, 1.2}};
  const std::vector<SectionPoint> wagon = {{-1.4, 0.2}, {1.4, 0.2},  {1.5, 1.2}, {1.5, 3},
                                           {1.1, 3.9},  {-1.1, 3.9}, {-1.5, 3},  {-1.5, 1.2}};
  std::vector<Envelope> all = {
      Envelope({"gauge", gauge}), Envelope({"wagon", wagon, {}, {}, {}, Vehicle{19, 3.7}}),
      Envelope({"wide", wagon, {}, Piecewise::through({{0, 0}, {1000, 0.3}}, Piecewise::Ends::held)})};
  all.resize(count, all.front());
  return all;
}

/// Calls use(batch, number of its first point) for the whole file, and returns the seconds of it all.
template <typename Use>
double readAll(const std::filesystem::path& file, const Use& use)
{
  const Stopwatch watch;
  const auto stream = io::openCloud(file, std::numeric_limits<std::uint64_t>::max(), {}, 1);
  pcl::PCLPointCloud2 batch = stream->header();
  batch.data.resize(io::gauge_batch_points * batch.point_step);
  batch.height = 1;
  for (std::uint64_t first = 0;;) {
    const std::size_t count = stream->read(batch.data.data(), io::gauge_batch_points);
    if (count == 0) return watch.seconds();
    batch.width = static_cast<pcl::uindex_t>(count);
    batch.row_step = batch.width * batch.point_step;
    use(viewOf(batch), first);
    first += count;
  }
}

/// @return whether all points have the place that they were made at, within a tolerance
bool measure(const std::string& what, const std::filesystem::path& file, const std::vector<Track>& tracks,
             const std::vector<Truth>& truth, double tolerance, const Options& options, Table& table)
{
  progress(what);
  std::vector<double> reading, all;
  std::size_t wrong = 0, infringing = 0;
  for (unsigned i = 0; i < options.repeat; ++i) {
    reading.push_back(readAll(file, [](const PointsView&, std::uint64_t) {}));
    io::GaugeReport report{"scan", "m", "", tracks, {}, io::tablesOf(tracks, 1.0), {}};
    io::GaugeRun run(report, 1);
    wrong = 0;
    all.push_back(readAll(file, [&](const PointsView& points, std::uint64_t first) {
      const GaugedPoints found = std::move(run.add(points, first).each.front());
      for (std::size_t p = 0; p < points.count; ++p)
        wrong += !(std::abs(found.place[p].offset - truth[first + p].offset) < tolerance &&
                   std::abs(found.place[p].height - truth[first + p].height) < tolerance);
    }));
    infringing = report.infringing;
  }
  const double of_a_point = 1e6 / static_cast<double>(truth.size());
  table.add({what, std::to_string(tracks.size()), std::to_string(tracks.front().envelopes.size()),
             std::to_string(truth.size()), text(of_a_point * median(reading)), text(of_a_point * median(all)),
             std::to_string(infringing), std::to_string(wrong)});
  return wrong == 0;
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("Gauging a scanned line: from a LAS file to tables by chainage, on one thread.", "bench_gauge");
  app.footer("Example: bench_gauge --clock cpu --repeat 5");
  app.add_option("--points", options.points, "of the scan")->check(CLI::PositiveNumber)->capture_default_str();
  const Table table(
      {"axis", "tracks", "profiles", "points", "reading [us a point]", "all [us a point]", "infringing", "wrong"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    const Axis left(line(0)), right(line(4));
    std::vector<Truth> truth;
    const files::TemporaryFolder folder;
    const auto file = folder.write("scan.las", scanOf(left, options.points, truth).text());
    const auto ask = [&](const std::string& what, const std::vector<Track>& tracks, double tolerance) {
      return measure(what, file, tracks, truth, tolerance, options, rows);
    };
    bool right_answers = ask("elements", {{"", left, profiles(1)}}, 2 * pitch);
    right_answers &= ask("elements", {{"", left, profiles(3)}}, 2 * pitch);
    right_answers &= ask("elements", {{"left", left, profiles(3)}, {"right", right, profiles(3)}}, 2 * pitch);
    right_answers &= ask("measured points", {{"", measured(line(0)), profiles(3)}}, 0.01);
    return right_answers;
  });
}
