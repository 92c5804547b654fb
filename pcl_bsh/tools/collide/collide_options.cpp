// SPDX-License-Identifier: BSD-3-Clause
#include "collide_options.h"

#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/obstacle.h>
#include <pcl_bsh/tools/cli/path.h>
#include <pcl_bsh/tools/cli/question_options.h>

#include <pcl_bsh/io/clouds/formats.h>
#include <pcl_bsh/io/clouds/point_masks.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_bsh::cli {
namespace {

constexpr auto collide_footer =
    R"(Point p of INPUT and q of OBSTACLE collide iff |p - POSE q| <= D, decided exactly, or as --accuracy says. With
--uncertainty a point collides, or is free, only if it is so wherever the points truly are; else it is undecided.
An OBSTACLE with faces (.obj .off .ply .stl) is a surface: q is any point of its triangles, and distances are exact to
them. The inside of a closed surface counts with --solid alone. Reports name its triangles, from 0; polygons are cut
into triangles.
An INPUT with faces is a surface, too: its triangles are flagged, and OUTPUT is a .ply with a property of its faces.
Reads {read}, writes all of these but {unwritten}. Files may be
pipes; - is standard input (PCD, PLY, LAS, OFF or columns), or standard output for OUTPUT (PCD) and --report.
Exit code: 0 done, colliding or not; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: which points of a hall are within 5 cm of a robot at (1.5, 2, 0), turned by 90 degrees?
  pcl_bsh_collide hall.ply robot.pcd marked.pcd --clearance 0.05 --pose 1.5,2,0,0,0,1.5708
Example: does a wagon keep 5 cm from a tunnel on its way, and where does it not?
  pcl_bsh_collide tunnel.ply wagon.ply marked.pcd --clearance 0.05 --trajectory poses.txt --clashes clashes.html
Example: the same as topics for a coordinator, with the comments that last week's topics got
  pcl_bsh_collide tunnel.ply wagon.ply marked.pcd --clearance 0.05 --trajectory poses.txt --clashes w48.bcf --previous w47.bcf
Example: the same way as a few places and headings, and the poses that these stand for
  printf 'waypoints 0.05 2\n0 0 0 0\n9 0 0 0\n12 3 0 90 arc\n' > way.txt
  pcl_bsh_collide tunnel.ply wagon.ply marked.pcd --clearance 0.05 --trajectory way.txt --poses-out poses.txt
Example: the same hall, whose scanner is off by up to 4 mm: what surely keeps 5 cm?
  pcl_bsh_collide hall.ply robot.pcd marked.pcd --clearance 0.05 --pose 1.5,2,0,0,0,1.5708 --uncertainty 0.004
Example: where would a robot stand in what no scanner of the hall ever looked into?
  pcl_bsh_collide hall.ptx robot.pcd marked.pcd --clearance 0.05 --pose 1.5,2,0,0,0,1.5708 --seen
Example: which of two machines stands too near to a hall's points or to the other, and where?
  pcl_bsh_collide hall.las marked.las --obstacle "press=press.stl;pose=2,1,0,0,0,0" --obstacle mill=mill.stl
      --between --clearance 0.05 --clashes clashes.html
Example: how far has each point of a scan moved away from an earlier scan?
  pcl_bsh_collide after.ply before.ply distances.pcd --distances --unit m --distance-page distances.html
Example: which points of a hall are within 5 cm of a machine's surface, which CAD has in millimetres?
  pcl_bsh_collide hall.las machine.stl marked.las --clearance 0.05 --input-unit m --obstacle-unit mm
Example: the same machine on its place, where the floor does not count
  pcl_bsh_collide hall.las machine.stl marked.las --clearance 0.05 --input-unit m --obstacle-unit mm
    --place 412004.5,5653210.25,98.1,30 --ignore-points "classification=2,9"
Example: what of the third scan of an E57 file is within 5 cm of a robot?
  pcl_bsh_collide hall.e57 robot.pcd marked.pcd --scan 2 --clearance 0.05)";

/// Checks that involve several options; those of the question are the core's.
void requireConsistent(const CollideOptions& options)
{
  const auto refuse = [](const char* option, const char* wrong) {
    throw UsageError(std::string(option) + ": " + wrong);
  };
  options.ClashOptions::requireConsistent();
  for (const auto& [given, option] : {std::pair{options.question.max_distance.has_value(), "--max-distance"},
                                      {options.distance_page.has_value(), "--distance-page"}}) {
    if (given && !options.distances) refuse(option, "no distances are asked for: give --distances");
  }
  if (options.distances && options.moves())
    refuse("--distances",
           "are of one pose; along a path the output has the smallest within the clearance: leave it out");
  if (options.obstacle_out && !options.question.seen && (options.moves() || !options.clashes.empty()))
    refuse("--obstacle-out", "are flags at one pose: leave out the path and --clashes, or give --seen");
  if (!options.unit.empty() && !options.distances && options.clashes.empty())
    refuse("--unit", "no report tells it: give --distances or --clashes FILE");
  options.SeveralObstacles::requireConsistent(options.question.solid, options.previous.has_value());
  if (!options.obstacles.empty() && options.obstacle_out)
    refuse("--obstacle-out", "is of one obstacle: leave it out, or give OBSTACLE alone");
  if (!options.obstacles.empty() && !options.pairs.empty())
    refuse("--pairs", "are of one obstacle: give each its pose: --obstacle \"NAME=FILE;pose=POSE\"");
  if (!options.obstacles.empty() && options.distance_page)
    refuse("--distance-page", "is of one obstacle: leave it out, or give OBSTACLE alone");
  if (!options.question.clearance && !options.distances)
    throw UsageError(std::string("command line: --clearance is required: see ") + collide_program + " --help");
}

/// Positional names and those of --obstacle: INPUT OBSTACLE OUTPUT, or INPUT OUTPUT where obstacles have names.
void setObstacles(CollideOptions& options)
{
  if (!options.areGiven()) {
    if (options.output.empty())
      throw UsageError(std::string("command line: OUTPUT is required: see ") + collide_program + " --help");
    return;
  }
  if (options.output.empty()) std::swap(options.output, options.obstacle);
  options.readObstacles(options.obstacle, options.warnings);
  options.obstacle.clear();
}

} // namespace

std::optional<CollideOptions> parseCollideOptions(int argc, char** argv)
{
  CollideOptions options;
  Question& question = options.question;
  question.threads = 0;
  bool in_place = false;
  PoseOptions pose;
  PathOptions path;
  CLI::App app("Flags, keeps or removes the points of a cloud that collide with an obstacle.", collide_program);
  app.footer(io::withFormats(collide_footer));
  app.add_option("INPUT", options.input, "the cloud whose points are tested")->type_name("")->required();
  app.add_option("OBSTACLE", options.obstacle, "cloud or mesh to collide with")->type_name("")->required();
  app.add_option("OUTPUT", options.output, "INPUT's points with all their fields")->type_name("");
  options.SeveralObstacles::addTo(app);
  addQuestionOptions(app, question, {"clearance"});
  pose.addTo(app);
  path.addTo(app);
  app.add_option("--poses-out", options.poses_out, "file for the poses that are asked about, as --trajectory reads it")
      ->type_name("FILE");
  app.add_option("--keep", options.keep,
                 "flagged: all points, with a field 'collision': 1 collides, 0 is free,\n"
                 "2 and 3 are undecided (default)\n"
                 "colliding: only these, and those that are undecided\n"
                 "free: only finite points that do not collide")
      ->type_name("WHICH")
      ->transform(choice<Keep>({{"flagged", Keep::flagged}, {"colliding", Keep::colliding}, {"free", Keep::free}}));
  app.add_flag("--distances", options.distances,
               "each point's distance to the nearest point of OBSTACLE: a field\n"
               "'distance'; statistics of both directions in --report");
  addQuestionOptions(app, question, QuestionKind::any, {"clearance", "swept"});
  app.add_option("--distance-page", options.distance_page,
                 "page for browsers: statistics, histograms, the farthest places")
      ->type_name("FILE.html");
  app.add_option("--obstacle-out", options.obstacle_out,
                 "OBSTACLE's points with all their fields, and a field 'collision': 1\n"
                 "collides, 0 is free, 2 is undecided, 4 is unseen; of a mesh its\n"
                 "triangles, as .ply; with a path or --clashes only with --seen")
      ->type_name("FILE");
  ReadOptions reading;
  reading.addTo(app);
  reading.addUnitsTo(app);
  reading.addSystemsTo(app, true);
  app.add_flag("--in-place", in_place, "OUTPUT may be INPUT, which it then replaces");
  app.add_option("--report", options.report, "JSON file for the results and what they cost")->type_name("FILE");
  options.ClashOptions::addTo(app, "reports of distances and clashes");
  if (!understood(app, collide_program, argc, argv)) return std::nullopt;

  setObstacles(options);
  std::vector<std::filesystem::path> clouds = {options.input};
  if (options.obstacles.empty()) clouds.push_back(options.obstacle);
  for (const ObstacleChoice& one : options.obstacles)
    if (one.part == 0) clouds.push_back(one.file);
  options.reading = reading.read(clouds);
  path.requireConsistent(pose.given() ? pose.option() : "");
  if (const auto given = pose.read(options.warnings)) question.pose = *given;
  options.pairs = pose.pairs;
  options.trajectory = path.file;
  if (path.isStraight()) question.path = path.straightRun(options.warnings);
  options.names_of_poses = path.isStraight() ? std::vector<std::string>{"--from", "--to"}
                                             : std::vector<std::string>{pose.given() ? pose.option() : "--trajectory"};
  question.swept = path.swept.value_or(0.0);
  requireConsistent(options);
  question.wanted.flags = question.wanted.closest = true;
  question.wanted.obstacle_flags = options.obstacle_out && !question.seen; // --seen brings them itself
  question.wanted.contacts = options.tellsContacts() || !options.clashes.empty();
  question.wanted.poses = question.wanted.contacts && (!path.swept || options.report); // swept, it takes longer
  question.wanted.distances = options.distances;
  question.wanted.overlap = options.overlap;
  question.wanted.both_ways = options.distances && options.obstacles.empty();

  CommandFiles& files = options.files;
  files.reads("INPUT", options.input).reads("OBSTACLE", options.obstacle).readsPose("--pose", pose.pose);
  files.reads("--pairs", pose.pairs).writes("--poses-out", options.poses_out);
  for (const ObstacleChoice& one : options.obstacles)
    if (one.part == 0) files.reads("--obstacle", one.file).readsPose("--obstacle", one.pose_text);
  files.reads("--trajectory", path.file).readsPose("--from", path.from).readsPose("--to", path.to);
  for (const auto& [option, ignored] : {std::pair{"--ignore-points", &question.ignore_points},
                                        {"--obstacle-ignore-points", &question.obstacle_ignore_points}}) {
    for (const std::filesystem::path& mask : io::maskFilesOf(*ignored)) files.reads(option, mask);
    io::readMasks(*ignored);
  }
  files.writes("OUTPUT", options.output, in_place ? "INPUT" : "");
  files.writes("--report", options.report.value_or("")).writes("--distance-page", options.distance_page.value_or(""));
  files.writes("--obstacle-out", options.obstacle_out.value_or(""));
  options.ClashOptions::addTo(files);
  return options;
}

} // namespace pcl_bsh::cli
