// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_collide.
#pragma once

#include "pose.h"
#include "program.h"

#include <pcl_bsh/filters/io/field_type.h>
#include <pcl_bsh/query/collide.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

namespace pcl_bsh::cli {

inline constexpr auto collide_program = "pcl_bsh_collide";

enum class Keep { flagged, colliding, free };

struct CollideOptions {
  std::filesystem::path input;
  std::filesystem::path obstacle;
  std::filesystem::path output;
  std::optional<std::filesystem::path> report;
  Keep keep = Keep::flagged;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_input_obstacle
  CollisionRequest request;
};

inline constexpr auto collide_footer =
    R"(Point p of INPUT and q of OBSTACLE collide iff |p - POSE q| <= D, decided exactly.
Reads .pcd .ply .obj .off .xyz .txt, writes .pcd and .ply.
Exit code: 0 done, colliding or not; 1 failed; 2 command line not understood.

Example: which points of a hall are within 5 cm of a robot at (1.5, 2, 0), turned by 90 degrees?
  pcl_bsh_collide hall.ply robot.pcd marked.pcd --clearance 0.05 --pose 1.5,2,0,0,0,1.5708)";

template <typename Number>
Number parseOption(const std::string& option, const std::string& text, const char* remedy)
{
  try {
    return io::parseNumber<Number>(text);
  }
  catch (const io::FormatError& error) {
    throw UsageError(option + ": " + error.what() + ": " + remedy);
  }
}

inline Keep parseKeep(const std::string& text)
{
  if (text == "flagged") return Keep::flagged;
  if (text == "colliding") return Keep::colliding;
  if (text == "free") return Keep::free;
  throw UsageError("--keep: '" + text + "' is unknown: give flagged, colliding or free");
}

/// The options, checked one by one; none when only help was asked for.
inline std::optional<CollideOptions> parseCollideOptions(int argc, char** argv)
{
  std::string input, obstacle, output, clearance, pose, report, keep = "flagged", threads = "0";
  CLI::App app("Flags, keeps or removes the points of a cloud that collide with an obstacle.", collide_program);
  app.footer(collide_footer);
  app.add_option("INPUT", input, "cloud whose points are asked about")->type_name("")->required();
  app.add_option("OBSTACLE", obstacle, "cloud to collide with")->type_name("")->required();
  app.add_option("OUTPUT", output, "INPUT's points with all their fields; may be INPUT itself")
      ->type_name("")
      ->required();
  app.add_option("--clearance", clearance, "greatest distance that counts as collision, in the clouds' unit")
      ->type_name("D")
      ->required();
  app.add_option("--pose", pose,
                 "of OBSTACLE in INPUT's frame: x,y,z,roll,pitch,yaw, the angles in\n"
                 "radians (R = Rz(yaw) Ry(pitch) Rx(roll)); or a file of 12 or 16\n"
                 "numbers, the rows of its matrix (default: no motion)")
      ->type_name("POSE");
  app.add_option("--keep", keep,
                 "flagged: all points, with a field 'collision' of 0 or 1 (default)\n"
                 "colliding: only these\n"
                 "free: only finite points that do not collide")
      ->type_name("WHICH");
  app.add_option("--threads", threads, "0: all of the machine's (default); any number gives the same result")
      ->type_name("N");
  app.add_option("--report", report, "JSON file for what was found and what it cost")->type_name("FILE");
  try {
    app.parse(argc, argv);
  }
  catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return std::nullopt;
  }
  catch (const CLI::ParseError& error) {
    throw UsageError(std::string("command line: ") + error.what() + ": see " + collide_program + " --help");
  }

  CollideOptions options;
  options.input = input;
  options.obstacle = obstacle;
  options.output = output;
  if (!report.empty()) options.report = report;
  options.keep = parseKeep(keep);
  options.request.clearance = parseOption<double>("--clearance", clearance, "give a length in the clouds' unit");
  options.request.threads = parseOption<unsigned>("--threads", threads, "give a number of threads, 0 for all");
  if (!pose.empty()) options.pose = parsePose(pose);
  return options;
}

} // namespace pcl_bsh::cli
