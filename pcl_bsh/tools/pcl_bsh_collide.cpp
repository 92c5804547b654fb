// SPDX-License-Identifier: BSD-3-Clause
// Which points of a cloud collide with an obstacle, at a pose or along a path? From two files to a third, with reports.
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/obstacle.h>
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/question_options.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/collide/collide_options.h>
#include <pcl_bsh/tools/collide/collide_report.h>
#include <pcl_bsh/tools/collide/loading.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/poses/pose_fit.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/distance_report.h>
#include <pcl_bsh/io/reports/report_origin.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/question/obstacles.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/selected_records.h>

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

/// The fields that the output gets beside those of the input. @param distances one per point
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

/// Asks as a step of the program. @param ask answers a question. @param done makes the step's last text of the answer
template <typename Ask, typename Done>
auto askInStep(const std::string& what, Question question, double& seconds, const Ask& ask, const Done& done)
{
  cli::Step step(what);
  question.progress = [&](double fraction) { return step.share(fraction); };
  auto answer = ask(question);
  seconds += step.done(done(answer));
  return answer;
}

/// Asks for collisions first, then for all distances. Each step tells how long it takes.
/// @param ask returns the Answer to a question, about one obstacle or several together
template <typename Ask>
void answer(const Ask& ask, bool lists_clashes, cli::CollisionReport& report)
{
  Question question = report.question;
  Wanted& wanted = question.wanted;
  const Wanted all = wanted;
  wanted.distances = wanted.both_ways = false;
  wanted.unseen_places = question.seen && lists_clashes;
  wanted.spacings = !all.measures(); // measured last, because that builds voxels
  report.answer = askInStep(question.path ? "Following " + counted(question.path->size(), "pose") : "Comparing",
                            question, report.seconds.query, ask, [](const Answer& found) {
                              return std::to_string(found.collisions.colliding) + " colliding";
                            });
  if (!all.measures()) return;
  wanted = {};
  question.seen = false; // already answered
  leaveOutWaiting(question);
  wanted.distances = wanted.spacings = true;
  wanted.both_ways = all.both_ways;
  Answer measured = askInStep("Measuring distances", question, report.seconds.distances, ask, [&](const Answer& found) {
    return counted(found.distances.a.measured, report.input_is_surface ? "triangle" : "point");
  });
  report.answer.distances = std::move(measured.distances);
  report.answer.density = measured.density;
  for (Warning& warning : measured.warnings) report.answer.warnings.push_back(std::move(warning));
  report.answer.work += measured.work;
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
    io::requireWritableCloud(*options.obstacle_out); // a surface's file is checked once its format is known
  if (options.report) files::requireWritable(*options.report);
  if (!options.poses_out.empty()) files::requireWritable(options.poses_out);
  options.requireWritable();
  if (options.distances) io::reportDate(); // refuses a wrong SOURCE_DATE_EPOCH before anything is done
  if (!options.distance_page) return;
  if (options.distance_page->extension() != ".html")
    throw cli::UsageError("--distance-page: " + options.distance_page->string() +
                          ": is no page for browsers: name a .html file");
  files::requireWritable(*options.distance_page);
}

/// The listing of clashes, with the earlier list of --previous. @param warnings gets those of the comparison
/// @throws as io::ClashListing::readEarlier() does
io::ClashListing listingOf(const Options& options, const Question& question, std::vector<std::string>& warnings)
{
  io::ClashListing listing = {options.input.string()};
  if (options.cluster_distance > 0) listing.cluster_distance = options.cluster_distance;
  listing.previous = options.previous;
  std::vector<io::ComparedObstacle> obstacles;
  const auto add = [&](const std::string& name, const fs::path& file, const Question& asked) {
    obstacles.push_back({name, file.string()});
    obstacles.back().question = asked;
    return &obstacles.back();
  };
  if (options.obstacles.empty()) add("", options.obstacle, question);
  for (const cli::ObstacleChoice& one : options.obstacles)
    add(one.name, one.file, questionOf(question, one.placed(Shape())))->asked = one.asked;
  listing.readEarlier(obstacles, warnings);
  return listing;
}

/// Writes all files of --clashes, as a step of the program. @param hierarchies of the report's obstacles
/// @return how many clashes there are, in words
std::string listClashes(const Options& options, const SphereHierarchy& a,
                        const std::vector<const SphereHierarchy*>& hierarchies, io::ClashListing& listing,
                        cli::CollisionReport& report)
{
  cli::Step step("Listing clashes");
  listing.between = report.between;
  const io::ClashLists lists = listOf(listing, a, hierarchies, report.obstacles, report.answer, report.warnings);
  options.write(lists, report.warnings);
  report.seconds.clashes = step.done(io::clashCounts(lists));
  return io::clashCounts(lists);
}

/// Asks about the input and its obstacles, and writes all results.
int tell(const Options& options, const Scan& input, Shape& scan, io::ClashListing& listing,
         cli::CollisionReport& report)
{
  const Question& question = report.question;
  std::vector<io::ComparedObstacle>& all = report.obstacles;
  const bool several = report.haveNames();
  scan.ignore(question.ignore_points);
  const SphereHierarchy& a = cli::build(scan, question.uncertaintyOfInput(), question.threads, report.seconds.build);
  std::vector<PlacedShape> shapes;
  std::vector<const SphereHierarchy*> hierarchies;
  report.input = {options.input.string(), a.view().count, a.size()};
  if (scan.counted()) report.input.ignored = scan.counted()->all;
  report.input_is_surface = scan.isSurface();
  const IgnoredPairs ignored = options.ignoredPairs();
  for (std::size_t i = 0; i < all.size(); ++i) {
    shapes.push_back({all[i].loaded.shape(all[i].file)});
    if (several) shapes.back() = options.obstacles[i].placed(shapes.back().shape);
    shapes.back().ignores_input = several && (!all[i].asked || ignored.holds(kInputName, all[i].name));
    all[i].question = pcl_bsh::questionOf(question, shapes.back());
    shapes.back().shape.ignore(question.obstacle_ignore_points);
    const SphereHierarchy& b = cli::build(shapes.back().shape, all[i].question.uncertaintyOfObstacle(),
                                          question.threads, report.seconds.build);
    hierarchies.push_back(&b);
    report.obstacle = {all[i].file, b.view().count, b.size()};
    if (const auto& counted = shapes.back().shape.counted()) report.obstacle.ignored = counted->all;
    if (b.size() == 0 && several)
      shapes.back().shape = shapes.back().shape.named(all[i].name); // not by its file, which may have others
  }
  if (!several && all[0].loaded.isSurface()) {
    report.surface = all[0].loaded;
    const PointsView vertices = viewOf(all[0].loaded.points());
    report.obstacle.points = vertices.count;
    report.obstacle.finite = SphereHierarchy(vertices).size();
  }
  listing.unit = report.unit;
  listing.coordinate_system = report.coordinate_system;
  if (listing.kept) listing.keep(all, ignored, extentOf(a.view()), report.warnings);
  const auto ask_all = [&](const Question& asked) {
    ObstaclesAnswer found = io::askAbout(asked, scan, shapes, all);
    if (asked.wanted.collisions()) {
      report.closest_obstacle = found.closest;
      if (options.between) report.between = io::askBetween(asked, shapes, all, ignored);
    }
    return std::move(found.all);
  };
  answer(ask_all, !options.clashes.empty(), report);
  report.voxels_total = a.statistics().voxels;
  for (const SphereHierarchy* const b : hierarchies) report.voxels_total += b->statistics().voxels;
  for (const std::string& remark : input.facts.remarks)
    addOnce(options.input.string() + ": " + remark, report.warnings);
  addTexts(report.answer.warnings, report.warnings);
  for (const io::ComparedObstacle& one : all)
    for (std::string& remark : cli::warningsOf(one.loaded, one.file)) addOnce(std::move(remark), report.warnings);

  write(options, input, report.answer, report.seconds.write);
  if (options.obstacle_out) {
    cli::Step step("Writing " + options.obstacle_out->string());
    cli::writeFlags(*options.obstacle_out, all[0].loaded, report.answer.obstacle_flags, all[0].facts);
    report.seconds.write += step.done(counted(all[0].loaded.view().count, all[0].loaded.partName()));
  }
  const std::string clashes = options.clashes.empty() ? "" : listClashes(options, a, hierarchies, listing, report);
  const std::optional<io::DistanceReport> measured =
      several ? std::nullopt : reportDistances(options, a, *hierarchies[0], report);
  if (measured) report.distances = io::distanceJson(*measured);
  if (options.report) cli::writeJson(*options.report, toJson(report));
  summarise(options, report, clashes, measured);
  return 0;
}

/// A warning where it is not known whether both are in one coordinate system. @throws FileError where they are not
std::optional<std::string> warningOfSystems(const fs::path& input, const io::CloudFacts& of_input,
                                            const fs::path& obstacle, const io::CloudFacts& of_obstacle)
{
  try {
    const auto warning =
        io::requireOneSystem(input.string(), of_input.coordinate_system, of_obstacle.coordinate_system,
                             "transform both (--to-crs EPSG:25832, say), or give --obstacle-crs none where poses lead "
                             "from the one to the other");
    return warning ? std::optional(obstacle.string() + ": " + *warning) : std::nullopt;
  }
  catch (const io::FormatError& error) {
    throw files::FileError(obstacle, error.what(), error.remedy());
  }
}

int collide(Options options)
{
  options.files.requireApart();
  cli::CollisionReport report;
  report.warnings = options.warnings;
  Question& question = report.question = options.question;
  if (!options.trajectory.empty()) question.path = io::readPoses(options.trajectory, &report.warnings);
  check(options, question);
  io::ClashListing listing = listingOf(options, question, report.warnings);

  const Scan input = loadInput(options, report.seconds.load);
  report.coordinate_system = input.facts.coordinate_system.name;
  report.unit = options.reading.unitOfReports(options.unit, input.facts.unit);
  if (question.seen && question.origin.empty()) question.origin = io::originsOf(input.cloud(), input.facts);
  Shape scan = input.shape.shape(options.input.string());
  if (!scan.isSurface() && (options.keep == Keep::flagged || options.distances))
    marked(options.input, withoutRecords(input.cloud()), newFields(options, {}, {})); // fails before the query
  const auto warn_of = [&](const cli::ObstacleChoice& one, const io::CloudFacts& facts) {
    if (auto warning = warningOfSystems(options.input, input.facts, one.file, facts))
      report.warnings.push_back(std::move(*warning));
    if (options.reading.namesUnits() || one.unit || !input.facts.unit || !facts.unit || facts.unit == input.facts.unit)
      return;
    const std::string unit = io::nameOf(*input.facts.unit);
    report.warnings.push_back(one.file.string() + ": is in " + io::nameOf(*facts.unit) + ", and " +
                              options.input.string() + " in " + unit +
                              ", by their coordinate systems: give --input-unit " + unit + " to convert it");
  };
  std::vector<cli::ObstacleChoice> choices = options.obstacles;
  if (choices.empty()) choices.push_back({"", options.obstacle});
  std::vector<cli::LoadedObstacle> loaded = cli::loadObstacles(
      choices, question, {options.reading, input.facts.unit, true, options.between}, report.seconds.load, warn_of);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    report.obstacles.push_back(
        {choices[i].name, choices[i].file.string(), std::move(loaded[i].obstacle), std::move(loaded[i].facts)});
    report.obstacles.back().asked = choices[i].asked;
  }
  if (options.obstacle_out) cli::requireWritableFlags(*options.obstacle_out, report.obstacles[0].loaded);
  if (!options.pairs.empty()) {
    const io::PoseFit fit = io::readPoseFit(options.pairs, report.obstacles[0].facts.scale);
    report.warnings.push_back("--pairs: " + options.pairs.string() + ": " + fit.text());
    options.question.pose = question.pose = fit.pose;
  }
  if (!options.poses_out.empty()) io::writePoses(options.poses_out, question.poses());
  return cli::named([&] { return tell(options, input, scan, listing, report); }, question, options.names_of_poses);
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, cli::parseCollideOptions, collide, argc, argv);
}
