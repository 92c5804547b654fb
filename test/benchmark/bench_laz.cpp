// SPDX-License-Identifier: BSD-3-Clause
// How long LAZ files take to become clouds, beside the LAS files that were compressed.
#include "program.h"

#include "io/clouds/laz_encoder.h"
#include "io/clouds/laz_sample.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <cmath>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::vector<unsigned> formats = {1, 3, 6, 7}, threads = {1, 2};
  std::size_t points = 1000000;
  std::uint32_t chunk_points = 50000; ///< which LASzip takes
};

/// As a survey from the air: sweeps across rolling ground in centimetres, a fifth of the pulses through trees.
io::LasSample survey(std::uint8_t format, std::size_t points)
{
  io::LasSample sample(format < 6 ? 2 : 4, format);
  std::mt19937 random(7);
  const auto noise = [&](double width) { return width * (static_cast<double>(random()) * 0x1p-31 - 1); };
  const bool extended = format >= 6;
  const std::size_t time_at = extended ? 22 : 20, colours_at = extended ? 30 : 28;
  std::string point(sample.length(), '\0');
  double x = 0, y = 0, time = 2.5e8;
  unsigned forward = 1;
  while (sample.points.size() < points) {
    x += forward != 0 ? 35 : -35;
    if (x < 0 || x > 40000) {
      forward = 1 - forward;
      y += 60;
    }
    time += 2e-6;
    const unsigned returns = random() % 5 == 0 ? 2 + static_cast<unsigned>(random() % 3) : 1;
    const double ground = 500 * std::sin(x / 9000) + 700 * std::cos(y / 7000), tree = 1500 + noise(700);
    for (unsigned number = 1; number <= returns && sample.points.size() < points; ++number) {
      const double height = tree * (returns - number) / returns;
      io::put(point, 0, static_cast<std::int32_t>(x + noise(6)));
      io::put(point, 4, static_cast<std::int32_t>(y + noise(6)));
      io::put(point, 8, static_cast<std::int32_t>(ground + height + noise(5)));
      io::put(point, 12, static_cast<std::uint16_t>((returns == 1 ? 900 : 400) + noise(300)));
      const double angle = x / 1000 - 20;
      point[14] = static_cast<char>(extended ? number | returns << 4 : number | returns << 3 | forward << 6);
      if (extended) point[15] = static_cast<char>(forward << 6);
      point[extended ? 16 : 15] = static_cast<char>(number == returns ? 2 : 4);
      if (extended)
        io::put(point, 18, static_cast<std::int16_t>(angle / 0.006));
      else
        point[16] = static_cast<char>(angle);
      io::put(point, extended ? 20 : 18, std::uint16_t{7});
      if (format != 0 && format != 2) io::put(point, time_at, time);
      if (format == 3 || format == 7) {
        const double grey = 20000 + 5000 * std::sin(x / 3000) + noise(900);
        for (std::size_t k = 0; k < 3; ++k)
          io::put(point, colours_at + 2 * k, static_cast<std::uint16_t>(grey + noise(200)));
      }
      sample.points.push_back(point);
    }
  }
  return sample;
}

void measure(const std::string& what, const io::LasSample& sample, const Options& options, Table& table)
{
  const files::TemporaryFolder folder;
  io::laz_test::LazOptions how;
  how.chunk_points = options.chunk_points;
  const std::string las = sample.text(), laz = io::laz_test::compressed(las, how);
  const auto row = [&](const std::string& name, const std::string& bytes, unsigned threads) {
    progress(what + ", " + name + ", " + std::to_string(threads) + " threads");
    const auto file = folder.write(name, bytes);
    std::vector<double> seconds;
    for (unsigned i = 0; i < options.repeat; ++i) {
      const Stopwatch watch;
      io::readCloud(file, nullptr, {}, threads);
      seconds.push_back(watch.seconds());
    }
    const double all = median(seconds);
    table.add({what, std::to_string(sample.format), name, std::to_string(threads),
               text(static_cast<double>(bytes.size()) / 1e6), text(all * 1e7 / static_cast<double>(options.points)),
               text(static_cast<double>(bytes.size()) / all / 1e6), text(static_cast<double>(las.size()) / all / 1e6)});
  };
  for (const unsigned threads : options.threads) row("cloud.laz", laz, threads);
  row("cloud.las", las, 1);
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("Reading LAZ files as clouds: made surveys, and points that compress badly.", "bench_laz");
  app.footer("Example: bench_laz --clock cpu --repeat 5 --threads 1");
  app.add_option("--formats", options.formats, "of the points, 0 to 3, 6 or 7")->delimiter(',')->capture_default_str();
  app.add_option("--threads", options.threads, "that read")->delimiter(',')->capture_default_str();
  app.add_option("--points", options.points, "of a file")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--chunk-points", options.chunk_points, "of a chunk")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  const Table table(
      {"points", "format", "file", "threads", "MB", "[s] of 10^7 points", "MB/s of the file", "MB/s of records"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    for (const unsigned format : options.formats)
      measure("survey", survey(static_cast<std::uint8_t>(format), options.points), options, rows);
    io::LasSample noisy(4, 6);
    io::addScan(noisy, options.points, 7);
    measure("noisy", noisy, options, rows);
    return true;
  });
}
