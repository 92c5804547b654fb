// SPDX-License-Identifier: BSD-3-Clause
// Which points of a cloud collide with an obstacle? From two files to a third, with a report.
#include "cli/collide_options.h"
#include "cli/program.h"
#include "cli/report.h"
#include "cli/step.h"

#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/io/cloud_file.h>
#include <pcl_bsh/query/collide.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using cli::Keep, cli::UsageError;
using Options = cli::CollideOptions;

constexpr auto program = cli::collide_program;

struct Scan {
  pcl::PCLPointCloud2 cloud;
  io::Viewpoint viewpoint = io::no_viewpoint;
};

/// The core names what is wrong with a request as `what: wrong: remedy`; users know it by the option.
void requireAccepted(const char* option, const Eigen::Isometry3d& pose, const CollisionRequest& request)
{
  try {
    const SphereHierarchy nothing{PointsView{}};
    anyCollision({nothing}, {nothing, pose}, request);
  }
  catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    throw std::invalid_argument(option + message.substr(std::min(message.find(':'), message.size())));
  }
}

/// Everything that can be known to fail is known before the first cloud is loaded.
void check(const Options& options)
{
  requireAccepted("--clearance", Eigen::Isometry3d::Identity(), options.request);
  requireAccepted("--pose", options.pose, {});
  io::requireWritableCloud(options.output);
  if (!options.report) return;
  for (const fs::path& used : {options.input, options.obstacle, options.output}) {
    if (fs::weakly_canonical(*options.report) == fs::weakly_canonical(used)) {
      throw UsageError("--report: " + options.report->string() + " is a cloud of this command: choose another name");
    }
  }
  io::requireWritable(*options.report);
}

Scan load(const fs::path& path, double& seconds)
{
  cli::Step step("Loading " + path.string());
  Scan scan;
  scan.cloud = io::readCloud(path, &scan.viewpoint);
  seconds += step.done(std::to_string(std::size_t{scan.cloud.width} * scan.cloud.height) + " points");
  return scan;
}

SphereHierarchy build(const Scan& scan, const fs::path& path, unsigned threads, double& seconds)
{
  cli::Step step("Sorting " + path.string() + " into voxels");
  HierarchyOptions options;
  options.threads = threads;
  SphereHierarchy hierarchy(viewOf(scan.cloud), options);
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

/// The cloud without its records.
pcl::PCLPointCloud2 emptyLike(const pcl::PCLPointCloud2& cloud)
{
  pcl::PCLPointCloud2 empty;
  empty.header = cloud.header;
  empty.height = 1;
  empty.fields = cloud.fields;
  empty.is_bigendian = cloud.is_bigendian;
  empty.point_step = cloud.point_step;
  empty.is_dense = cloud.is_dense;
  return empty;
}

pcl::PCLPointCloud2 flagged(const fs::path& path, const pcl::PCLPointCloud2& cloud,
                            const std::vector<std::uint8_t>& collides)
{
  try {
    return withField(cloud, collision_field_name, collides);
  }
  catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path.string() + ": " + error.what());
  }
}

/// The input's points that are wanted, as one row.
pcl::PCLPointCloud2 select(const pcl::PCLPointCloud2& cloud, const PointsView& view,
                           const std::vector<std::uint8_t>& collides, Keep keep)
{
  pcl::PCLPointCloud2 kept = emptyLike(cloud);
  for (std::size_t i = 0; i < view.count; ++i) {
    const Point3 p = view.point(static_cast<std::uint32_t>(i));
    const bool finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
    if (keep == Keep::colliding ? collides[i] == 0 : (collides[i] != 0 || !finite)) continue;
    const auto record = cloud.data.begin() + static_cast<std::ptrdiff_t>(i * cloud.point_step);
    kept.data.insert(kept.data.end(), record, record + cloud.point_step);
  }
  kept.width = static_cast<std::uint32_t>(kept.data.size() / std::max(kept.point_step, 1U));
  kept.row_step = kept.width * kept.point_step;
  return kept;
}

void write(const Options& options, const Scan& input, const std::vector<std::uint8_t>& collides, double& seconds)
{
  cli::Step step("Writing " + options.output.string());
  const pcl::PCLPointCloud2 cloud = options.keep == Keep::flagged
                                        ? flagged(options.input, input.cloud, collides)
                                        : select(input.cloud, viewOf(input.cloud), collides, options.keep);
  io::writeCloud(options.output, cloud, input.viewpoint);
  seconds += step.done(std::to_string(std::size_t{cloud.width} * cloud.height) + " points");
}

void summarise(const Options& options, const cli::CollisionReport& report)
{
  for (const std::string& warning : report.warnings) std::cerr << program << ": warning: " << warning << '\n';
  std::cout << report.colliding << " of " << report.input.points << " points collide";
  if (report.closest.pair) {
    std::cout << "; smallest distance " << report.closest.distance << ", between point " << report.closest.pair->a
              << " of the input and point " << report.closest.pair->b << " of the obstacle";
  }
  std::cout << "; wrote " << options.output.string() << '\n';
}

int collide(const Options& options)
{
  check(options);
  cli::CollisionReport report;
  report.clearance = options.request.clearance;

  const Scan input = load(options.input, report.seconds.load);
  if (options.keep == Keep::flagged) flagged(options.input, emptyLike(input.cloud), {}); // fails now if it must
  const Scan obstacle = load(options.obstacle, report.seconds.load);
  const auto a = build(input, options.input, options.request.threads, report.seconds.build);
  const auto b = build(obstacle, options.obstacle, options.request.threads, report.seconds.build);

  cli::Step query("Comparing");
  FlagsResult flags = collisionFlags({a}, {b, options.pose}, options.request);
  report.closest = closestPair({a}, {b, options.pose}, options.request);
  report.seconds.query = query.done(std::to_string(flags.colliding_a) + " colliding");

  report.colliding = flags.colliding_a;
  report.work = flags.work;
  report.work += report.closest.work;
  report.voxels_total = a.statistics().voxels + b.statistics().voxels;
  report.input = {options.input.string(), a.view().count, a.size()};
  report.obstacle = {options.obstacle.string(), b.view().count, b.size()};
  warnOf(report.input, a, report.clearance, report.warnings);
  warnOf(report.obstacle, b, report.clearance, report.warnings);

  write(options, input, flags.a, report.seconds.write);
  if (options.report) cli::writeReport(*options.report, report);
  summarise(options, report);
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
