// SPDX-License-Identifier: BSD-3-Clause
// Which points of a cloud collide with an obstacle, at a pose or along a path? From two files to a third, with reports.
#include <pcl_bsh/tools/cli/obstacle.h>
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/question_options.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/collide/loading.h>
#include <pcl_bsh/tools/collide/options.h>
#include <pcl_bsh/tools/collide/report.h>
#include <pcl_bsh/tools/collide/summary.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/selected_records.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/poses/pose_fit.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/distance_report.h>
#include <pcl_bsh/io/reports/report_origin.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/search/cloud_view.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using cli::Keep, cli::Scan;
using Options = cli::CollideOptions;

constexpr auto program = cli::collide_program;

pcl::PCLPointCloud2 marked(const fs::path& path, const pcl::PCLPointCloud2& cloud, const std::vector<NewField>& fields)
{
  try {
    return withFields(cloud, fields);
  }
  catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path.string() + ": " + error.what());
  }
}

/// What the output gets beside all the input had. @param distances as it tells them
std::vector<NewField> newFields(const Options& options, const TrajectoryResult& found,
                                const std::vector<float>& distances)
{
  std::vector<NewField> fields;
  if (options.tellsContacts())
    fields = fieldsOf(found);
  else if (options.keep == Keep::flagged)
    fields.push_back({collision_field_name, &found.flags});
  if (options.distances) fields.push_back({distance_field_name, &distances});
  return fields;
}

/// The input's points that are wanted, as one row.
pcl::PCLPointCloud2 select(const pcl::PCLPointCloud2& cloud, const PointsView& view,
                           const std::vector<Verdict>& collides, Keep keep)
{
  pcl::Indices kept;
  for (std::size_t i = 0; i < view.count; ++i) {
    const bool finite = isFinite(view.point(static_cast<std::uint32_t>(i)));
    const bool free = collides[i] == Verdict::free;
    if (keep == Keep::colliding ? free : !free || !finite) continue;
    kept.push_back(static_cast<pcl::index_t>(i));
  }
  return selectedRecords(cloud, kept);
}

void write(const Options& options, const Scan& input, const Answer& answer, double& seconds)
{
  cli::Step step("Writing " + options.output.string());
  const TrajectoryResult& found = answer.collisions;
  if (input.shape.isSurface()) {
    seconds += step.done(counted(cli::writeSurface(options, input, answer), "triangle"));
    return;
  }
  const std::vector<double>& measured = answer.distances.a.distance;
  const std::vector<float> distances(measured.begin(), measured.end());
  pcl::PCLPointCloud2 cloud;
  if (options.keep == Keep::flagged || options.distances)
    cloud = marked(options.input, input.cloud(), newFields(options, found, distances));
  if (options.keep != Keep::flagged)
    cloud = select(options.distances ? cloud : input.cloud(), viewOf(input.cloud()), found.flags, options.keep);
  io::writeCloud(options.output, cloud, input.facts.viewpoint, input.facts.las);
  seconds += step.done(counted(std::size_t{cloud.width} * cloud.height, "point"));
}

/// Asks as a step of the program. @param done of the answer, for the step's end
template <typename Done>
Answer askInStep(const std::string& what, Question question, Shape& input, Shape& obstacle, double& seconds,
                 const Done& done)
{
  cli::Step step(what);
  question.progress = [&](double fraction) {
    step.share(fraction);
    return true;
  };
  Answer answer = ask(question, input, obstacle);
  seconds += step.done(done(answer));
  return answer;
}

/// What collides first, then all distances: each tells how long it takes.
void answer(Shape& input, Shape& obstacle, bool lists_clashes, cli::CollisionReport& report)
{
  Question question = report.question;
  Wanted& wanted = question.wanted;
  const Wanted all = wanted;
  wanted.distances = wanted.both_ways = false;
  wanted.unseen_places = question.seen && lists_clashes;
  wanted.spacings = !all.measures(); // at last, for it builds voxels
  report.answer = askInStep(question.path ? "Following " + counted(question.path->size(), "pose") : "Comparing",
                            question, input, obstacle, report.seconds.query, [](const Answer& found) {
                              return std::to_string(found.collisions.colliding) + " colliding";
                            });
  if (!all.measures()) return;
  wanted = {};
  question.seen = false; // that is answered
  leaveOutWaiting(question);
  wanted.distances = wanted.both_ways = wanted.spacings = true;
  Answer measured =
      askInStep("Measuring distances", question, input, obstacle, report.seconds.distances, [&](const Answer& found) {
        return counted(found.distances.a.measured, input.isSurface() ? "triangle" : "point");
      });
  report.answer.distances = std::move(measured.distances);
  report.answer.density = measured.density;
  for (Warning& warning : measured.warnings) report.answer.warnings.push_back(std::move(warning));
  report.answer.work += measured.work;
}

io::ClashQuestion clashQuestion(const Options& options)
{
  return {options.question, options.input.string(), options.obstacle.string()};
}

/// @return how many there are
std::string listClashes(const Options& options, const SphereHierarchy& a, const SphereHierarchy& b,
                        const std::optional<io::ClashList>& earlier, cli::CollisionReport& report)
{
  cli::Step step("Listing clashes");
  const io::ClashQuestion question = clashQuestion(options);
  const double distance = options.cluster_distance > 0
                              ? options.cluster_distance
                              : io::clusterDistanceFor(*question.clearance, *report.answer.density.input);
  const std::vector<Eigen::Isometry3d> poses = report.question.poses();
  io::ClashReport list =
      io::clashesOf(question, a, b, poses, report.answer, distance, report.surface ? &*report.surface : nullptr);
  list.unit = report.unit;
  list.coordinate_system = report.coordinate_system;
  if (earlier)
    for (std::string& warning : io::compareWithList(list, *options.previous, *earlier, a, b))
      report.warnings.push_back(std::move(warning));
  for (const fs::path& file : options.clashes) io::writeClashes(file, list);
  report.seconds.clashes = step.done(io::clashCounts(list));
  return io::clashCounts(list);
}

std::optional<io::ClashList> readEarlier(const Options& options, std::vector<std::string>& warnings)
{
  if (!options.previous) return std::nullopt;
  io::ClashList list = io::readClashes(*options.previous);
  for (std::string& warning : io::requireComparable(*options.previous, list, clashQuestion(options)))
    warnings.push_back(std::move(warning));
  return list;
}

std::optional<io::DistanceReport> reportDistances(const Options& options, const SphereHierarchy& a,
                                                  const SphereHierarchy& b, const cli::CollisionReport& found)
{
  if (!options.distances) return std::nullopt;
  PointDistancesRequest request;
  request.max_distance = options.question.max_distance.value_or(request.max_distance);
  request.accuracy = options.question.accuracy;
  const io::DistanceQuestion question = {options.input.string(),
                                         options.obstacle.string(),
                                         found.unit,
                                         request,
                                         std::nullopt,
                                         found.surface ? &*found.surface : nullptr,
                                         options.question.solid,
                                         found.coordinate_system};
  io::DistanceReport report = io::reportOf(question, {a}, {b, options.question.pose}, found.answer.distances);
  if (options.distance_page) io::writeDistances(*options.distance_page, report);
  return report;
}

/// Refuses what can be refused before the first cloud is loaded.
/// @throws std::invalid_argument, UsageError or files::FileError naming the option and the value
void check(const Options& options, const Question& question)
{
  cli::requireAccepted(question, options.names_of_poses);
  io::requireWritableCloud(options.output);
  if (options.obstacle_out && (question.vertices_only || !io::mayHaveFaces(options.obstacle)))
    io::requireWritableCloud(*options.obstacle_out); // of what may be a surface, once that is known
  if (options.report) files::requireWritable(*options.report);
  if (!options.poses_out.empty()) files::requireWritable(options.poses_out);
  for (const fs::path& list : options.clashes) {
    try {
      io::requireClashFormat(list);
    }
    catch (const files::FileError& error) {
      throw cli::UsageError(std::string("--clashes: ") + error.what());
    }
    files::requireWritable(list);
  }
  if (options.distances) io::reportDate(); // refuses one that is none before anything is done
  if (!options.distance_page) return;
  if (options.distance_page->extension() != ".html")
    throw cli::UsageError("--distance-page: " + options.distance_page->string() +
                          ": is no page for browsers: name a .html file");
  files::requireWritable(*options.distance_page);
}

/// From two things to all that is told of them.
int tell(const Options& options, const Scan& input, Shape& scan, const io::Obstacle& obstacle,
         const io::CloudFacts& facts_of_obstacle, const std::optional<io::ClashList>& earlier,
         cli::CollisionReport& report)
{
  const Question& question = report.question;
  Shape other = obstacle.shape(options.obstacle.string());
  const auto built = [&](Shape& shape, const Uncertainty& uncertainty) -> const SphereHierarchy& {
    return cli::build(shape, uncertainty, question.threads, report.seconds.build);
  };
  scan.ignore(question.ignore_points);
  other.ignore(question.obstacle_ignore_points);
  const SphereHierarchy& a = built(scan, question.uncertaintyOfInput());
  const SphereHierarchy& b = built(other, question.uncertaintyOfObstacle());
  report.input = {options.input.string(), a.view().count, a.size()};
  report.obstacle = {options.obstacle.string(), b.view().count, b.size()};
  if (scan.counted()) report.input.ignored = scan.counted()->all;
  if (other.counted()) report.obstacle.ignored = other.counted()->all;
  report.input_is_surface = scan.isSurface();
  if (obstacle.isSurface()) {
    report.surface = obstacle;
    const PointsView vertices = viewOf(obstacle.points());
    report.obstacle.points = vertices.count;
    report.obstacle.finite = SphereHierarchy(vertices).size();
  }
  answer(scan, other, !options.clashes.empty(), report);
  report.voxels_total = a.statistics().voxels + b.statistics().voxels;
  for (const std::string& remark : input.facts.remarks)
    addOnce(options.input.string() + ": " + remark, report.warnings);
  addTexts(report.answer.warnings, report.warnings);
  for (std::string& remark : cli::warningsOf(obstacle, options.obstacle)) addOnce(std::move(remark), report.warnings);

  write(options, input, report.answer, report.seconds.write);
  if (options.obstacle_out) {
    cli::Step step("Writing " + options.obstacle_out->string());
    cli::writeFlags(*options.obstacle_out, obstacle, report.answer.obstacle_flags, facts_of_obstacle);
    report.seconds.write += step.done(counted(obstacle.view().count, obstacle.partName()));
  }
  const std::string clashes = options.clashes.empty() ? "" : listClashes(options, a, b, earlier, report);
  const std::optional<io::DistanceReport> measured = reportDistances(options, a, b, report);
  if (measured) report.distances = io::distanceJson(*measured);
  if (options.report) cli::writeReport(*options.report, report);
  summarise(options, report, clashes, measured);
  return 0;
}

int collide(Options options)
{
  options.files.requireApart();
  cli::CollisionReport report;
  report.warnings = options.warnings;
  Question& question = report.question = options.question;
  if (!options.trajectory.empty()) question.path = io::readPoses(options.trajectory, &report.warnings);
  check(options, question);
  const std::optional<io::ClashList> earlier = readEarlier(options, report.warnings);

  const Scan input = loadInput(options, report.seconds.load);
  report.coordinate_system = input.facts.coordinate_system;
  report.unit = options.reading.unitOfReports(options.unit, input.facts.unit);
  if (question.seen && question.origin.empty()) question.origin = io::originsOf(input.cloud(), input.facts);
  Shape scan = input.shape.shape(options.input.string());
  if (!scan.isSurface() && (options.keep == Keep::flagged || options.distances))
    marked(options.input, withoutRecords(input.cloud()), newFields(options, {}, {})); // fails now
  io::CloudFacts facts;                                                               // of the obstacle
  const io::Obstacle obstacle = cli::loadObstacle(
      options.obstacle, {question.vertices_only}, report.seconds.load,
      options.reading.ofObstacle(options.obstacle, input.facts.unit, question.obstacle_uncertainty.field), &facts,
      question.threads);
  if (!options.reading.namesUnits() && input.facts.unit && facts.unit && facts.unit != input.facts.unit) {
    const std::string unit = io::nameOf(*input.facts.unit);
    report.warnings.push_back(options.obstacle.string() + ": is in " + io::nameOf(*facts.unit) + ", and " +
                              options.input.string() + " in " + unit +
                              ", by their coordinate systems: give --input-unit " + unit + " to convert it");
  }
  if (options.obstacle_out) cli::requireWritableFlags(*options.obstacle_out, obstacle);
  if (!options.pairs.empty()) {
    const io::PoseFit fit = io::readPoseFit(options.pairs, facts.scale);
    report.warnings.push_back("--pairs: " + options.pairs.string() + ": " + fit.text());
    options.question.pose = question.pose = fit.pose;
  }
  if (!options.poses_out.empty()) io::writePoses(options.poses_out, question.poses());
  return cli::named([&] { return tell(options, input, scan, obstacle, facts, earlier, report); }, question,
                    options.names_of_poses);
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, [&] {
    const std::optional<Options> options = cli::parseCollideOptions(argc, argv);
    return options ? collide(*options) : 0;
  });
}
