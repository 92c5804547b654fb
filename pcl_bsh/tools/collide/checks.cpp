// SPDX-License-Identifier: BSD-3-Clause
#include "checks.h"

#include <pcl_bsh/tools/cli/program.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/report_origin.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <string>

namespace pcl_bsh::cli {
namespace {

namespace fs = std::filesystem;

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

} // namespace

void check(const CollideOptions& options)
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
  if (options.distances) io::reportDate(); // refuses one that is none before anything is done
  if (options.distances && options.distances->page) requireDistancePage(*options.distances->page);
}

} // namespace pcl_bsh::cli
