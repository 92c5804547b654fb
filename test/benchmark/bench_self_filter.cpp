// SPDX-License-Identifier: BSD-3-Clause
// Workload R: a robot of ten links is cut out of what its depth camera sees, frame after frame.
#include "harness.h"
#include "program.h"
#include <examples/robot/made_robot.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/tools/self_filter/self_filter.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

using namespace pcl_bsh;
using namespace pcl_bsh::bench;

namespace {

struct Options : ProgramOptions {
  std::size_t width = 640;
  std::size_t frames = 20;
};

struct Frame {
  self_filter::JointValues values;
  self_filter::DepthImage image;
};

void measure(const self_filter::Robot& robot, const std::vector<Frame>& frames, double padding, const Options& options,
             Table& table)
{
  progress("padding " + text(padding) + " m");
  const std::size_t camera = robot.linkNamed("camera");
  const Stopwatch covering;
  self_filter::SelfFilter filter(robot, {padding, 1});
  const double covered = covering.seconds();
  std::vector<double> times;
  double points = 0, cut = 0, seen = 0;
  for (unsigned run = 0; run < options.repeat; ++run)
    for (const Frame& frame : frames) {
      const PointsView view = viewOf(frame.image.xyz.data(), frame.image.is_robot.size());
      const Stopwatch watch;
      const std::vector<Verdict>& flags =
          filter.flags(view, linkPoses(robot, frame.values)[camera].inverse(), frame.values);
      times.push_back(1e3 * watch.seconds());
      points += static_cast<double>(flags.size());
      cut += static_cast<double>(std::count(flags.begin(), flags.end(), Verdict::colliding));
      seen += static_cast<double>(std::count(frame.image.is_robot.begin(), frame.image.is_robot.end(), 1));
    }
  table.add({text(padding), std::to_string(filter.triangles()), text(covered), text(100 * seen / points),
             text(100 * cut / points), text(median(times)), text(*std::max_element(times.begin(), times.end()))});
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app(
      "A robot of ten links cut out of depth images: joints to poses, a hierarchy of the image, flags. One thread.",
      "bench_self_filter");
  app.footer("Example: bench_self_filter --clock cpu --csv self_filter.csv");
  app.add_option("--width", options.width, "pixels of an image; its height is three quarters of it")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app.add_option("--frames", options.frames, "images")->check(CLI::PositiveNumber)->capture_default_str();
  Table table({"padding [m]", "triangles", "load and build [s]", "robot [%]", "cut [%]", "frame [ms]", "slowest [ms]"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("bench_self_filter_" + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    self_filter::writeMadeRobot(folder);
    const self_filter::Robot robot = io::readRobot(folder / "robot.urdf");
    progress("making " + std::to_string(options.frames) + " images");
    std::vector<Frame> frames;
    for (std::size_t i = 0; i < options.frames; ++i) {
      const self_filter::JointValues values = self_filter::madeJointValues(i, options.frames);
      frames.push_back({values, self_filter::seenBy(robot, values, options.width)});
    }
    for (const double padding : {0.02, 0.05}) measure(robot, frames, padding, options, rows);
    std::filesystem::remove_all(folder);
    return true;
  });
}
