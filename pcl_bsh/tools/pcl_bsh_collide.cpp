// SPDX-License-Identifier: BSD-3-Clause
// Which points of a cloud collide with an obstacle, at a pose or along a path? From two files to a third, with reports.
#include <pcl_bsh/tools/cli/obstacle.h>
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/collide/checks.h>
#include <pcl_bsh/tools/collide/loading.h>
#include <pcl_bsh/tools/collide/options.h>
#include <pcl_bsh/tools/collide/report.h>
#include <pcl_bsh/tools/collide/summary.h>
#include <pcl_bsh/tools/collide/surface_input.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/selected_records.h>
#include <pcl_bsh/filters/surface_distances.h>
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/distance_report.h>
#include <pcl_bsh/neighbors/patch_spacings.h>
#include <pcl_bsh/question/warnings.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using cli::Keep, cli::Scan;
using Options = cli::CollideOptions;

constexpr auto program = cli::collide_program;

/// From a query about the balls to what users asked: about the triangles.
TrajectoryResult ofInput(const SurfaceCover* cover, TrajectoryResult found, cli::CollisionReport& report)
{
  if (!cover) return found;
  found = ofTriangles(*cover, std::move(found));
  report.input_surface = cover->tolerance;
  report.undecided = found.undecided;
  tellOfSurface(cover->tolerance, report.closest);
  if (report.closest.pair) report.closest.pair->a = cover->triangles[report.closest.pair->a];
  if (report.path) report.path->table.clear(); // it counts balls
  return found;
}

pcl::PCLPointCloud2 marked(const fs::path& path, const pcl::PCLPointCloud2& cloud, const std::vector<NewField>& fields)
{
  try {
    return withFields(cloud, fields);
  }
  catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path.string() + ": " + error.what());
  }
}

/// The distance of every point, of both clouds, and that of the input's as the output tells it.
struct Distances {
  SymmetricDistances found;
  std::vector<float> field;
};

/// What the output gets beside all the input had.
std::vector<NewField> newFields(const Options& options, const TrajectoryResult& found, const Distances& distances)
{
  const bool all = options.moves() && !options.accuracy.stopsEarly();
  std::vector<NewField> fields;
  if (all)
    fields = fieldsOf(found);
  else if (options.keep == Keep::flagged)
    fields.push_back({collision_field_name, &found.flags});
  if (options.distances) fields.push_back({distance_field_name, &distances.field});
  return fields;
}

/// The input's points that are wanted, as one row.
pcl::PCLPointCloud2 select(const pcl::PCLPointCloud2& cloud, const PointsView& view,
                           const std::vector<std::uint8_t>& collides, Keep keep)
{
  pcl::Indices kept;
  for (std::size_t i = 0; i < view.count; ++i) {
    const bool finite = isFinite(view.point(static_cast<std::uint32_t>(i)));
    if (keep == Keep::colliding ? collides[i] == 0 : (collides[i] != 0 || !finite)) continue;
    kept.push_back(static_cast<pcl::index_t>(i));
  }
  return selectedRecords(cloud, kept);
}

void write(const Options& options, const Scan& input, const TrajectoryResult& found, const Distances& distances,
           double& seconds)
{
  cli::Step step("Writing " + options.output.string());
  if (!input.triangles.empty()) {
    const std::size_t written =
        cli::writeSurface(options, {input.cloud, input.triangles}, input.facts.viewpoint, found);
    seconds += step.done(counted(written, "triangle"));
    return;
  }
  pcl::PCLPointCloud2 cloud;
  if (options.keep == Keep::flagged || options.distances)
    cloud = marked(options.input, input.cloud, newFields(options, found, distances));
  if (options.keep != Keep::flagged)
    cloud = select(options.distances ? cloud : input.cloud, viewOf(input.cloud), found.flags, options.keep);
  io::writeCloud(options.output, cloud, input.facts.viewpoint, input.facts.las);
  seconds += step.done(counted(std::size_t{cloud.width} * cloud.height, "point"));
}

/// Of the density guard; none where it is not asked for, or the obstacle has no two places.
std::vector<float> guardedSpacings(const Options& options, const SphereHierarchy& obstacle,
                                   cli::CollisionReport& report)
{
  if (!options.density) return {};
  if (report.surface) {
    report.warnings.push_back(report.obstacle.file + ": is a surface, which has no holes: --density guards nothing");
    return {};
  }
  report.widest_gap = options.widest_gap > 0 ? options.widest_gap : usualGap(obstacle);
  return report.widest_gap > 0 ? patchSpacings(obstacle, report.widest_gap, options.threads) : std::vector<float>();
}

/// From the records of a query to what users know of the obstacle.
void nameParts(cli::CollisionReport& report)
{
  if (report.surface && report.closest.pair) report.closest.pair->b = report.surface->partOf(report.closest.pair->b);
}

/// At one pose, without a list of clashes: flags, and the smallest distance however large.
TrajectoryResult atPose(const Options& options, const SphereHierarchy& a, const SphereHierarchy& b,
                        cli::CollisionReport& report)
{
  cli::Step query("Comparing");
  FlagsRequest request;
  request.clearance = options.clearance;
  request.threads = options.threads;
  request.accuracy = options.accuracy;
  const std::vector<float> spacings = guardedSpacings(options, b, report);
  if (!spacings.empty()) request.spacings_of_b = spacings.data();
  FlagsResult flags = collisionFlags({a}, {b, options.pose}, request);
  report.closest = closestPair({a}, {b, options.pose}, {options.accuracy});
  if (report.surface) tellOfSurface(report.surface->tolerance(), report.closest);
  nameParts(report);
  report.seconds.query = query.done(std::to_string(flags.colliding_a) + " colliding");
  report.work = flags.work;
  report.work += report.closest.work;
  report.undecided = flags.undecided_a;
  report.sparse = flags.sparse_a;
  TrajectoryResult found;
  found.flags = std::move(flags.a);
  found.colliding = flags.colliding_a;
  return found;
}

/// Of all colliding points, that of the smallest distance.
DistanceResult closestOf(const TrajectoryResult& found)
{
  DistanceResult closest;
  for (std::size_t i = 0; i < found.distance.size(); ++i) {
    const double distance = static_cast<double>(found.distance[i]);
    if (!(distance < closest.distance)) continue;
    closest.distance = distance;
    closest.pair = PointPair{static_cast<std::uint32_t>(i), found.closest_point[i]};
  }
  return closest;
}

TrajectoryResult alongPath(const Options& options, const std::vector<Eigen::Isometry3d>& poses,
                           const SphereHierarchy& a, const SphereHierarchy& b, cli::CollisionReport& report)
{
  cli::Step query("Following " + counted(poses.size(), "pose"));
  TrajectoryRequest request;
  request.clearance = options.clearance;
  request.accuracy = options.accuracy;
  const bool all = !request.accuracy.stopsEarly(); // that leaves times and distances open
  request.distances = request.first_poses = request.closest_poses = all;
  request.swept = options.swept;
  request.pose_summaries = all && !options.swept; // swept motion is of what lies between poses
  request.threads = options.threads;
  request.progress = [&](double fraction) {
    query.share(fraction);
    return true;
  };
  TrajectoryResult found = collideAlong({a}, b, poses, request);
  report.seconds.query = query.done(std::to_string(found.colliding) + " colliding");
  report.work = found.work;
  report.undecided = found.undecided;
  if (report.surface) tellOfSurface(found);
  report.closest = closestOf(found);
  nameParts(report);
  if (options.moves()) report.path = cli::PathReport{poses.size(), options.swept, found.poses, found.first_contact};
  return found;
}

/// @param cover of the input, where it is a surface
void warnOfQuestion(const Options& options, const std::vector<Eigen::Isometry3d>& poses, const SphereHierarchy& a,
                    const SurfaceCover* cover, const SphereHierarchy& b, const io::Obstacle& obstacle,
                    cli::CollisionReport& report)
{
  const SurfaceCover* const surface = report.surface ? report.surface->cover().get() : nullptr;
  Question question{namedCloud(options.input.string(), a, cover), namedCloud(options.obstacle.string(), b, surface),
                    poses, options.asks_collisions ? std::optional(options.clearance) : std::nullopt};
  question.input.spacing = report.density.input;
  question.obstacle.spacing = report.density.obstacle;
  addTexts(warningsOf(question), report.warnings);
  for (std::string& remark : cli::warningsOf(obstacle, options.obstacle)) addOnce(std::move(remark), report.warnings);
}

io::ClashQuestion clashQuestion(const Options& options)
{
  return {options.input.string(), options.obstacle.string(), options.clearance,           options.swept,
          options.accuracy,       options.input_uncertainty, options.obstacle_uncertainty};
}

/// @return how many there are
std::string listClashes(const Options& options, const std::vector<Eigen::Isometry3d>& poses, const SphereHierarchy& a,
                        const SphereHierarchy& b, const TrajectoryResult& found,
                        const std::optional<io::ClashList>& earlier, cli::CollisionReport& report)
{
  cli::Step step("Listing clashes");
  const double distance = options.cluster_distance > 0
                              ? options.cluster_distance
                              : io::clusterDistanceFor(options.clearance, *report.density.input);
  io::ClashReport list{.question = clashQuestion(options),
                       .cluster_distance = distance,
                       .clashes = findClashes(a.view(), found, distance),
                       .scan = a.view(),
                       .model = b.view(),
                       .poses = poses,
                       .found = found,
                       .survey = {poses, extentOf(a.view())},
                       .unit = options.unit,
                       .coordinate_system = report.coordinate_system,
                       .surface = report.surface ? &*report.surface : nullptr};
  if (earlier) {
    TrajectoryRequest motion;
    motion.swept = options.swept;
    motion.threads = options.threads;
    for (std::string& warning : io::compareWithList(list, *options.previous, *earlier, [&](FormerPlaces& former) {
           former.visit(b, poses, motion);
           former.scan(a.view());
         }))
      report.warnings.push_back(std::move(warning));
  }
  for (const fs::path& file : options.clashes) io::writeClashes(file, list);
  report.seconds.clashes = step.done(io::clashCounts(list));
  return io::clashCounts(list);
}

std::vector<Eigen::Isometry3d> posesOf(const Options& options, std::vector<std::string>& warnings)
{
  if (!options.trajectory.empty()) return io::readPoses(options.trajectory, &warnings);
  return options.path.empty() ? std::vector{options.pose} : options.path;
}

std::optional<io::ClashList> readEarlier(const Options& options, std::vector<std::string>& warnings)
{
  if (!options.previous) return std::nullopt;
  io::ClashList list = io::readClashes(*options.previous);
  for (std::string& warning : io::requireComparable(*options.previous, list, clashQuestion(options)))
    warnings.push_back(std::move(warning));
  return list;
}

PointDistancesRequest distancesRequest(const Options& options)
{
  PointDistancesRequest request;
  request.max_distance = options.distances->most;
  request.accuracy = options.accuracy;
  request.threads = options.threads;
  return request;
}

Distances measure(const Options& options, const SphereHierarchy& a, const SphereHierarchy& b,
                  cli::CollisionReport& report)
{
  cli::Step step("Measuring distances");
  PointDistancesRequest request = distancesRequest(options);
  request.progress = [&](double fraction) {
    step.share(fraction);
    return true;
  };
  Distances distances;
  distances.found = symmetricDistances({a}, {b, options.pose}, request);
  if (report.surface) tellOfSurface(report.surface->tolerance(), distances.found);
  distances.field.assign(distances.found.a.distance.begin(), distances.found.a.distance.end());
  report.work += distances.found.a.work;
  report.work += distances.found.b.work;
  report.seconds.distances = step.done(counted(distances.found.a.measured, "point"));
  return distances;
}

std::optional<io::DistanceReport> reportDistances(const Options& options, const SphereHierarchy& a,
                                                  const SphereHierarchy& b, const Distances& distances,
                                                  const cli::CollisionReport& found)
{
  if (!options.distances) return std::nullopt;
  const io::DistanceQuestion question = {options.input.string(), options.obstacle.string(),
                                         options.unit,           distancesRequest(options),
                                         std::nullopt,           found.surface ? &*found.surface : nullptr,
                                         found.coordinate_system};
  io::DistanceReport report = io::reportOf(question, {a}, {b, options.pose}, distances.found);
  if (options.distances->page) io::writeDistances(*options.distances->page, report);
  return report;
}

int collide(const Options& options)
{
  check(options);
  cli::CollisionReport report;
  report.warnings = options.warnings;
  const std::vector<Eigen::Isometry3d> poses = posesOf(options, report.warnings);
  const std::optional<io::ClashList> earlier = readEarlier(options, report.warnings);
  report.clearance = options.clearance;
  report.accuracy = options.accuracy;
  report.input_uncertainty = options.input_uncertainty;
  report.obstacle_uncertainty = options.obstacle_uncertainty;

  const Scan input = loadInput(options, report.seconds.load);
  report.coordinate_system = input.facts.coordinate_system;
  const std::shared_ptr<const SurfaceCover> cover = coverOf(options, input, report.seconds.load, report.warnings);
  if (!cover && (options.keep == Keep::flagged || options.distances))
    marked(options.input, withoutRecords(input.cloud), newFields(options, {}, {})); // fails now
  const io::Obstacle obstacle =
      cli::loadObstacle(options.obstacle, options.surface, options.clearance, report.seconds.load,
                        options.columns.of(options.obstacle), nullptr, options.threads);
  cli::requireLength(obstacle, options.obstacle, options.obstacle_uncertainty);
  const auto a = cli::build(cover ? cover->view() : viewOf(input.cloud), input.cloud.fields, options.input,
                            options.input_uncertainty, options.threads, report.seconds.build);
  const auto b = cli::build(obstacle.view(), obstacle.points().fields, options.obstacle, options.obstacle_uncertainty,
                            options.threads, report.seconds.build);
  report.input = {options.input.string(), a.view().count, a.size()};
  report.obstacle = {options.obstacle.string(), b.view().count, b.size()};
  if (cover) report.input.points = report.input.finite = input.triangles.size();
  if (obstacle.isSurface()) {
    report.surface = obstacle;
    const PointsView vertices = viewOf(obstacle.points());
    report.obstacle.points = vertices.count;
    report.obstacle.finite = SphereHierarchy(vertices).size();
  }

  const bool by_place = options.moves() || !options.clashes.empty();
  const TrajectoryResult found =
      ofInput(cover.get(), by_place ? alongPath(options, poses, a, b, report) : atPose(options, a, b, report), report);
  const Distances distances = options.distances ? measure(options, a, b, report) : Distances();
  if (!cover) report.density.input = spacingOf(a);
  if (!report.surface) report.density.obstacle = spacingOf(b);
  report.colliding = found.colliding;
  report.voxels_total = a.statistics().voxels + b.statistics().voxels;
  for (const std::string& remark : input.facts.remarks)
    addOnce(options.input.string() + ": " + remark, report.warnings);
  warnOfQuestion(options, poses, a, cover.get(), b, obstacle, report);

  write(options, input, found, distances, report.seconds.write);
  std::string clashes;
  if (!options.clashes.empty()) clashes = listClashes(options, poses, a, b, found, earlier, report);
  const std::optional<io::DistanceReport> measured = reportDistances(options, a, b, distances, report);
  if (measured) report.distances = io::distanceJson(*measured);
  if (options.report) cli::writeReport(*options.report, report);
  summarise(options, report, clashes, measured);
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, [&] {
    const std::optional<Options> options = cli::parseCollideOptions(argc, argv);
    return options ? collide(*options) : 0;
  });
}
