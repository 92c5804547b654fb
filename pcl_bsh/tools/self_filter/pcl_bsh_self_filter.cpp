// SPDX-License-Identifier: BSD-3-Clause
// Cuts the robot that scans out of its scans: links from a URDF, where the joints' values put them.
#include "self_filter.h"
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/robot_options.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/question/text_numbers.h>
#include <pcl_bsh/question/warnings/warnings.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/selected_records.h>

#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <utility>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using Json = nlohmann::ordered_json;
using self_filter::JointValues;

constexpr auto program = "pcl_bsh_self_filter";
constexpr auto footer =
    R"(Each output has the name of its cloud, in the folder of --out, and all fields. A point that is kept, or has coordinates and
the flag 0, is farther than the padding from every link; one that is removed, or has the flag 1, is within the padding of
a link, has no coordinates, or is no return: exactly 0 0 0, where the sensor itself is. Boxes,
cylinders, spheres and meshes that close are solid; other meshes are surfaces, with a warning. A link counts with its bodies for collisions; where it has none, those
to look at. Joints are fixed, revolute, continuous or prismatic; limits are not looked at. Meshes are .stl, .obj, .ply or
.off in metres, or, where assimp was there when this was built, .dae: its <unit> counts, its <up_axis> does not, as in RViz.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: cut the made robot out of what its camera sees
  pcl_bsh_made_robot robot --frames 3
  pcl_bsh_self_filter robot/robot.urdf robot/frame_*.pcd --states robot/states.csv --frame camera --out robot/free)";

struct Options {
  cli::RobotOptions robot;
  std::vector<std::string> clouds;
  fs::path out;
  std::string frame;
  std::vector<std::string> paddings;
  self_filter::Settings settings;
  bool flag = false;
  std::optional<fs::path> report;
  cli::ReadChoice reading;
  cli::CommandFiles files;
};

/// Sets the padding of all links, and those of links that have their own.
void takePaddings(const std::vector<std::string>& texts, self_filter::Settings& settings)
{
  const auto refuse = [](const std::string& text, const char* wrong) {
    throw cli::UsageError("--padding: '" + text + "' " + wrong + ": give M, or LINK=M, in metres");
  };
  bool all = false;
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const std::optional<std::vector<double>> number =
        numbersOf(text.substr(equals == std::string::npos ? 0 : equals + 1));
    if (!number || number->size() != 1 || !(number->front() >= 0.0) || equals == 0) refuse(text, "is no padding");
    const bool first = equals == std::string::npos
                           ? !std::exchange(all, true)
                           : settings.paddings.emplace(text.substr(0, equals), number->front()).second;
    if (!first)
      refuse(text, equals == std::string::npos ? "is a second one for all links" : "is a second one of that link");
    if (equals == std::string::npos) settings.padding = number->front();
  }
}

/// Refuses paddings of links that are not there. @throws std::runtime_error naming the option
void requireLinks(const self_filter::Settings& settings, const self_filter::Robot& robot)
{
  try {
    for (const auto& [link, padding] : settings.paddings) robot.linkNamed(link);
  }
  catch (const std::invalid_argument& error) {
    throw std::runtime_error(std::string("--padding: ") + error.what());
  }
}

/// The values of joints for each cloud.
std::vector<JointValues> statesOf(const Options& options)
{
  std::vector<JointValues> states = options.robot.values();
  if (states.size() == 1) states.resize(options.clouds.size(), states[0]);
  if (states.size() != options.clouds.size())
    throw cli::UsageError("--states: " + options.robot.states.string() + " has " + counted(states.size(), "line") +
                          " of values for " + counted(options.clouds.size(), "cloud") +
                          ": give one line for each cloud, or one for all");
  return states;
}

fs::path outputOf(const Options& options, const std::string& cloud)
{
  return options.out / fs::path(cloud).filename();
}

void check(Options& options)
{
  cli::CommandFiles& files = options.files;
  files.reads("ROBOT.urdf", options.robot.urdf).reads("--states", options.robot.states);
  for (const std::string& cloud : options.clouds) files.reads("CLOUD", cloud);
  for (const std::string& cloud : options.clouds) files.writesFile("--out", outputOf(options, cloud));
  files.writes("--report", options.report.value_or(""));
  files.requireApart();
  if (options.report) files::requireWritable(*options.report);
}

/// The cloud without the points that are flagged, and without those that have no coordinates.
pcl::PCLPointCloud2 withoutFlagged(const pcl::PCLPointCloud2& cloud, const PointsView& view,
                                   const std::vector<Verdict>& flags)
{
  pcl::Indices kept;
  for (std::uint32_t i = 0; i < view.count; ++i)
    if (flags[i] == Verdict::free && isFinite(view.point(i))) kept.push_back(static_cast<pcl::index_t>(i));
  return selectedRecords(cloud, kept);
}

/// @param once tells each kind of warning once: clouds come in streams
Json filterCloud(const Options& options, const std::string& name, const JointValues& values, std::size_t frame,
                 self_filter::SelfFilter& filter, WarningsOnce& once)
{
  io::CloudFacts facts;
  const pcl::PCLPointCloud2 cloud = io::readCloud(name, &facts, options.reading.of(name), options.settings.threads);
  std::vector<std::string> warnings;
  for (const std::string& remark : facts.remarks) warnings.push_back(name + ": " + remark);
  const PointsView view = viewOf(cloud);
  const Eigen::Isometry3d T_scan_root = linkPoses(filter.robot(), values)[frame].inverse();
  const auto start = std::chrono::steady_clock::now();
  std::vector<Verdict> flags = filter.flags(view, T_scan_root, values);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  NamedCloud scan = filter.scan();
  scan.name = name;
  addTexts(once.unheard(warningsOf(scan, filter.leastPadding())), warnings);
  cli::warn(program, warnings);
  std::size_t robot = 0, no_returns = 0;
  for (std::uint32_t i = 0; i < view.count; ++i) {
    const bool is_return = !self_filter::isNoReturn(view.point(i));
    robot += is_return && flags[i] == Verdict::colliding ? 1 : 0;
    no_returns += is_return ? 0 : 1;
    if (!is_return) flags[i] = Verdict::colliding;
  }
  io::writeCloud(outputOf(options, name),
                 options.flag ? withField(cloud, collision_field_name, flags) : withoutFlagged(cloud, view, flags),
                 facts.viewpoint, facts.las);
  return {{"cloud", name},
          {"points", flags.size()},
          {"robot", robot},
          {"no_returns", no_returns},
          {"seconds", taken.count()},
          {"warnings", warnings}};
}

/// Refuses outputs that are meshes of the robot. @throws UsageError
void requireMeshesApart(cli::CommandFiles files, const self_filter::Robot& robot)
{
  for (const self_filter::Link& link : robot.links)
    for (const self_filter::Shape& shape : link.shapes)
      if (const auto* const mesh = std::get_if<robots::Mesh>(&shape.form))
        files.reads("mesh of link '" + link.name + "'", mesh->path);
  files.requireApart();
}

int run(const Options& options)
{
  const std::vector<JointValues> states = statesOf(options);
  const self_filter::Robot robot = options.robot.read();
  requireLinks(options.settings, robot);
  requireMeshesApart(options.files, robot);
  for (const JointValues& values : states) robot.requireValues(values);
  const std::size_t frame = options.frame.empty() ? 0 : robot.linkNamed(options.frame);

  cli::Step loading("Loading the links");
  self_filter::SelfFilter filter(robot, options.settings);
  loading.done(counted(filter.triangles(), "triangle") + ", " + counted(filter.solids(), "solid"));
  cli::warn(program, filter.warnings());

  const files::OutputFolder folder(options.out);
  Json report = {{"robot", robot.name},       {"links", robot.links.size()},         {"triangles", filter.triangles()},
                 {"solids", filter.solids()}, {"padding", options.settings.padding}, {"warnings", filter.warnings()},
                 {"clouds", Json::array()}};
  if (!options.settings.paddings.empty()) report["paddings"] = options.settings.paddings;
  WarningsOnce once;
  for (std::size_t i = 0; i < options.clouds.size(); ++i) {
    report["clouds"].push_back(filterCloud(options, options.clouds[i], states[i], frame, filter, once));
    const Json& told = report["clouds"].back();
    options.files.summary() << options.clouds[i] << ": " << told["robot"] << " of "
                            << counted(told["points"].get<std::uint64_t>(), "point is", "points are") << " the robot, "
                            << counted(told["no_returns"].get<std::uint64_t>(), "is", "are") << " no return, found in "
                            << 1000 * told["seconds"].get<double>() << " ms\n";
  }
  if (options.report) cli::writeJson(*options.report, report);
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, [&] {
    Options options;
    CLI::App app("Cuts a robot out of what its own sensors see.", program);
    app.footer(footer);
    app.add_option("ROBOT.urdf", options.robot.urdf, "the robot")->type_name("")->required();
    app.add_option("CLOUD", options.clouds, "what its sensor saw: a cloud for each frame")->type_name("")->required();
    app.add_option("--out", options.out, "folder for the results; made if it is not there")
        ->type_name("DIR")
        ->required();
    options.robot.addJointsTo(app, "values of joints, in radians or metres; others are at 0", "cloud");
    app.add_option("--frame", options.frame, "link in whose frame the clouds are (default: the root)")
        ->type_name("LINK");
    app.add_option(
           "--padding", options.paddings,
           "points this near to the robot are cut out, too, in metres; LINK=M: of that\nlink alone, in place of "
           "it; several with commas between them (default: 0.02)")
        ->type_name("M,LINK=M,...")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->take_all();
    app.add_flag("--flag", options.flag,
                 "keep all points, with a field 'collision' that is 1 where the robot or no return is");
    options.robot.addPackagesTo(app);
    cli::addThreads(app, options.settings.threads, "0: all of the machine's; any number gives the same result")
        ->capture_default_str();
    app.add_option("--report", options.report, "JSON file for the results and what they cost;\n- is standard output")
        ->type_name("FILE");
    cli::ReadOptions reading;
    reading.addTo(app);
    if (!cli::understood(app, program, argc, argv)) return 0;
    options.reading = reading.read({options.clouds.begin(), options.clouds.end()});
    takePaddings(options.paddings, options.settings);
    check(options);
    return run(options);
  });
}
