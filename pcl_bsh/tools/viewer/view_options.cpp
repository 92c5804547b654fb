// SPDX-License-Identifier: BSD-3-Clause
#include "view_options.h"

#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/path.h>
#include <pcl_bsh/tools/cli/question_options.h>

#include <pcl_bsh/io/clouds/formats.h>
#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/text/parse_number.h>
#include <pcl_bsh/site/site.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace pcl_bsh::viewer {
namespace {

constexpr auto footer =
    R"(Points of the first CLOUD within D of another CLOUD, of the MODEL or of an --obstacle collide, decided exactly;
they are drawn larger and in orange, all others dimmed. A file with faces is a surface, drawn as one:
its triangles are compared, coloured and picked. The inside of a closed one counts with --solid: distances
are signed, and inside they are orange to red. A surface that does not close is refused: --open-edges shows why.
A cloud that holds the fields collision, distance or first_pose, or a .ply whose faces have such
properties, shows these as they are.
For a site, the folder that pcl_bsh_site makes, the overview is drawn at once, and the tiles that the
camera sees nearest one by one, as many as the budget holds; with its fields collision, distance ...
coloured as clouds are.
Each --obstacle has a colour, a line of what collides with it, and a mark where it is nearest if anything does.
A scene's objects are drawn at their poses of one step, responses included: fixed ones in grey, moving ones in blue,
and points within the scene's clearance, or D, in orange and yellow.
Reads {read}, pipes, and standard input as -.
Without --screenshot and --export a window opens: h shows its keys. With d, the mouse drags objects of a scene.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Examples:
  pcl_bsh_view hall.ply --model robot.pcd --pose 1.5,2,0,0,0,1.57 --clearance 0.05 --unit m
  pcl_bsh_view tunnel.pcd --model wagon.ply --trajectory path.txt --clearance 0.1 --color first_pose \
    --title "The wagon's way" --screenshot way.png
  pcl_bsh_view after.pcd before.pcd --color distance --unit m --screenshot change.png
  pcl_bsh_view machine.stl --model hall.las --pose 1.5,2,0,0,0,1.57 --clearance 0.05
  pcl_bsh_view hall.las --obstacle "press=press.stl;pose=2,1,0,0,0,0" --obstacle mill=mill.stl --clearance 0.05
  pcl_bsh_view hall.ply --model press.stl --pose 1.5,2,0,0,0,0 --solid --color distance --screenshot depth.png
  pcl_bsh_view press.stl --open-edges
  pcl_bsh_view --scene walk.json --step 80 --clearance 0.3
  pcl_bsh_view valley --budget 20M
  pcl_bsh_view marked.pcd --camera colliding --screenshot marked.png --size 1600x1000
  pcl_bsh_view hall.ply --model robot.pcd --clearance 0.05 --level 2 --export hall.vtm)";

using cli::UsageError;

Camera parseCamera(const std::string& text)
{
  static const std::map<std::string, Camera::Kind> known = {{"slanted", Camera::Kind::slanted},
                                                            {"top", Camera::Kind::top},
                                                            {"front", Camera::Kind::front},
                                                            {"side", Camera::Kind::side},
                                                            {"colliding", Camera::Kind::colliding}};
  Camera camera;
  if (const auto found = known.find(text); found != known.end()) {
    camera.kind = found->second;
    return camera;
  }
  std::vector<double> n;
  try {
    n = io::numbersOf(text);
  }
  catch (const io::FormatError&) {
    // Neither a name nor numbers.
  }
  if (n.size() != 6 && n.size() != 9)
    throw UsageError("--camera: '" + text + "' is unknown: give slanted, top, front, side, colliding or the numbers " +
                     "of eye, focus and, if not 0,0,1, up");
  camera.kind = Camera::Kind::given;
  std::copy_n(n.begin(), 3, camera.eye.begin());
  std::copy_n(n.begin() + 3, 3, camera.focus.begin());
  if (n.size() == 9) std::copy_n(n.begin() + 6, 3, camera.up.begin());
  if (!std::all_of(n.begin(), n.end(), [](double number) { return std::isfinite(number); }))
    throw UsageError("--camera: '" + text + "': has a number that is not finite: give numbers");
  const Eigen::Vector3d gaze = Eigen::Vector3d(camera.focus.data()) - Eigen::Vector3d(camera.eye.data());
  const Eigen::Vector3d up(camera.up.data());
  if (camera.eye == camera.focus)
    throw UsageError("--camera: '" + text + "': eye and focus are the same: give two places");
  const auto isAlong = [&gaze](const Eigen::Vector3d& v) {
    return !(v.stableNormalized().cross(gaze.stableNormalized()).norm() > 1e-6);
  };
  if (n.size() == 6 && isAlong(up)) camera.up = {0, 1, 0};
  if (n.size() == 9 && isAlong(up))
    throw UsageError("--camera: '" + text + "': up is 0 or along the view: give another, as 0,1,0 from above");
  return camera;
}

Cut parseCut(const std::string& text)
{
  std::vector<double> n;
  try {
    n = io::numbersOf(text);
  }
  catch (const io::FormatError&) {
    // Not numbers.
  }
  Cut cut;
  if (n.size() == 6) {
    std::copy_n(n.begin(), 3, cut.point.begin());
    std::copy_n(n.begin() + 3, 3, cut.normal.begin());
  }
  if (n.size() != 6 || !std::all_of(n.begin(), n.end(), [](double number) { return std::isfinite(number); }) ||
      cut.normal == std::array<double, 3>{})
    throw UsageError("--cut: '" + text +
                     "' is no plane: give x,y,z of a point in it and nx,ny,nz of its normal, not 0");
  return cut;
}

void parseSize(const std::string& text, Options& options)
{
  const auto pixels = [&](const std::string& part) {
    try {
      const int value = io::parseNumber<int>(part);
      if (value < 64 || value > 16384) throw UsageError("--size: " + part + " pixels: give 64 to 16384");
      return value;
    }
    catch (const io::FormatError& error) {
      throw UsageError(std::string("--size: ") + error.what() + ": give WIDTHxHEIGHT in pixels, as 1280x960");
    }
  };
  const std::size_t x = text.find('x');
  options.width = pixels(text.substr(0, x));
  options.height = pixels(x == std::string::npos ? "" : text.substr(x + 1));
}

void checkScene(const Options& options)
{
  const auto refuse = [](const char* option) {
    throw UsageError(std::string(option) + ": a --scene says this itself: leave it out");
  };
  if (!options.clouds.empty()) refuse("CLOUD");
  if (options.model) refuse("--model");
  if (options.areGiven()) refuse("--obstacle");
  if (!options.question.pose.isApprox(Eigen::Isometry3d::Identity(), 0.0)) refuse("--pose");
  if (options.trajectory) refuse("--trajectory");
  if (options.question.solid) refuse("--solid");
  if (options.question.input_solid) refuse("--input-solid");
  if (options.question.seen) refuse("--seen");
  if (options.beams > 0) refuse("--beams");
  if (options.trace) throw UsageError("--trace: shows a query of clouds: give these in place of --scene");
  if (options.cut) throw UsageError("--cut: cuts a cloud: give clouds in place of --scene");
  if (options.color && *options.color != Coloring::collision)
    throw UsageError("--color: a --scene is coloured by collision: leave it out");
  if (options.export_to && options.export_to->extension() == ".vtp")
    throw UsageError("--export: " + options.export_to->string() + ": holds one cloud: name a .vtm file");
}

/// Refuses obstacles without names, and poses of a model: obstacles with names have poses of their own.
void checkNamed(const Options& options)
{
  if (options.clouds.size() > 1)
    throw UsageError("CLOUD: " + options.clouds[1].string() +
                     " is an obstacle without a name, and others have names: give it as --obstacle, too");
  for (const auto& [given, option] : {std::pair{options.model.has_value(), "--model"},
                                      {!options.question.pose.isApprox(Eigen::Isometry3d::Identity(), 0.0), "--pose"}})
    if (given)
      throw UsageError(std::string(option) +
                       ": is of one model, and obstacles have names: give --obstacle \"NAME=FILE;pose=POSE\"");
}

void checkClouds(const Options& options)
{
  if (options.clouds.empty()) throw UsageError("CLOUD: is missing: name a cloud, or a scene with --scene");
  if (options.areGiven()) checkNamed(options);
  const bool moves = options.trajectory || !options.question.pose.isApprox(Eigen::Isometry3d::Identity(), 0.0);
  if (moves && !options.model && !options.areGiven())
    throw UsageError("--model: is missing: say which cloud the poses are for");
  const bool obstacles = options.model || options.areGiven() || options.clouds.size() > 1;
  if (options.question.clearance && !obstacles)
    throw UsageError("--clearance: there is nothing to collide with: give a second cloud or --model");
  if ((options.question.solid || options.question.input_solid) && !obstacles)
    throw UsageError(std::string(options.question.solid ? "--solid" : "--input-solid") +
                     ": there is nothing to collide with: give a second cloud or --model");
  if (!options.question.clearance && obstacles && options.color &&
      (*options.color == Coloring::collision || *options.color == Coloring::first_pose))
    throw UsageError("--clearance: is missing: this --color asks what collides");
  if (options.question.seen && (!obstacles || !options.question.clearance))
    throw UsageError("--seen: is about obstacles and a clearance: give both");
  if (options.trace && !options.question.clearance) throw UsageError("--clearance: is missing: --trace shows a query");
  if (options.closest && !obstacles)
    throw UsageError("--closest: there is no second cloud: give a second cloud or --model");
}

void checkSite(const Options& options)
{
  const auto refuse = [&](const std::string& option) {
    throw UsageError(option + ": " + options.site->string() +
                     " is a site, which is shown alone: ask with pcl_bsh_site, and show the site that --out makes");
  };
  if (!options.clouds.empty()) refuse("CLOUD");
  if (options.scene) refuse("--scene");
  if (options.model) refuse("--model");
  if (options.areGiven()) refuse("--obstacle");
  if (!options.question.pose.isApprox(Eigen::Isometry3d::Identity(), 0.0)) refuse("--pose");
  if (options.trajectory) refuse("--trajectory");
  if (options.question.clearance) refuse("--clearance");
  if (options.question.solid) refuse("--solid");
  if (options.question.input_solid) refuse("--input-solid");
  if (options.open_edges) refuse("--open-edges");
  if (options.trace) refuse("--trace");
  if (options.question.seen) refuse("--seen");
  if (options.beams > 0) refuse("--beams");
  if (options.closest) refuse("--closest");
  if (options.export_to) throw UsageError("--export: of a site: give pcl_bsh_site export SITE FILE.pvtp");
  if (options.step > 0) throw UsageError("--step: a site has no poses: leave it out");
}

void checkRange(const Options& options)
{
  if (!options.range) return;
  if (options.color != Coloring::distance) throw UsageError("--range: is for distances: give --color distance, too");
  if (!(*options.range > options.question.clearance.value_or(0.0)) || !std::isfinite(*options.range))
    throw UsageError("--range: give a length greater than --clearance, or than 0");
}

void checkFiles(const Options& options)
{
  if (options.export_to) {
    const std::string extension = options.export_to->extension().string();
    if (extension != ".vtp" && extension != ".vtm")
      throw UsageError("--export: " + options.export_to->string() + ": name a .vtp file (the first cloud alone) or a " +
                       ".vtm file (everything)");
  }
  if (options.screenshot && options.screenshot->extension() != ".png")
    throw UsageError("--screenshot: " + options.screenshot->string() + ": name a .png file");
}

} // namespace

std::optional<Options> parseOptions(int argc, char** argv)
{
  Options options;
  std::string pose, cut, size = "1280x960", camera = "slanted";
  CLI::App app("Shows clouds, where they collide, and the spheres that find it.", program);
  app.footer(io::withFormats(footer));
  const auto named = [&](const char* name, const char* form, auto& value, const char* help) {
    return app.add_option(name, value, help)->type_name(form);
  };
  named("CLOUD", "", options.clouds,
        "the cloud or surface that is tested, then obstacles in the same\nframe; or a site, alone");
  named("--scene", "SCENE.json", options.scene,
        "a scene file in place of clouds: objects, their motions and responses");
  named("--model", "CLOUD", options.model, "an obstacle that has poses");
  options.addObstaclesTo(app);
  named("--pose", "POSE", pose, "of the model: x,y,z,roll,pitch,yaw (radians), or a file of a\nmatrix (default: none)");
  named("--trajectory", "FILE", options.trajectory,
        "poses of the model or of all --obstacle, one a line: 12 or 16 numbers of its matrix, or\ntime tx ty "
        "tz qx qy qz qw");
  named("--step", "N", options.step,
        "the pose of the trajectory, or the step of the scene, to begin\nwith, from 0 (default: 0)")
      ->transform(cli::number<unsigned>("give the number of a pose or step, from 0"));
  options.question.threads = 0;
  cli::addQuestionOptions(
      app, options.question,
      {"clearance", "solid", "input_solid", "seen", "origin", "seen_angle", "vertices_only", "threads"});
  cli::ReadOptions reading;
  reading.addTo(app);
  reading.addUnitsTo(app);
  named("--color", "BY", options.color,
        "collision (default where known), distance, first_pose, height,\nrgb or intensity; distance without "
        "--clearance is of all points,\nwith a histogram")
      ->transform(cli::choice<Coloring>({{"collision", Coloring::collision},
                                         {"distance", Coloring::distance},
                                         {"first_pose", Coloring::first_pose},
                                         {"height", Coloring::height},
                                         {"rgb", Coloring::rgb},
                                         {"intensity", Coloring::intensity}}));
  named("--range", "D", options.range,
        "with --color distance: colours end at this distance; with\n--clearance, what collides is orange "
        "(default: the clearance;\nwithout one, what 99 of 100 points are within)")
      ->transform(cli::number<double>(cli::give_length));
  named("--cut", "PLANE", cut,
        "a plane x,y,z,nx,ny,nz: the first cloud is not drawn on the side\nthat nx,ny,nz points to");
  named("--level", "L", options.level, "draw the hierarchies' spheres: 0 the voxels', 1, 2 ... finer")
      ->transform(cli::number<unsigned>("give 0 or more"));
  CLI::Option* const budget =
      named("--budget", "N", options.budget,
            "of a site: points that are drawn at once, as 500K or 20M, the overview\nincluded; each takes some "
            "100 bytes of memory (default: 10M)")
          ->transform(cli::amount(1000, 1, "give 1 or more"));
  app.add_flag("--voxels", options.voxels, "draw the voxels");
  app.add_flag("--cells", options.cells, "draw boxes around the octree cells of the level");
  app.add_flag("--trace", options.trace, "draw what the query for any collision tested and pruned");
  app.add_flag("--open-edges", options.open_edges, "draw the edges of surfaces that no other triangle closes, in red");
  named("--beams", "N", options.beams,
        "draw so many beams of the first cloud's scanner, evenly picked: from\nwhere it stood, as --origin or "
        "the file says, to the points")
      ->transform(cli::number<unsigned>("give the number of beams"));
  app.add_flag("--closest", options.closest, "draw the closest pair and its distance");
  named("--title", "TEXT", options.title, "a first line above the counts");
  named("--unit", "NAME", options.unit, "name of the clouds' unit, for titles");
  named("--screenshot", "FILE.png", options.screenshot,
        "write a picture instead of opening a window; needs no display");
  named("--size", "WxH", size, "of the picture or window (default: 1280x960)");
  named("--camera", "HOW", camera,
        "slanted (default), top, front, side, colliding (close to what\ncollides, from where it is seen), or "
        "eye x,y,z,\nfocus x,y,z"
        "[, up x,y,z]");
  named("--export", "FILE", options.export_to, "write the cloud (.vtp) or everything (.vtm) for ParaView");
  if (!cli::understood(app, program, argc, argv)) return std::nullopt;
  cli::requireAccepted(options.question);

  std::vector<std::string> warnings;
  options.readObstacles({}, warnings);
  if (!pose.empty()) {
    if (options.trajectory) throw UsageError("--pose: a model has one pose or a --trajectory: give one of the two");
    options.question.pose = cli::parsePose("--pose", pose, warnings);
  }
  cli::warn(program, warnings);
  if (!cut.empty()) options.cut = parseCut(cut);
  if (!options.clouds.empty() && std::filesystem::is_directory(options.clouds[0])) {
    options.site = options.clouds[0];
    options.clouds.erase(options.clouds.begin());
    options.files.reads("SITE", *options.site / site::site_file_name);
  }
  const auto path = [](const std::optional<std::filesystem::path>& file) { return file.value_or(""); };
  for (const std::filesystem::path& cloud : options.clouds) options.files.reads("CLOUD", cloud);
  std::vector<std::filesystem::path> read = options.clouds;
  if (options.model) read.push_back(*options.model);
  for (const cli::ObstacleChoice& one : options.obstacles) {
    if (one.part > 0) continue;
    read.push_back(one.file);
    options.files.reads("--obstacle", one.file).readsPose("--obstacle", one.pose_text);
  }
  options.reading = reading.read(read);
  options.files.reads("--scene", path(options.scene)).reads("--model", path(options.model));
  options.files.reads("--trajectory", path(options.trajectory)).readsPose("--pose", pose);
  options.files.writes("--screenshot", path(options.screenshot)).writes("--export", path(options.export_to));
  parseSize(size, options);
  options.camera = parseCamera(camera);
  if (budget->count() > 0 && !options.site) throw UsageError("--budget: is for a site: leave it out");
  if (options.site)
    checkSite(options);
  else
    options.scene ? checkScene(options) : checkClouds(options);
  checkRange(options);
  checkFiles(options);
  return options;
}

} // namespace pcl_bsh::viewer
