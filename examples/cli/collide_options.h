// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_collide.
#pragma once

#include "command_line.h"
#include "path.h"
#include "used_files.h"

#include <pcl_bsh/collision/collide.h>
#include <pcl_bsh/filters/cloud_files/field_type.h>
#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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
  std::filesystem::path trajectory;                       ///< a file of such poses, or empty
  std::vector<Eigen::Isometry3d> path;                    ///< a straight run of them, or empty
  std::optional<double> swept;
  std::vector<std::filesystem::path> clashes; ///< files for the clash report, .json .csv .html
  double cluster_distance = 0;                ///< 0: from clearance and spacing
  std::optional<std::filesystem::path> previous;
  double clearance = 0.0;
  unsigned threads = 1;
  Accuracy accuracy;
  std::vector<std::string> warnings; ///< of the options themselves

  bool moves() const { return !trajectory.empty() || !path.empty(); }

  CommandFiles files; ///< all that are read or written
};

inline constexpr auto collide_footer =
    R"(Point p of INPUT and q of OBSTACLE collide iff |p - POSE q| <= D, decided exactly, or as --accuracy says.
Reads .pcd .ply .obj .off .xyz .txt, writes all of these but .off. Files may be pipes; - is standard input (PCD, PLY,
OFF or columns), as OUTPUT standard output (PCD), as --report, too.
Exit code: 0 done, colliding or not; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: which points of a hall are within 5 cm of a robot at (1.5, 2, 0), turned by 90 degrees?
  pcl_bsh_collide hall.ply robot.pcd marked.pcd --clearance 0.05 --pose 1.5,2,0,0,0,1.5708
Example: does a wagon keep 5 cm from a tunnel on its way, and where does it not?
  pcl_bsh_collide tunnel.ply wagon.ply marked.pcd --clearance 0.05 --trajectory poses.txt --clashes clashes.html)";

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

inline Accuracy parseAccuracy(const std::string& text)
{
  try {
    return Accuracy::parse(text);
  }
  catch (const InvalidInput& error) {
    throw UsageError("--accuracy: " + error.advice());
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
  std::string input, obstacle, output, clearance, pose, report, cluster_distance, previous;
  std::string keep = "flagged", threads = "0", accuracy = "exact";
  std::vector<std::string> clashes;
  bool in_place = false;
  PathOptions path;
  CLI::App app("Flags, keeps or removes the points of a cloud that collide with an obstacle.", collide_program);
  app.footer(collide_footer);
  app.add_option("INPUT", input, "cloud whose points are asked about")->type_name("")->required();
  app.add_option("OBSTACLE", obstacle, "cloud to collide with")->type_name("")->required();
  app.add_option("OUTPUT", output, "INPUT's points with all their fields")->type_name("")->required();
  app.add_option("--clearance", clearance, "greatest distance that counts as collision, in the clouds' unit")
      ->type_name("D")
      ->required();
  app.add_option("--pose", pose,
                 "of OBSTACLE in INPUT's frame: x,y,z,roll,pitch,yaw, the angles in\n"
                 "radians (R = Rz(yaw) Ry(pitch) Rx(roll)); or a file of 12 or 16\n"
                 "numbers, the rows of its matrix (default: no motion)")
      ->type_name("POSE");
  path.addTo(app);
  app.add_option("--keep", keep,
                 "flagged: all points, with a field 'collision' of 0 or 1 (default)\n"
                 "colliding: only these, and those that are undecided\n"
                 "free: only finite points that do not collide")
      ->type_name("WHICH");
  app.add_option("--accuracy", accuracy,
                 "what may be given up for time: exact (default); float: without proof;\n"
                 "tolerance=LENGTH: pairs up to that much beyond D may count; level=N:\n"
                 "spheres are opened so deep; pairs=N or time=SECONDS: each query stops\n"
                 "there. What is then not known is undecided: 2 in the field 'collision';\n"
                 "along a path, level, pairs and time tell no distances and no poses")
      ->type_name("HOW");
  app.add_flag("--in-place", in_place, "OUTPUT may be INPUT, which it then replaces");
  app.add_option("--threads", threads, "0: all of the machine's (default); any number gives the same result")
      ->type_name("N");
  app.add_option("--report", report, "JSON file for what was found and what it cost")->type_name("FILE");
  app.add_option("--clashes", clashes,
                 "list of the places that collide, to .json, .csv or .html; may be given\n"
                 "more than once")
      ->type_name("FILE")
      ->allow_extra_args(false);
  app.add_option("--cluster-distance", cluster_distance,
                 "colliding points no farther apart belong to one clash (default: the\n"
                 "greater of D and four spacings of INPUT, rounded up to a power of two)")
      ->type_name("L");
  app.add_option("--previous", previous, "earlier .json list: clashes are new, persisting or resolved")
      ->type_name("FILE");
  if (!understood(app, collide_program, argc, argv)) return std::nullopt;

  CollideOptions options;
  options.input = input;
  options.obstacle = obstacle;
  options.output = output;
  if (!report.empty()) options.report = report;
  options.keep = parseKeep(keep);
  options.clearance = parseOption<double>("--clearance", clearance, "give a length in the clouds' unit");
  options.threads = parseOption<unsigned>("--threads", threads, "give a number of threads, 0 for all");
  options.accuracy = parseAccuracy(accuracy);
  path.requireSense(pose);
  if (!pose.empty()) options.pose = parsePose("--pose", pose, options.warnings);
  options.trajectory = path.file;
  if (path.isStraight()) {
    const auto steps = parseOption<std::uint32_t>("--steps", path.steps, "give a number of steps");
    if (steps == 0 || steps > 10'000'000) throw UsageError("--steps: " + path.steps + ": give 1 to 10000000");
    const Eigen::Isometry3d from = parsePose("--from", path.from, options.warnings);
    options.path = straightRun(from, parsePose("--to", path.to, options.warnings), steps);
  }
  if (!path.swept.empty()) options.swept = parseOption<double>("--swept", path.swept, "give a length > 0");
  options.clashes.assign(clashes.begin(), clashes.end());
  if (clashes.empty() && !(cluster_distance.empty() && previous.empty())) {
    throw UsageError(std::string(previous.empty() ? "--cluster-distance" : "--previous") +
                     ": no clash report is written: give --clashes FILE");
  }
  if (!cluster_distance.empty()) {
    options.cluster_distance = parseOption<double>("--cluster-distance", cluster_distance, "give a length > 0");
    if (!(options.cluster_distance > 0 && std::isfinite(options.cluster_distance))) {
      throw UsageError("--cluster-distance: " + cluster_distance + ": give a finite length > 0");
    }
  }
  if (!previous.empty()) options.previous = previous;
  options.files.reads("INPUT", input).reads("OBSTACLE", obstacle).readsPose("--pose", pose);
  options.files.reads("--trajectory", path.file).readsPose("--from", path.from).readsPose("--to", path.to);
  options.files.reads("--previous", previous).writes("OUTPUT", output, in_place ? "INPUT" : "");
  options.files.writes("--report", report);
  for (const std::string& list : clashes) options.files.writes("--clashes", list, "--previous"); // brought up to date
  if (options.accuracy.stopsEarly() && !clashes.empty())
    throw UsageError("--accuracy: " + accuracy + ": clashes need distances: give exact, float or tolerance=LENGTH");
  if (!options.accuracy.isExact() && options.swept)
    throw UsageError("--accuracy: " + accuracy + ": swept motion has a tolerance of its own: give exact");
  return options;
}

} // namespace pcl_bsh::cli
