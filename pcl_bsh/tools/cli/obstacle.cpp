// SPDX-License-Identifier: BSD-3-Clause
#include "obstacle.h"

#include "command_line.h"
#include "step.h"

#include <pcl_bsh/geometry/counted.h>

#include <cmath>
#include <stdexcept>

namespace pcl_bsh::cli {

void addSurfaceOptions(CLI::App& app, std::optional<double>& tolerance, bool& vertices_only)
{
  CLI::Option* const length =
      app.add_option("--surface-tolerance", tolerance,
                     "files with faces are surfaces: free is farther than D from one, for\n"
                     "certain, and colliding is within D + T; less takes more time and\n"
                     "memory (default: a tenth of D; of 0, the size / 10,000)")
          ->type_name("T")
          ->transform(number<double>("give a finite length > 0", [](double d) { return d > 0 && std::isfinite(d); }));
  app.add_flag("--vertices-only", vertices_only, "files with faces are their vertices alone")->excludes(length);
}

io::Obstacle loadObstacle(const std::filesystem::path& path, const io::SurfaceSettings& settings, double clearance,
                          double& seconds, const io::ColumnNames& columns, io::CloudFacts* facts, unsigned threads)
{
  Step step("Loading " + path.string());
  const auto progress = [&](double fraction) {
    step.share(fraction);
    return true;
  };
  io::Obstacle obstacle = io::readObstacle(path, settings, clearance, progress, columns, facts, threads);
  const pcl::PCLPointCloud2& points = obstacle.points();
  std::string result = counted(std::size_t{points.width} * points.height, "point");
  if (obstacle.isSurface()) {
    result += ", " + counted(obstacle.triangles()->size(), "triangle") + " in " +
              counted(obstacle.cover()->centers.size(), "ball");
  }
  seconds += step.done(result);
  return obstacle;
}

std::vector<std::string> warningsOf(const io::Obstacle& obstacle, const std::filesystem::path& path)
{
  std::vector<std::string> warnings;
  for (const std::string& remark : obstacle.remarks()) warnings.push_back(path.string() + ": " + remark);
  return warnings;
}

void requireLength(const io::Obstacle& obstacle, const std::filesystem::path& path, const Uncertainty& uncertainty)
{
  if (!obstacle.isSurface() || uncertainty.field.empty()) return;
  throw std::invalid_argument("--obstacle-uncertainty: " + uncertainty.field + ": " + path.string() +
                              " is a surface, which has no field: give a length, or --vertices-only");
}

std::string besideSurface(const Accuracy& accuracy, bool swept)
{
  if (swept) return "swept motion";
  return accuracy.isExact() || accuracy.stopsEarly() ? "" : "--accuracy " + accuracy.text();
}

} // namespace pcl_bsh::cli
