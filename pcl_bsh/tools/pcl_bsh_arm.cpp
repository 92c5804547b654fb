// SPDX-License-Identifier: BSD-3-Clause
// Says where a robot with joints collides, at states and along motions between them.
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/path.h>
#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/robot_options.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/question/named_cloud.h>
#include <pcl_bsh/question/warnings/robot_warnings.h>
#include <pcl_bsh/robot/robot_world.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using Json = nlohmann::ordered_json;
using robots::JointValues;
using robots::Meeting;
using robots::RobotState;

constexpr auto program = "pcl_bsh_arm";
constexpr auto footer =
    R"(A state is free where each link is farther than the clearance from all points and triangles, and from links that it is held
against. A motion is a line between two states in joint space, free where each of its instants is. Both are certain: nothing
is sampled. A motion is undecided only where it comes within the tolerance of the clearance. Lengths are in metres. Boxes,
cylinders and spheres of the URDF are solid, meshes are surfaces. A link is not held against its parent, nor against links
that --srdf disables.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: hold the made robot against what its camera sees, and against itself
  pcl_bsh_made_robot robot --frames 3
  pcl_bsh_arm robot/robot.urdf --states robot/states.csv --motions --report robot/report.json)";

struct Options {
  cli::RobotOptions robot;
  fs::path srdf;
  std::vector<fs::path> obstacles;
  std::string state, base;
  robots::WorldOptions world;
  double radius = 0.0, uncertainty = 0.0;
  std::vector<double> joint_uncertainties;
  bool motions = false, no_self = false;
  unsigned threads = 1;
  std::optional<fs::path> report, table;
  cli::ReadChoice reading;
  cli::CommandFiles files;
};

struct ReadObstacle {
  fs::path path;
  io::Obstacle read;
  std::vector<float> radii;
  std::unique_ptr<const SphereHierarchy> hierarchy;
};

constexpr const char* words[] = {"free", "colliding", "undecided"};

const char* wordOf(Verdict verdict)
{
  return words[static_cast<std::size_t>(verdict)];
}

ReadObstacle readObstacle(const Options& options, const fs::path& path, std::vector<std::string>& warnings)
{
  ReadObstacle obstacle{path, io::readObstacle(path, {}, options.reading.of(path), nullptr, options.threads), {}, {}};
  for (const std::string& remark : obstacle.read.remarks()) warnings.push_back(path.string() + ": " + remark);
  PointsView view = obstacle.read.view();
  if (options.radius > 0.0 && !view.triangles) {
    obstacle.radii.assign(view.count, static_cast<float>(options.radius));
    view.radii = obstacle.radii.data();
  }
  if (!view.triangles) view.uncertainty = options.uncertainty;
  obstacle.hierarchy = std::make_unique<const SphereHierarchy>(view);
  return obstacle;
}

/// States, as values by the names of joints. Joints without a value have that of --state, or 0.
std::vector<JointValues> valuesOf(const Options& options, const io::RobotGroups& groups)
{
  JointValues rest;
  if (!options.state.empty()) {
    const auto found = groups.states.find(options.state);
    if (found == groups.states.end())
      throw cli::UsageError("--state: " + options.srdf.string() + " has no state '" + options.state +
                            "': give the name of one");
    rest = found->second;
  }
  std::vector<JointValues> states = options.robot.values();
  for (JointValues& values : states) values.insert(rest.begin(), rest.end());
  return states;
}

/// The answer about a state or a motion, for programs and for people.
struct Told {
  Json json;
  std::string line;
};

class Arm {
public:
  Arm(const robots::RobotWorld& world, const std::vector<ReadObstacle>& obstacles)
  : world_(world),
    obstacles_(obstacles)
  {
  }

  /// "hand with point 17 of scan.pcd"
  std::string told(const Meeting& meeting) const
  {
    const std::string link = nameOf(meeting.link);
    if (meeting.other_link) return link + " with " + nameOf(*meeting.other_link);
    const ReadObstacle& obstacle = obstacles_[meeting.obstacle];
    return link + " with " + obstacle.read.partName() + " " + std::to_string(meeting.record) + " of " +
           obstacle.path.string();
  }

  void add(const Meeting& meeting, Json& json) const
  {
    json["link"] = nameOf(meeting.link);
    if (meeting.other_link) {
      json["other_link"] = nameOf(*meeting.other_link);
      return;
    }
    const ReadObstacle& obstacle = obstacles_[meeting.obstacle];
    json["obstacle"] = obstacle.path.string();
    json[obstacle.read.partName()] = meeting.record;
    json["place"] = obstacle.hierarchy->view().point(meeting.record);
  }

  Told state(const robots::StateCheck& check, const robots::ClearanceResult& nearest) const
  {
    Json json = {{"verdict", wordOf(check.verdict)}};
    if (nearest.meeting) json["gap"] = {nearest.gap.lower, nearest.gap.upper};
    const std::optional<Meeting>& meeting = check.meeting ? check.meeting : nearest.meeting;
    if (meeting) add(*meeting, json);
    return {json, wordOf(check.verdict) + (meeting ? (check.meeting ? ": " : "; nearest is ") + told(*meeting) : "")};
  }

  Told motion(const robots::MotionCheck& check) const
  {
    Json json = {{"verdict", wordOf(check.verdict)}, {"last_valid", check.last_valid}};
    if (!check.meeting) return {json, wordOf(check.verdict)};
    json["fraction"] = check.fraction;
    add(*check.meeting, json);
    return {json, wordOf(check.verdict) + (" at " + std::to_string(check.fraction)) + ": " + told(*check.meeting) +
                      "; free until " + std::to_string(check.last_valid)};
  }

private:
  const std::string& nameOf(std::size_t link) const { return world_.robot().links[link].name; }

  const robots::RobotWorld& world_;
  const std::vector<ReadObstacle>& obstacles_;
};

/// The answers of ask(effort) about many states or motions, as a step of the program. @param all their number, in words
template <class Ask>
auto answered(const std::string& doing, const std::string& all, const Options& options, const Ask& ask)
{
  cli::Step step(doing + ' ' + all);
  auto answers = ask(Effort(options.threads, [&](double done) { return step.share(done); }));
  step.done(all);
  return answers;
}

/// A row of the table; cells without a value are empty.
std::string rowOf(const char* what, std::size_t number, const Json& json)
{
  const auto cell = [](const Json& value) {
    if (value.is_null()) return std::string();
    if (value.is_string()) return io::csvText(value.get<std::string>());
    return value.is_number_float() ? io::numberText(value.get<double>()) : value.dump();
  };
  const auto of = [&](const char* key) { return json.value(key, Json()); };
  const auto entry = [&](const char* key, std::size_t k) { return json.contains(key) ? json[key][k] : Json(); };
  std::string row = what + (',' + std::to_string(number));
  for (const Json& value :
       {of("verdict"), entry("gap", 0), entry("gap", 1), of("fraction"), of("last_valid"), of("link"), of("other_link"),
        of("obstacle"), json.contains("point") ? of("point") : of("triangle"), entry("place", 0), entry("place", 1),
        entry("place", 2)})
    row += ',' + cell(value);
  return row + '\n';
}

void takeBase(Options& options, std::vector<std::string>& warnings)
{
  if (options.base.empty()) return;
  options.world.base = robots::rigidPose(cli::parsePose("--base", options.base, warnings));
}

int run(Options& options)
{
  std::vector<std::string> warnings;
  takeBase(options, warnings);
  robots::Robot robot = options.robot.read();
  io::RobotGroups groups;
  if (!options.srdf.empty()) groups = io::readGroups(options.srdf, robot);
  cli::Step loading("Loading the robot and obstacles");
  io::readMeshes(robot);
  std::vector<ReadObstacle> obstacles;
  std::vector<const SphereHierarchy*> hierarchies;
  for (const fs::path& path : options.obstacles) {
    obstacles.push_back(readObstacle(options, path, warnings));
    hierarchies.push_back(obstacles.back().hierarchy.get());
  }
  loading.done(counted(robot.links.size(), "link") + ", " + counted(obstacles.size(), "obstacle"));
  std::vector<RobotState> states;
  for (const JointValues& values : valuesOf(options, groups)) states.push_back(stateOf(robot, values));

  options.world.with_self = !options.no_self;
  options.world.joint_uncertainties = options.joint_uncertainties;
  if (options.joint_uncertainties.size() == 1)
    options.world.joint_uncertainties.assign(variablesOf(robot).size(), options.joint_uncertainties[0]);
  const robots::RobotWorld world(robot, hierarchies, options.world);
  const Arm arm(world, obstacles);
  Json report = {{"robot", robot.name},
                 {"links", robot.links.size()},
                 {"clearance", options.world.clearance},
                 {"tolerance", options.world.tolerance},
                 {"states", Json::array()}};
  std::string table =
      "what,number,verdict,gap_lower,gap_upper,fraction,last_valid,link,other_link,obstacle,record,x,y,z\n";
  const auto tell = [&](const char* what, std::size_t i, const std::string& until, const Told& answer) {
    options.files.summary() << what << ' ' << i << until << ": " << answer.line << '\n';
    if (options.table) table += rowOf(what, i, answer.json);
    report[what + std::string("s")].push_back(answer.json);
  };
  const std::string all = counted(states.size(), "state");
  const auto checks =
      answered("Checking", all, options, [&](const Effort& effort) { return world.checkStates(states, effort); });
  const auto nearest = answered("Measuring", all, options, [&](const Effort& effort) {
    return world.clearances(states, std::numeric_limits<double>::infinity(), effort);
  });
  for (std::size_t i = 0; i < states.size(); ++i) tell("state", i, "", arm.state(checks[i], nearest[i]));
  if (options.motions) {
    report["motions"] = Json::array();
    std::vector<robots::RobotWorld::Motion> motions;
    for (std::size_t i = 0; i + 1 < states.size(); ++i) motions.push_back({states[i], states[i + 1]});
    const std::string lines = counted(motions.size(), "motion");
    const auto found = answered("Checking", lines, options,
                                [&](const Effort& effort) { return world.checkMotions(motions, true, effort); });
    for (std::size_t i = 0; i < found.size(); ++i)
      tell("motion", i, " to " + std::to_string(i + 1), arm.motion(found[i]));
  }
  for (const ReadObstacle& obstacle : obstacles)
    if (const auto warning = warningOfHoles(measuredCloud(obstacle.path.string(), *obstacle.hierarchy), robot.name,
                                            options.world.clearance + options.radius))
      warnings.push_back(warning->text);
  cli::warn(program, warnings);
  report["warnings"] = warnings;
  if (options.report) cli::writeJson(*options.report, report);
  if (options.table) files::replaceFile(*options.table, [&](std::ostream& out) { out << table; });
  return 0;
}

void check(Options& options)
{
  if (!options.state.empty() && options.srdf.empty())
    throw cli::UsageError("--state: is a state of an SRDF: give --srdf, too");
  cli::CommandFiles& files = options.files;
  files.reads("ROBOT.urdf", options.robot.urdf).reads("--srdf", options.srdf);
  files.reads("--states", options.robot.states);
  for (const fs::path& obstacle : options.obstacles) files.reads("OBSTACLE", obstacle);
  files.readsPose("--base", options.base).writes("--report", options.report.value_or(""));
  files.writes("--table", options.table.value_or(""));
  files.requireApart();
  if (options.report) files::requireWritable(*options.report);
  if (options.table) files::requireWritable(*options.table);
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, [&] {
    Options options;
    CLI::App app("Where a robot with joints collides with clouds, surfaces and itself, and which motions are free.",
                 program);
    app.footer(footer);
    app.add_option("ROBOT.urdf", options.robot.urdf, "the robot")->type_name("")->required();
    app.add_option("OBSTACLE", options.obstacles, "clouds and surfaces, in one frame")->type_name("");
    app.add_option("--srdf", options.srdf, "pairs of links that are never held against each other, and named states")
        ->type_name("FILE");
    options.robot.addJointsTo(app, "values of joints, in radians or metres", "state");
    app.add_option("--state", options.state, "state of the SRDF: values of joints that are not given (default: 0)")
        ->type_name("NAME");
    app.add_flag("--motions", options.motions, "also check the motion from each state to the next");
    const auto length = [&](const char* name, double& value, const char* description) {
      app.add_option(name, value, description)
          ->type_name("M")
          ->transform(cli::number<double>("give a length in metres, >= 0", [](double given) { return given >= 0.0; }))
          ->capture_default_str();
    };
    length("--clearance", options.world.clearance, "links this near to an obstacle collide");
    length("--self-clearance", options.world.self_clearance, "links this near to each other collide");
    length("--tolerance", options.world.tolerance, "motions this near to the clearance may be undecided");
    length("--radius", options.radius, "points are balls of this radius");
    length("--uncertainty", options.uncertainty, "points may be this far from where they were measured");
    app.add_option("--joint-uncertainty", options.joint_uncertainties,
                   "values of joints may be off by this, in radians or metres: one number for\nall of them, or one for "
                   "each in the order of links; what depends on it is undecided")
        ->type_name("Q,...")
        ->transform(cli::number<double>("give an angle or a length, >= 0", [](double given) { return given >= 0.0; }))
        ->delimiter(',')
        ->allow_extra_args(false);
    app.add_flag("--no-self", options.no_self, "do not hold links against each other");
    app.add_option("--base", options.base,
                   "pose of the robot's root among the obstacles:\nx,y,z,roll,pitch,yaw or a file")
        ->type_name("POSE");
    options.robot.addPackagesTo(app);
    cli::addThreads(app, options.threads, "0: all of the machine's; any number gives the same result")
        ->capture_default_str();
    app.add_option("--report", options.report, "JSON file for the results; - is standard output")->type_name("FILE");
    app.add_option("--table", options.table, "CSV file: a line for each state and motion; - is standard output")
        ->type_name("FILE");
    cli::ReadOptions reading;
    reading.addTo(app);
    if (!cli::understood(app, program, argc, argv)) return 0;
    options.reading = reading.read({options.obstacles.begin(), options.obstacles.end()});
    check(options);
    return run(options);
  });
}
