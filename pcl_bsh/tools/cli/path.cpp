// SPDX-License-Identifier: BSD-3-Clause
#include "path.h"

#include "command_line.h"

#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/io/poses/waypoints.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_bsh::cli {

Eigen::Isometry3d parsePose(const std::string& option, const std::string& text, std::vector<std::string>& warnings)
{
  if (std::filesystem::exists(text)) {
    const io::RigidPose rigid = io::nearestRigid(io::readPose(text));
    if (rigid.deviation > 0)
      warnings.push_back(option + ": " + text + ": " + io::nearestRotationWarning(rigid.deviation));
    return rigid.pose;
  }
  try {
    const std::vector<double> n = io::numbersOf(text);
    if (const auto warning = io::warningOfAngles(n)) warnings.push_back(option + ": " + *warning);
    if (n.size() == 6) return io::poseFrom(n);
  }
  catch (const io::FormatError&) {
    // Not numbers, and no file either.
  }
  throw UsageError(option + ": '" + text +
                   "' is neither six numbers nor a file: give x,y,z,roll,pitch,yaw or a file name");
}

void PoseOptions::addTo(CLI::App& app)
{
  app.add_option("--pose", pose,
                 "of OBSTACLE in INPUT's frame: x,y,z,roll,pitch,yaw, the angles in\n"
                 "radians (R = Rz(yaw) Ry(pitch) Rx(roll)); or a file of 12 or 16\n"
                 "numbers, the rows of its matrix (default: no motion)")
      ->type_name("POSE");
  app.add_option("--place", place,
                 "instead: where OBSTACLE's origin stands, and its turn about z in\n"
                 "degrees, counter-clockwise from above: from x towards y")
      ->type_name("X,Y,Z,HEADING");
  app.add_option("--pairs", pairs,
                 "instead: three or more pairs of places, one a line: x y z in\n"
                 "OBSTACLE's file, in its unit, and x y z in INPUT; the pose of least\n"
                 "squares is taken, and its residuals are told")
      ->type_name("FILE");
}

std::optional<Eigen::Isometry3d> PoseOptions::read(std::vector<std::string>& warnings) const
{
  if ((!pose.empty()) + (!place.empty()) + (!pairs.empty()) > 1)
    throw UsageError((place.empty() ? "--pairs" : "--place") +
                     std::string(": another pose is given, too: give one of --pose, --place and --pairs"));
  if (!pose.empty()) return parsePose("--pose", pose, warnings);
  if (place.empty()) return std::nullopt;
  try {
    const std::vector<double> n = io::numbersOf(place);
    const bool finite = std::all_of(n.begin(), n.end(), [](double number) { return std::isfinite(number); });
    if (n.size() == 4 && finite) return io::placeAt({n[0], n[1], n[2]}, n[3]);
  }
  catch (const io::FormatError&) {
    // No numbers.
  }
  throw UsageError("--place: '" + place + "' is not four finite numbers: give x,y,z,heading, the heading in degrees");
}

void PathOptions::addTo(CLI::App& app)
{
  app.add_option("--trajectory", file,
                 "poses of OBSTACLE, one a line: 12 or 16 numbers of a matrix, row by\n"
                 "row, or time tx ty tz qx qy qz qw; or, after a line 'waypoints LENGTH\n"
                 "DEGREES' of the largest step, places and headings: x y z heading, and\n"
                 "'turn' (in place, before it goes there) or 'arc'; instead of --pose.\n"
                 "OUTPUT gets the fields distance, first_pose and closest_pose beside\ncollision")
      ->type_name("FILE");
  app.add_option("--from", from, "a straight run instead: its first pose, as for --pose")->type_name("POSE");
  app.add_option("--to", to, "its last pose")->type_name("POSE");
  app.add_option("--steps", steps, "number of steps from the first to the last")
      ->type_name("N")
      ->transform(number<unsigned>("give 1 to 10000000", [](unsigned n) { return n >= 1 && n <= 10'000'000; }));
  app.add_option("--swept", swept,
                 "the motion between poses counts too: points within D of it collide,\n"
                 "points beyond D + TOL do not; TOL > 0, in the clouds' unit")
      ->type_name("TOL")
      ->transform(number<double>("give a finite length > 0", [](double d) { return d > 0 && std::isfinite(d); }));
}

void PathOptions::requireConsistent(const std::string& pose) const
{
  const bool moves = !file.empty() || isStraight();
  if (!file.empty() && isStraight()) throw UsageError("--from: --trajectory is given too: give one of them");
  if (!pose.empty() && moves) throw UsageError(pose + ": a path is given too: give one of them");
  if (isStraight() && (from.empty() || to.empty() || !steps))
    throw UsageError("--from: a straight run is not complete: give --from, --to and --steps");
  if (swept && !moves) throw UsageError("--swept: nothing moves: give --trajectory, or --from, --to, --steps");
}

std::vector<Eigen::Isometry3d> PathOptions::straightRun(std::vector<std::string>& warnings) const
{
  const Eigen::Isometry3d first = parsePose("--from", from, warnings), last = parsePose("--to", to, warnings);
  std::vector<Eigen::Isometry3d> poses = {first};
  try {
    for (unsigned i = 1; i < *steps; ++i)
      poses.push_back(poseBetween(first, last, static_cast<double>(i) / static_cast<double>(*steps)));
  }
  catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--to: ") + error.what());
  }
  poses.push_back(last);
  return poses;
}

} // namespace pcl_bsh::cli
