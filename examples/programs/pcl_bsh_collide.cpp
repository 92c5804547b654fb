// SPDX-License-Identifier: BSD-3-Clause
// Which points of a cloud collide with an obstacle, at a pose or along a path? From two files to a third, with reports.
#include "cli/program.h"
#include "cli/step.h"
#include "collide/options.h"
#include "collide/report.h"
#include "collide/surface_input.h"

#include <pcl_bsh/collision/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/filters/cloud_files/obstacle.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/pose_files/pose_file.h>
#include <pcl_bsh/filters/reports/clash_report.h>
#include <pcl_bsh/filters/reports/distance_report.h>
#include <pcl_bsh/filters/selected_records.h>
#include <pcl_bsh/filters/surface_distances.h>
#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/neighbors/patch_spacings.h>
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
using cli::Keep, cli::UsageError;
using Options = cli::CollideOptions;

constexpr auto program = cli::collide_program;

struct Scan {
  pcl::PCLPointCloud2 cloud;
  std::vector<Triangle> triangles; ///< where the input has faces: these are asked about
  io::Viewpoint viewpoint = io::no_viewpoint;
  io::LasHeaderPtr las;
};

/// The core names what is wrong with a request; users know it by the option.
template <typename Ask>
void requireAccepted(const char* option, const Ask& ask)
{
  try {
    ask(SphereHierarchy{PointsView{}});
  }
  catch (const InvalidInput& error) {
    throw std::invalid_argument(std::string(option) + ": " + error.advice());
  }
}

void requireClashFormat(const fs::path& list)
{
  try {
    io::requireClashFormat(list);
  }
  catch (const files::FileError& error) {
    throw UsageError(std::string("--clashes: ") + error.what());
  }
}

void requireDistancePage(const fs::path& page)
{
  if (page.extension() != ".html")
    throw UsageError("--distance-page: " + page.string() + ": is no page for browsers: name a .html file");
  files::requireWritable(page);
}

/// Checks all that can be checked before the first cloud is loaded.
void check(const Options& options)
{
  options.files.requireApart();
  requireAccepted("--clearance", [&](const SphereHierarchy& nothing) {
    anyCollision({nothing}, {nothing}, {options.clearance, options.accuracy});
  });
  requireAccepted("--pose", [&](const SphereHierarchy& nothing) {
    anyCollision({nothing}, {nothing, options.pose}, {});
  });
  if (!options.path.empty()) {
    requireAccepted("--from", [&](const SphereHierarchy& nothing) {
      anyCollision({nothing}, {nothing, options.path.front()}, {});
    });
    requireAccepted("--to", [&](const SphereHierarchy& nothing) {
      anyCollision({nothing}, {nothing, options.path.back()}, {});
    });
  }
  if (options.swept) {
    requireAccepted("--swept", [&](const SphereHierarchy& nothing) {
      TrajectoryRequest request;
      request.swept = options.swept;
      collideAlong({nothing}, nothing, {Eigen::Isometry3d::Identity()}, request);
    });
  }
  io::requireWritableCloud(options.output);
  if (options.report) files::requireWritable(*options.report);
  for (const fs::path& list : options.clashes) {
    requireClashFormat(list);
    files::requireWritable(list);
  }
  if (options.distances && options.distances->page) requireDistancePage(*options.distances->page);
}

Scan loadInput(const Options& options, double& seconds)
{
  cli::Step step("Loading " + options.input.string());
  Scan scan;
  if (options.surface.vertices_only) {
    scan.cloud = io::readCloud(options.input, &scan.viewpoint, &scan.las);
  }
  else {
    io::Mesh mesh = io::readMesh(options.input, &scan.viewpoint, &scan.las);
    scan.cloud = std::move(mesh.vertices);
    scan.triangles = std::move(mesh.triangles);
  }
  const std::string triangles =
      scan.triangles.empty() ? "" : ", " + std::to_string(scan.triangles.size()) + " triangles";
  seconds += step.done(std::to_string(std::size_t{scan.cloud.width} * scan.cloud.height) + " points" + triangles);
  return scan;
}

/// The balls of the input's surface; none where it is points.
std::shared_ptr<const SurfaceCover> coverOf(const Options& options, const Scan& input, double& seconds)
{
  if (input.triangles.empty()) return nullptr;
  cli::requireForSurface(options);
  cli::Step step("Covering " + options.input.string());
  auto cover = std::make_shared<const SurfaceCover>(cli::coverInput(
      options.input, {input.cloud, input.triangles}, options.surface, options.clearance, [&](double fraction) {
        step.share(fraction);
        return true;
      }));
  seconds += step.done(std::to_string(cover->centers.size()) + " balls");
  return cover;
}

/// From a query about the balls to what users asked: about the triangles.
TrajectoryResult ofInput(const SurfaceCover* cover, TrajectoryResult found, cli::CollisionReport& report)
{
  if (!cover) return found;
  found = cli::ofTriangles(*cover, std::move(found));
  report.input_surface = cover->tolerance;
  report.undecided = found.undecided;
  tellOfSurface(cover->tolerance, report.closest);
  if (report.closest.pair) report.closest.pair->a = cover->triangles[report.closest.pair->a];
  if (report.path) report.path->table.clear(); // it counts balls
  return found;
}

/// Its cloud or, where the file has faces, its surface.
io::Obstacle loadObstacle(const Options& options, double& seconds)
{
  cli::Step step("Loading " + options.obstacle.string());
  io::Obstacle obstacle = io::readObstacle(options.obstacle, options.surface, options.clearance, [&](double fraction) {
    step.share(fraction);
    return true;
  });
  const pcl::PCLPointCloud2& points = obstacle.points();
  std::string result = std::to_string(std::size_t{points.width} * points.height) + " points";
  if (obstacle.isSurface()) {
    result += ", " + std::to_string(obstacle.triangles()->size()) + " triangles in " +
              std::to_string(obstacle.cover()->centers.size()) + " balls";
  }
  seconds += step.done(result);
  return obstacle;
}

/// A field of sigmas is one of points.
void requireLength(const io::Obstacle& obstacle, const fs::path& path, const Uncertainty& uncertainty)
{
  if (!obstacle.isSurface() || uncertainty.field.empty()) return;
  throw std::invalid_argument("--obstacle-uncertainty: " + uncertainty.field + ": " + path.string() +
                              " is a surface, which has no field: give a length, or --vertices-only");
}

SphereHierarchy build(const PointsView& points, const std::vector<pcl::PCLPointField>& fields, const fs::path& path,
                      const Uncertainty& uncertainty, unsigned threads, double& seconds)
{
  const PointsView view = withUncertainty(points, fields, path.string(), uncertainty);
  cli::Step step("Sorting " + path.string() + " into voxels");
  HierarchyOptions options;
  options.threads = threads;
  SphereHierarchy hierarchy(view, options);
  seconds += step.done(std::to_string(hierarchy.statistics().voxels) + " voxels");
  return hierarchy;
}

void warnOf(const cli::CloudReport& cloud, const SphereHierarchy& hierarchy, double clearance,
            std::vector<std::string>& warnings)
{
  if (cloud.finite == 0) warnings.push_back(cloud.file + ": has no finite point: nothing collides");
  if (cloud.finite > 0 && cloud.finite < cloud.points) {
    warnings.push_back(cloud.file + ": " + std::to_string(cloud.points - cloud.finite) +
                       " points are not finite: they collide with nothing");
  }
  const double spacing = hierarchy.coordinateSpacing();
  if (clearance > 0 && spacing > clearance / 10) {
    std::ostringstream warning;
    warning << cloud.file << ": its float32 coordinates lie " << spacing
            << " apart, coarse for this clearance: export float64 or coordinates near the origin";
    warnings.push_back(warning.str());
  }
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
    const std::size_t written = cli::writeSurface(options, {input.cloud, input.triangles}, input.viewpoint, found);
    seconds += step.done(std::to_string(written) + " triangles");
    return;
  }
  pcl::PCLPointCloud2 cloud;
  if (options.keep == Keep::flagged || options.distances)
    cloud = marked(options.input, input.cloud, newFields(options, found, distances));
  if (options.keep != Keep::flagged)
    cloud = select(options.distances ? cloud : input.cloud, viewOf(input.cloud), found.flags, options.keep);
  io::writeCloud(options.output, cloud, input.viewpoint, input.las);
  seconds += step.done(std::to_string(std::size_t{cloud.width} * cloud.height) + " points");
}

/// As sure as it is.
std::string distanceText(const cli::CollisionReport& report)
{
  std::ostringstream text;
  text << report.closest.distance;
  if (!report.accuracy.isProven()) return text.str() + " without proof";
  if (report.accuracy.isExact()) return text.str();
  if (report.path) return text.str() + " within the tolerance";
  text << " or less, certainly in [" << report.closest.interval.lower << ", " << report.closest.interval.upper << "]";
  return text.str();
}

/// With the unit, where it is known.
std::string distanceSummary(const io::DistanceReport& report)
{
  const auto length = [&](double value) {
    std::ostringstream text;
    if (std::isnan(value)) return std::string("unknown");
    text << value << (report.question.unit.empty() ? "" : " ") << report.question.unit;
    return text.str();
  };
  const DistanceStatistics& statistics = report.input.statistics;
  return "; distances of " + std::to_string(statistics.count) + " points: mean " + length(statistics.mean) + ", RMS " +
         length(statistics.rms) + ", median " + length(statistics.median) + ", greatest " + length(statistics.maximum) +
         "; Hausdorff distance " + length(report.hausdorff);
}

void summarise(const Options& options, const cli::CollisionReport& report, const std::vector<Clash>& clashes,
               const std::optional<io::DistanceReport>& distances)
{
  cli::warn(program, report.warnings);
  std::ostream& out = options.files.summary();
  out << report.colliding << " of " << report.input.points << (report.input_surface ? " triangles" : " points")
      << " collide";
  if (report.mayLeaveUndecided()) out << ", " << report.undecided << " are undecided";
  if (report.widest_gap > 0) out << ", " << report.sparse << " are not scanned densely enough";
  if (report.closest.pair) {
    out << "; smallest distance " << distanceText(report) << ", between "
        << (report.input_surface ? "triangle " : "point ") << report.closest.pair->a << " of the input and "
        << (report.surface ? report.surface->partName() : "point") << ' ' << report.closest.pair->b
        << " of the obstacle";
  }
  if (report.path) out << "; " << report.path->poses << " poses";
  if (report.path && report.path->first_contact) {
    out << "; first contact at pose "
        << static_cast<double>(report.path->first_contact->pose) + report.path->first_contact->fraction;
  }
  if (!options.clashes.empty()) {
    const auto resolved = std::count_if(clashes.begin(), clashes.end(),
                                        [](const Clash& clash) { return clash.status == ClashStatus::resolved; });
    out << "; " << clashes.size() - static_cast<std::size_t>(resolved) << " clashes";
    if (options.previous) out << ", " << resolved << " resolved";
  }
  if (distances) out << distanceSummary(*distances);
  if (report.surface) out << "; " << io::promiseOf(*report.surface, report.besideSurface());
  out << "; wrote " << options.output.string() << '\n';
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
  cli::Step query("Following " + std::to_string(poses.size()) + " poses");
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

void warnOfHoles(cli::CollisionReport& report)
{
  if (!report.density.couldHide(report.clearance)) return;
  std::ostringstream warning;
  warning << "points lie " << report.density.input.median << " apart in the input";
  if (report.density.obstacle) {
    warning << " and " << report.density.obstacle->median
            << " in the obstacle: surfaces may touch with no two points within the clearance of ";
  }
  else {
    warning << ": what was scanned may touch the obstacle with no point within the clearance of ";
  }
  warning << report.clearance << ": scan more densely, or give a clearance of " << report.density.blind()
          << " at least";
  report.warnings.push_back(warning.str());
}

std::vector<Clash> listClashes(const Options& options, const std::vector<Eigen::Isometry3d>& poses,
                               const SphereHierarchy& a, const SphereHierarchy& b, const TrajectoryResult& found,
                               const std::vector<Clash>& earlier, cli::CollisionReport& report)
{
  cli::Step step("Listing clashes");
  const double distance = options.cluster_distance > 0
                              ? options.cluster_distance
                              : io::clusterDistanceFor(options.clearance, report.density.input);
  io::ClashReport list{options.input.string(),
                       options.obstacle.string(),
                       report.clearance,
                       distance,
                       {},
                       findClashes(a.view(), found, distance),
                       a.view(),
                       b.view(),
                       poses,
                       found,
                       options.swept,
                       report.surface ? &*report.surface : nullptr};
  if (options.previous) {
    list.previous = options.previous->string();
    compareWithEarlier(list.clashes, earlier, distance);
  }
  for (const fs::path& file : options.clashes) io::writeClashes(file, list);
  report.seconds.clashes = step.done(std::to_string(list.clashes.size()) + " clashes");
  return list.clashes;
}

std::vector<Eigen::Isometry3d> posesOf(const Options& options, std::vector<std::string>& warnings)
{
  if (!options.trajectory.empty()) return io::readPoses(options.trajectory, &warnings);
  return options.path.empty() ? std::vector{options.pose} : options.path;
}

std::vector<Clash> readEarlier(const Options& options, std::vector<std::string>& warnings)
{
  if (!options.previous) return {};
  const io::ClashList list = io::readClashes(*options.previous);
  for (std::string& warning :
       io::requireComparable(*options.previous, list,
                             {options.input.string(), options.obstacle.string(), options.clearance, options.swept, {}}))
    warnings.push_back(std::move(warning));
  return list.clashes;
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
  report.seconds.distances = step.done(std::to_string(distances.found.a.measured) + " points");
  return distances;
}

std::optional<io::DistanceReport> reportDistances(const Options& options, const SphereHierarchy& a,
                                                  const SphereHierarchy& b, const Distances& distances,
                                                  const io::Obstacle* surface)
{
  if (!options.distances) return std::nullopt;
  const io::DistanceQuestion question = {options.input.string(),
                                         options.obstacle.string(),
                                         options.distances->unit,
                                         distancesRequest(options),
                                         std::nullopt,
                                         surface};
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
  const std::vector<Clash> earlier = readEarlier(options, report.warnings);
  report.clearance = options.clearance;
  report.accuracy = options.accuracy;
  report.input_uncertainty = options.input_uncertainty;
  report.obstacle_uncertainty = options.obstacle_uncertainty;

  const Scan input = loadInput(options, report.seconds.load);
  const std::shared_ptr<const SurfaceCover> cover = coverOf(options, input, report.seconds.load);
  if (!cover && (options.keep == Keep::flagged || options.distances))
    marked(options.input, withoutRecords(input.cloud), newFields(options, {}, {})); // fails now
  const io::Obstacle obstacle = loadObstacle(options, report.seconds.load);
  requireLength(obstacle, options.obstacle, options.obstacle_uncertainty);
  const auto a = build(cover ? cover->view() : viewOf(input.cloud), input.cloud.fields, options.input,
                       options.input_uncertainty, options.threads, report.seconds.build);
  const auto b = build(obstacle.view(), obstacle.points().fields, options.obstacle, options.obstacle_uncertainty,
                       options.threads, report.seconds.build);
  const SphereHierarchy vertices(obstacle.isSurface() ? viewOf(obstacle.points()) : PointsView());
  const SphereHierarchy& given = obstacle.isSurface() ? vertices : b; // whose coordinates may be coarse
  report.input = {options.input.string(), a.view().count, a.size()};
  if (cover) report.input.points = report.input.finite = input.triangles.size();
  report.obstacle = {options.obstacle.string(), given.view().count, given.size()};
  if (obstacle.isSurface()) report.surface = obstacle;

  const bool by_place = options.moves() || !options.clashes.empty();
  const TrajectoryResult found =
      ofInput(cover.get(), by_place ? alongPath(options, poses, a, b, report) : atPose(options, a, b, report), report);
  const Distances distances = options.distances ? measure(options, a, b, report) : Distances();
  if (!cover) report.density.input = spacingOf(a);
  if (!report.surface) report.density.obstacle = spacingOf(b);
  report.colliding = found.colliding;
  report.voxels_total = a.statistics().voxels + b.statistics().voxels;
  warnOf(report.input, a, report.clearance, report.warnings);
  warnOf(report.obstacle, given, report.clearance, report.warnings);
  for (const std::string& remark : obstacle.remarks())
    report.warnings.push_back(options.obstacle.string() + ": " + remark);
  if (options.asks_collisions) warnOfHoles(report);

  write(options, input, found, distances, report.seconds.write);
  std::vector<Clash> clashes;
  if (!options.clashes.empty()) clashes = listClashes(options, poses, a, b, found, earlier, report);
  const std::optional<io::DistanceReport> measured =
      reportDistances(options, a, b, distances, report.surface ? &*report.surface : nullptr);
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
