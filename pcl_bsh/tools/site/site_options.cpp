// SPDX-License-Identifier: BSD-3-Clause
#include "site_options.h"

#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/path.h>
#include <pcl_bsh/tools/cli/question_options.h>

#include <pcl_bsh/io/clouds/formats.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/site/site.h>
#ifdef PCL_BSH_SITE_QUERIES
#include <pcl_bsh/site/site_obstacles.h>
#endif

#include <algorithm>
#include <cmath>
#include <string>

namespace pcl_bsh::cli {
namespace {

constexpr auto site_footer =
    R"(A site is a folder of tiles, each a binary PCD file with all fields of the points and two more, source and record:
which record of which cloud a point was. Reads {read}; .las, .laz, .e57 and
binary .pcd of any size, the others where they fit into half of the memory given.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: two scans become one site, and a file with the points of both
  pcl_bsh_site make north.las south.las --out valley --memory 2G
  pcl_bsh_site validate valley
  pcl_bsh_site export valley all.pcd
A site holds points: `make` takes files with faces by --vertices-only alone, and `collide` takes OBSTACLE's faces as a
surface, as pcl_bsh_collide does.
With --out: the fields of `collide` are collision (1 collides, 0 free), with --trajectory also distance (NaN: free),
first_pose and closest_pose (-1: none), with --distances distance alone.
Example: where does a machine come within 5 cm of it on its way? On one process, or on four:
  pcl_bsh_site collide valley machine.pcd --clearance 0.05 --trajectory poses.txt --report way.json
  mpirun -n 4 pcl_bsh_site collide valley machine.pcd --clearance 0.05 --trajectory poses.txt --report way.json
Example: the same as a page, place by place
  pcl_bsh_site collide valley machine.pcd --clearance 0.05 --trajectory poses.txt --clashes clashes.html
Example: which of two machines comes too near to the site or to the other
  pcl_bsh_site collide valley --obstacle "press=press.stl;pose=2,1,0,0,0,0" --obstacle mill=mill.stl --between
    --clearance 0.05 --clashes clashes.html
Example: what of the machine lies where neither of two scanners saw that nothing is there
  pcl_bsh_site collide valley machine.pcd --clearance 0.05 --trajectory poses.txt --report way.json
    --seen --seen-angle 0.002 --origin "source:0=12,3,1.7;1=40,8,1.7"
Example: what of two epochs has no point of the other within 10 cm
  pcl_bsh_site collide now before --clearance 0.1 --out now_marked --obstacle-out before_marked)";

void addMemory(CLI::App& app, SiteOptions& options)
{
  app.add_option("--memory", options.memory, "memory to work in, as 512M or 2G (default: 2G)")
      ->type_name("BYTES")
      ->transform(amount(1024, std::uint64_t{64} << 20, "give 64M or more"));
}

/// Refuses an output in a site's folder, where it might take a tile's place. @throws UsageError
void requireOutside(const std::filesystem::path& site, const std::string& name, const std::string& option,
                    const std::filesystem::path& file)
{
  namespace fs = std::filesystem;
  if (file.empty()) return;
  std::error_code error;
  const fs::path home = fs::weakly_canonical(site, error), target = fs::weakly_canonical(fs::absolute(file), error);
  const auto [home_end, unused] = std::mismatch(home.begin(), home.end(), target.begin(), target.end());
  if (!error && home_end == home.end())
    throw UsageError(option + ": " + file.string() + ": lies in the folder of " + name + ": choose another place");
}

void requireExport(const SiteOptions& options)
{
  requireOutside(options.site, "SITE", "OUT", options.out);
  const std::string extension = io::inSmallLetters(options.out.extension().string());
  if (extension != ".pcd" && io::cloudFormat(extension))
    throw UsageError("OUT: " + options.out.string() + ": sites are not written as " + extension +
                     ": name a .pcd file, a .pvtp, or a folder");
}

#ifdef PCL_BSH_SITE_QUERIES
/// The options of `collide` as typed.
struct CollideTexts {
  bool any = false, closest = false, distances = false;
  std::string pose;

  void addTo(CLI::App& app, SiteOptions& options)
  {
    app.add_option("OBSTACLE", options.obstacle,
                   "cloud or mesh to collide with, which must fit into memory; or another site of any size")
        ->type_name("");
    options.SeveralObstacles::addTo(app);
    app.add_option("--report", options.report, "JSON file for the answer; -: standard output")->type_name("FILE");
    app.add_option("--out", options.out, "new site with what was found of each point, as fields more of the same tiles")
        ->type_name("SITE");
    app.add_option("--pose", pose, "of OBSTACLE in SITE's frame: x,y,z,roll,pitch,yaw or a file")->type_name("POSE");
    app.add_option("--trajectory", options.trajectory, "poses of OBSTACLE, one a line, instead of --pose")
        ->type_name("FILE");
    options.ClashOptions::addTo(app, "--clashes");
    app.add_flag("--any", any, "only whether any point collides");
    app.add_flag("--closest", closest, "the smallest distance, and the points that have it");
    app.add_flag("--distances", distances, "how many points have a distance, and the greatest");
    app.add_option(
           "--obstacle-out", options.obstacle_out,
           "OBSTACLE's points with all their fields, and which of them collide with SITE in a field 'collision'; "
           "of a mesh its triangles, as .ply; a new site where OBSTACLE is one; with --trajectory or --clashes only "
           "with --seen")
        ->type_name("FILE");
    app.add_flag("--resume", options.resume, "goes on with what the same command has left in --out when it was killed");
    std::vector<std::string> names;
    for (const QuestionOption& row : questionOptions())
      if (row.of_sites != OptionOfSites::none) names.emplace_back(row.name);
    addQuestionOptions(app, options.question, names);
    app.add_option("--plan", options.plan,
                   "numbers of ranks, as 64,1024: by what the tiles have cost, the report says how long the same "
                   "question takes on so many, and what limits it")
        ->type_name("N,...")
        ->delimiter(',')
        ->check(CLI::Range(1u, 1000000u));
  }

  /// Reads several obstacles, and refuses what is not told of them. @throws UsageError
  void readSeveral(SiteOptions& options) const
  {
    if (!options.areGiven() && options.obstacle.empty())
      throw UsageError("OBSTACLE is required, or --obstacle NAME=FILE for each of several");
    for (const auto& [given, option] : {std::pair{any, "--any"},
                                        {closest, "--closest"},
                                        {distances, "--distances"},
                                        {!options.obstacle_out.empty(), "--obstacle-out"}})
      if (given && options.areGiven())
        throw UsageError(std::string(option) +
                         ": is not told of several obstacles of a site: leave it out, or give OBSTACLE alone");
    if (options.areGiven()) options.readObstacles(options.obstacle, options.warnings);
    options.SeveralObstacles::requireConsistent(options.question.solid, options.previous.has_value());
    for (const ObstacleChoice& one : options.obstacles)
      if (std::filesystem::is_directory(one.file))
        throw UsageError("--obstacle: " + one.file.string() + ": is a folder: ask about a site alone, as OBSTACLE");
    if (options.areGiven()) options.obstacle.clear();
  }

  /// Requires the options that --seen needs, and refuses those that it excludes. @throws UsageError
  void requireSight(const SiteOptions& options) const
  {
    if (any || closest || distances)
      throw UsageError("--seen: is about points at poses: leave out --any, --closest and --distances");
    if (options.question.origin.empty())
      throw UsageError("--origin: is missing: give X,Y,Z of the scanner, or of several scans FIELD:N=X,Y,Z;N=X,Y,Z by "
                       "the field that numbers them, as source, which numbers the clouds of SITE from 0");
    if (!options.question.seen_angle)
      throw UsageError("--seen-angle: is missing: give one and a half times the angle between "
                       "neighbouring beams");
  }

  /// @throws UsageError for options that exclude each other
  void read(SiteOptions& options)
  {
    readSeveral(options);
    const bool moves = !options.trajectory.empty();
    const bool several = !options.obstacles.empty();
    if (any + closest + distances + moves > 1)
      throw UsageError("--any, --closest, --distances, --trajectory: more than one is given: give one");
    const bool lists = !options.clashes.empty();
    const bool two_sites = options.obstacleIsSite();
    Question& question = options.question;
    const bool needs_clearance = !closest && !distances;
    if (!needs_clearance) question.clearance.reset();
    if (moves) question.path = {Eigen::Isometry3d::Identity()}; // in place of poses that are read later
    Wanted& wanted = question.wanted;
    wanted.any = any;
    wanted.closest = closest || several;
    wanted.distances = distances;
    wanted.flags = needs_clearance && !any;
    wanted.overlap = options.overlap;
    wanted.obstacle_flags =
        wanted.flags && !several && !moves && !lists && (!two_sites || !options.obstacle_out.empty());
    wanted.contacts = lists || (moves && !question.accuracy.stopsEarly());
    wanted.poses = lists && question.swept == 0.0;
    wanted.unseen_places = lists;
    wanted.spacings = true;
    requireAccepted(question, {"--pose"},
                    [&] { several ? site::checkOfSeveral(question) : site::check(question, two_sites); });
    if (question.seen) requireSight(options);
    if (!options.obstacle_out.empty() && (any || closest || distances || ((moves || lists) && !question.seen)))
      throw UsageError("--obstacle-out: are flags at one pose: leave out what else is asked, or give --seen");
    if (!needs_clearance && question.isUncertain())
      throw UsageError("--uncertainty: distances are those of the measured places: leave it out");
    if (needs_clearance && !question.clearance) throw UsageError("--clearance: is missing: give a length");
    if (options.report.empty() && options.out.empty() && options.obstacle_out.empty() && !lists)
      throw UsageError("--report, --out, --obstacle-out, --clashes: none is given: give one or more of them");
    if (lists && (any || closest || distances))
      throw UsageError("--clashes: are of flags or a path: leave out --any, --closest and --distances");
    options.ClashOptions::requireConsistent();
    if (!lists && !options.unit.empty()) throw UsageError("--unit: no clash report tells it: give --clashes FILE");
    if (!options.plan.empty() && options.report.empty())
      throw UsageError("--plan: is told in the report: add --report");
    if (!options.out.empty() && (any || closest))
      throw UsageError("--out: --any and --closest find nothing of each point: leave it away");
    if (options.resume && options.out.empty()) throw UsageError("--resume: there is nothing to go on with: add --out");
    if (question.max_distance && !distances) throw UsageError("--max-distance: goes with --distances: add it");
    if (moves && !pose.empty()) throw UsageError("--pose: --trajectory is given too: give one of them");
    if (!pose.empty()) question.pose = parsePose("--pose", pose, options.warnings);
    const auto require_outside_sites = [&](const char* option, const std::filesystem::path& file) {
      requireOutside(options.site, "SITE", option, file);
      if (two_sites) requireOutside(options.obstacle, "OBSTACLE", option, file);
    };
    require_outside_sites("--out", options.out);
    if (!options.out.empty()) requireOutside(options.out, "--out", "--obstacle-out", options.obstacle_out);
    if (two_sites && !options.obstacle_out.empty())
      requireOutside(options.obstacle_out, "--obstacle-out", "--out", options.out);
    require_outside_sites("--report", options.report);
    require_outside_sites("--obstacle-out", options.obstacle_out);
    for (const std::filesystem::path& list : options.clashes) require_outside_sites("--clashes", list);
    CommandFiles& files = options.files;
    files.reads("SITE", options.site / site::site_file_name);
    files.reads("OBSTACLE", two_sites ? options.obstacle / site::site_file_name : options.obstacle);
    for (const ObstacleChoice& one : options.obstacles)
      if (one.part == 0) files.reads("--obstacle", one.file).readsPose("--obstacle", one.pose_text);
    files.readsPose("--pose", pose).reads("--trajectory", options.trajectory);
    files.writes("--report", options.report);
    files.writesFile("--obstacle-out", options.obstacle_out);
    options.ClashOptions::addTo(files);
  }
};
#endif

} // namespace

std::optional<SiteOptions> parseSiteOptions(int argc, char** argv)
{
  SiteOptions options;
  CLI::App app("Clouds of any size on disk, cut into tiles.", site_program);
  app.footer(io::withFormats(site_footer));
  app.require_subcommand(1);
  const auto command = [&](const char* name, const char* what, SiteCommand number) {
    CLI::App* const sub = app.add_subcommand(name, what);
    sub->callback([&options, number] { options.command = number; });
    return sub;
  };
  const auto add_site = [&](CLI::App* sub) {
    sub->add_option("SITE", options.site, "folder of the site")->type_name("")->required();
  };

  CLI::App* const make = command("make", "make a site of clouds", SiteCommand::make);
  make->add_option("IN", options.clouds, "clouds")->type_name("")->required();
  make->add_option("--out", options.site, "folder of the site: a new one, or one that was begun")
      ->type_name("SITE")
      ->required();
  ReadOptions reading;
  reading.addTo(*make);
  addUnit(*make, "--input-unit", options.clouds_unit,
          "of all clouds' lengths: mm, cm, m, ft or us-ft (default: as a .las\nnames it)");
  addUnit(*make, "--to-unit", options.to_unit, "of the site's lengths (default: they stay as they are)");
  reading.addSystemsTo(*make, false, "all clouds");
  addMemory(*make, options);
  make->add_option("--tile-points", options.tile_points, "points of a tile at most, as 500K or 4M (default: 4M)")
      ->type_name("N")
      ->transform(amount(1000, 1, "give 1 or more"));
  addQuestionOptions(*make, options.question, {"vertices_only"});
  addThreads(*make, options.make_threads, "that read .laz; 0: all of the machine's (default)");
  for (CLI::App* const told :
       {command("info", "print what a site holds", SiteCommand::info),
        command("validate", "read all tiles and check that each point is there once, and where it should be",
                SiteCommand::validate)}) {
    add_site(told);
    told->add_flag("--json", options.json, "as JSON, for programs");
  }
  CLI::App* const write = command(
      "export", "write the points in their first order, as one cloud or one for each source", SiteCommand::write);
  add_site(write);
  write->add_option("OUT", options.out, "a .pcd file for all points, a .pvtp for ParaView, or a folder for the sources")
      ->type_name("")
      ->required();
  addMemory(*write, options);
#ifdef PCL_BSH_SITE_QUERIES
  CLI::App* const collide =
      command("collide", "ask where an obstacle comes near the points of a site", SiteCommand::collide);
  add_site(collide);
  CollideTexts texts;
  texts.addTo(*collide, options);
  reading.addTo(*collide);
  reading.addUnitsTo(*collide);
  addMemory(*collide, options);
#endif
  if (!understood(app, site_program, argc, argv)) return std::nullopt;
  if (options.command == SiteCommand::make) options.reading = reading.read(options.clouds);
  if (options.command == SiteCommand::write) requireExport(options);
#ifdef PCL_BSH_SITE_QUERIES
  if (options.command == SiteCommand::collide) {
    texts.read(options);
    std::vector<std::filesystem::path> clouds;
    for (const ObstacleChoice& one : options.choices())
      if (one.part == 0) clouds.push_back(one.file);
    options.reading = reading.read(clouds);
    if (options.reading.namesUnits() && options.obstacleIsSite())
      throw UsageError("--obstacle-unit: OBSTACLE is a site, too: make one of both with --to-unit");
    options.unit = options.reading.unitOfReports(options.unit, options.reading.input_unit);
  }
#endif
  return options;
}

} // namespace pcl_bsh::cli
