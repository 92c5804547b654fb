// SPDX-License-Identifier: BSD-3-Clause
// Workload M: how far a robot may go on, by each frame of its depth camera. The robot is cut out, the rest gets an
// index, and the motion of the next half second is certified. One thread.
#include "harness.h"
#include "program.h"
#include <examples/robot/made_robot.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/tools/self_filter/separation_monitor.h>

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
  std::size_t frames = 60;
};

struct Frame {
  Eigen::Isometry3d T_world_camera;
  robots::RobotState now, next;
  self_filter::DepthImage image;
};

/// A turn of the made robot's joints lasts 12 s; a motion is half a second of it, or three times as fast.
std::vector<Frame> madeFrames(const self_filter::Robot& robot, const Options& options)
{
  constexpr std::size_t kSteps = 24; // half a second each
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < options.frames; ++i) {
    const std::size_t all = kSteps * options.frames, at = kSteps * i;
    const self_filter::JointValues values = self_filter::madeJointValues(at, all);
    frames.push_back({linkPoses(robot, values)[robot.linkNamed("camera")], stateOf(robot, values),
                      stateOf(robot, self_filter::madeJointValues(at + all / kSteps, all)),
                      self_filter::seenBy(robot, values, options.width)});
  }
  return frames;
}

void measure(const self_filter::Robot& robot, std::vector<Frame> frames, double speed, const Options& options,
             Table& table)
{
  progress("speed " + text(speed));
  for (Frame& frame : frames)
    for (std::size_t i = 0; i < frame.now.size(); ++i) {
      const robots::Joint& joint = *robot.links[variablesOf(robot)[i]].joint;
      frame.next[i] = frame.now[i] + speed * (frame.next[i] - frame.now[i]);
      if (joint.kind != robots::Joint::Kind::continuous)
        frame.next[i] = std::clamp(frame.next[i], joint.lower, joint.upper);
    }
  robots::WorldOptions world;
  world.clearance = 0.05;
  world.with_self = false;
  self_filter::SeparationMonitor monitor(robot, {0.02, 1, {{"base", 0.06}, {"mast", 0.06}}}, world);
  std::vector<double> times, near, last_valid;
  std::size_t self = 0, free = 0;
  for (unsigned run = 0; run < options.repeat; ++run)
    for (const Frame& frame : frames) {
      const PointsView view = viewOf(frame.image.xyz.data(), frame.image.is_robot.size());
      const Stopwatch watch;
      const self_filter::SeparationCheck check = monitor.check(view, frame.T_world_camera, frame.now, frame.next);
      times.push_back(1e3 * watch.seconds());
      near.push_back(static_cast<double>(check.near));
      self = std::max(self, check.self);
      free += check.motion.verdict == Verdict::free ? 1 : 0;
      last_valid.push_back(check.motion.last_valid);
    }
  table.add({text(speed), std::to_string(frames.front().image.is_robot.size()), text(median(near)),
             std::to_string(self), text(100.0 * static_cast<double>(free) / static_cast<double>(times.size())),
             text(median(last_valid)), text(median(times)), text(quantile(times, 0.99)),
             text(*std::max_element(times.begin(), times.end()))});
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("How far a robot may go on, by each image of its depth camera. One thread.", "bench_separation");
  app.footer("Example: bench_separation --clock cpu --csv separation.csv");
  app.add_option("--width", options.width, "pixels of an image; its height is three quarters of it")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app.add_option("--frames", options.frames, "images")->check(CLI::PositiveNumber)->capture_default_str();
  Table table({"speed", "points", "near [median]", "robot [most]", "free [%]", "last valid [median]", "frame [ms]",
               "99 % [ms]", "slowest [ms]"});
  return runProgram(app, argc, argv, options, table, [&](Table& rows) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("bench_separation_" + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    self_filter::writeMadeRobot(folder);
    const self_filter::Robot robot = io::readRobot(folder / "robot.urdf");
    progress("making " + std::to_string(options.frames) + " images");
    const std::vector<Frame> frames = madeFrames(robot, options);
    for (const double speed : {1.0, 3.0}) measure(robot, frames, speed, options, rows);
    std::filesystem::remove_all(folder);
    return true;
  });
}
