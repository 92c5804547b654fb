// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include "cli/command_line.h"
#include "cli/pose.h"

#include <string>

namespace pcl_bsh::cli {
namespace {

constexpr auto site_footer =
    R"(A site is a folder of tiles, each a binary PCD file with all fields of the points and two more, source and record:
which record of which cloud a point was. Reads .pcd .ply .las .obj .off .stl .pts .ptx .csv .xyz .txt; .las and binary .pcd
of any size, the others where they fit into half of the memory given.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: two scans become one site, and a file with the points of both
  pcl_bsh_site make north.las south.las --out valley --memory 2G
  pcl_bsh_site validate valley
  pcl_bsh_site export valley all.pcd
With --out: the fields of `collide` are collision (1 collides, 0 free), with --trajectory also distance (NaN: free),
first_pose and closest_pose (-1: none), with --distances distance alone.
Example: where does a machine come within 5 cm of it on its way? On one process, or on four:
  pcl_bsh_site collide valley machine.pcd --clearance 0.05 --trajectory poses.txt --report way.json
  mpirun -n 4 pcl_bsh_site collide valley machine.pcd --clearance 0.05 --trajectory poses.txt --report way.json)";

void addMemory(CLI::App& app, SiteOptions& options)
{
  app.add_option("--memory", options.memory, "memory to work in, as 512M or 2G (default: 2G)")
      ->type_name("BYTES")
      ->transform(amount(1024, std::uint64_t{64} << 20, "give 64M or more"));
}

#ifdef PCL_BSH_SITE_QUERIES
/// The options of `collide` as they are written.
struct CollideTexts {
  bool any = false, closest = false, distances = false;
  std::string pose;
  CLI::Option *clearance = nullptr, *max_distance = nullptr;

  void addTo(CLI::App& app, SiteOptions& options)
  {
    app.add_option("OBSTACLE", options.obstacle, "cloud to collide with, which must fit into memory")
        ->type_name("")
        ->required();
    app.add_option("--report", options.report, "JSON file for the answer; -: standard output")->type_name("FILE");
    app.add_option("--out", options.out, "new site with what was found of each point, as fields more of the same tiles")
        ->type_name("SITE");
    clearance = app.add_option("--clearance", options.clearance,
                               "greatest distance that counts as collision, in the clouds' unit")
                    ->type_name("D")
                    ->transform(number<double>(give_length));
    app.add_option("--pose", pose, "of OBSTACLE in SITE's frame: x,y,z,roll,pitch,yaw or a file")->type_name("POSE");
    app.add_option("--trajectory", options.trajectory, "poses of OBSTACLE, one a line, instead of --pose")
        ->type_name("FILE");
    app.add_option("--swept", options.swept, "of --trajectory: the motion between poses counts, to this tolerance")
        ->type_name("TOL")
        ->transform(number<double>("give a length > 0", [](double d) { return d > 0; }));
    app.add_flag("--any", any, "only whether any point collides");
    app.add_flag("--closest", closest, "the smallest distance, and the points that have it");
    app.add_flag("--distances", distances, "how many points have a distance, and the greatest");
    max_distance = app.add_option("--max-distance", options.max_distance, "of --distances: greater ones do not count")
                       ->type_name("M")
                       ->transform(number<double>("give a length >= 0", [](double d) { return d >= 0; }));
    app.add_option("--plan", options.plan,
                   "numbers of ranks, as 64,1024: by what the tiles have cost, the report says how long the same "
                   "question takes on so many, and what limits it")
        ->type_name("N,...")
        ->delimiter(',')
        ->check(CLI::Range(1u, 1000000u));
    app.add_option("--threads", options.threads, "of each process (default: 1); 0: all of the machine's")
        ->type_name("N")
        ->transform(number<unsigned>(give_threads));
  }

  /// @throws UsageError where they do not fit each other
  void read(SiteOptions& options) const
  {
    const bool moves = !options.trajectory.empty();
    if (any + closest + distances + moves > 1)
      throw UsageError("--any, --closest, --distances, --trajectory: more than one is given: give one");
    options.question = any         ? SiteQuestion::any
                       : closest   ? SiteQuestion::closest
                       : distances ? SiteQuestion::distances
                       : moves     ? SiteQuestion::path
                                   : SiteQuestion::flags;
    const bool needs_clearance = !closest && !distances;
    if (needs_clearance && clearance->count() == 0) throw UsageError("--clearance: is missing: give a length");
    if (options.report.empty() && options.out.empty())
      throw UsageError("--report, --out: none is given: give --report, --out or both");
    if (!options.plan.empty() && options.report.empty())
      throw UsageError("--plan: is told in the report: add --report");
    if (!options.out.empty() && (any || closest))
      throw UsageError("--out: --any and --closest find nothing of each point: leave it away");
    if (max_distance->count() > 0 && !distances) throw UsageError("--max-distance: goes with --distances: add it");
    if (options.swept && !moves) throw UsageError("--swept: goes with --trajectory: add it");
    if (moves && !pose.empty()) throw UsageError("--pose: --trajectory is given too: give one of them");
    if (!pose.empty()) options.pose = parsePose("--pose", pose, options.warnings);
  }
};
#endif

} // namespace

std::optional<SiteOptions> parseSiteOptions(int argc, char** argv)
{
  SiteOptions options;
  CLI::App app("Clouds of any size on disk, cut into tiles.", site_program);
  app.footer(site_footer);
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
  addMemory(*make, options);
  make->add_option("--tile-points", options.tile_points, "points of a tile at most, as 500K or 4M (default: 4M)")
      ->type_name("N")
      ->transform(amount(1000, 1, "give 1 or more"));
  add_site(command("info", "print what a site holds", SiteCommand::info));
  add_site(command("validate", "read all tiles and check that each point is there once, and where it should be",
                   SiteCommand::validate));
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
  addMemory(*collide, options);
#endif
  if (!understood(app, site_program, argc, argv)) return std::nullopt;
#ifdef PCL_BSH_SITE_QUERIES
  if (options.command == SiteCommand::collide) texts.read(options);
#endif
  return options;
}

} // namespace pcl_bsh::cli
