// SPDX-License-Identifier: BSD-3-Clause
// Makes something to try pcl_bsh_self_filter on: a robot, its joints' values, and what its camera sees.
#include "made_robot.h"
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/io/text/number_text.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;

constexpr auto program = "pcl_bsh_made_robot";
constexpr auto footer =
    R"(Writes robot.urdf, meshes/*.stl, states.csv (a line for each frame) and frame_000.pcd ... into FOLDER, each with 640 x 480
points in the frame of the robot's link `camera`; lengths are in metres.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: a robot that reaches over a table
  pcl_bsh_made_robot robot --frames 3)";

pcl::PCLPointCloud2 cloudOf(const self_filter::DepthImage& image)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) io::addField(cloud, axis, pcl::PCLPointField::FLOAT32);
  io::allocate(cloud, static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height));
  std::memcpy(cloud.data.data(), image.xyz.data(), cloud.data.size());
  io::setDense(cloud);
  return cloud;
}

int makeRobot(const fs::path& folder, std::size_t frames)
{
  const files::OutputFolder made(folder);
  cli::Step step("Making robot and frames");
  self_filter::writeMadeRobot(folder);
  const self_filter::Robot robot = io::readRobot(folder / "robot.urdf");
  std::string names, lines;
  for (std::size_t i = 0; i < frames; ++i) {
    const self_filter::JointValues values = self_filter::madeJointValues(i, frames);
    char name[32];
    std::snprintf(name, sizeof name, "frame_%03zu.pcd", i);
    io::writeCloud(folder / name, cloudOf(self_filter::seenBy(robot, values)));
    names.clear();
    for (const auto& [joint, value] : values) {
      names += (names.empty() ? "" : ",") + joint;
      lines += (lines.empty() || lines.back() == '\n' ? "" : ",") + io::numberText(value);
    }
    lines += '\n';
    step.share(static_cast<double>(i + 1) / static_cast<double>(frames));
  }
  files::replaceFile(folder / "states.csv", [&](std::ostream& out) { out << names << '\n' << lines; });
  step.done(std::to_string(frames) + " frames");
  std::cout << "wrote a robot of " << counted(robot.links.size(), "link") << " and " << counted(frames, "frame")
            << " to " << folder.string() << '\n';
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, [&] {
    std::string folder;
    unsigned frames = 3;
    CLI::App app("Makes a robot, its joints' values and what its depth camera sees.", program);
    app.footer(footer);
    app.add_option("FOLDER", folder, "where the files go; made if it is not there")->type_name("")->required();
    app.add_option("--frames", frames, "how many")
        ->type_name("N")
        ->transform(
            cli::number<unsigned>("give a number from 1 to 1000", [](unsigned n) { return n > 0 && n <= 1000; }))
        ->capture_default_str();
    if (!cli::understood(app, program, argc, argv)) return 0;
    return makeRobot(folder, frames);
  });
}
