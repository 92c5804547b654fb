// SPDX-License-Identifier: BSD-3-Clause
// A robot and values of its joints, as command lines name them. For programs that link pcl_bsh_robots.
#pragma once

#include "program.h"

#include <pcl_bsh/io/robots/joint_values.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/io/robots/ros_packages.h>
#include <pcl_bsh/io/text/format_error.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

struct RobotOptions {
  std::filesystem::path urdf, states;
  std::string joints;
  std::vector<std::string> packages;

  /// --joints and --states. @param joints_doc help of --joints. @param line what a line of the table is for: "cloud"
  void addJointsTo(CLI::App& app, const std::string& joints_doc, const std::string& line)
  {
    auto* const option = app.add_option("--joints", joints, joints_doc)->type_name("NAME=VALUE,...");
    app.add_option("--states", states, "file of such values: names in its first line, then a line for each " + line)
        ->type_name("FILE")
        ->excludes(option);
  }

  void addPackagesTo(CLI::App& app)
  {
    app.add_option("--package", packages,
                   "folder that package://NAME/ stands for; may be given several times;\nothers are looked for in "
                   "ROS_PACKAGE_PATH")
        ->type_name("NAME=DIR")
        ->expected(1)
        ->take_all();
  }

  /// @throws UsageError for a package without a name; as io::readRobot() does
  robots::Robot read() const
  {
    std::map<std::string, std::filesystem::path> folders;
    for (const std::string& value : packages) {
      const std::size_t equals = value.find('=');
      if (equals == 0 || equals == std::string::npos)
        throw UsageError("--package: '" + value + "' is no package with a folder: give NAME=FOLDER");
      folders[value.substr(0, equals)] = value.substr(equals + 1);
    }
    return io::readRobot(urdf, folders, io::packagePath());
  }

  /// The lines of --states, or --joints alone. @throws UsageError; as io::readJointStates() does
  std::vector<robots::JointValues> values() const
  {
    try {
      return states.empty() ? std::vector{io::parseJointValues(joints)} : io::readJointStates(states);
    }
    catch (const io::FormatError& error) {
      throw UsageError(std::string("--joints: ") + error.what() + ": " + error.remedy());
    }
  }
};

} // namespace pcl_bsh::cli
