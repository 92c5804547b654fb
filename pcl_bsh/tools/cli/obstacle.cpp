// SPDX-License-Identifier: BSD-3-Clause
#include "obstacle.h"

#include "command_line.h"
#include "step.h"

#include <pcl_bsh/geometry/counted.h>

namespace pcl_bsh::cli {

io::Obstacle loadObstacle(const std::filesystem::path& path, const io::SurfaceSettings& settings, double& seconds,
                          const io::ColumnNames& columns, io::CloudFacts* facts, unsigned threads)
{
  Step step("Loading " + path.string());
  io::Obstacle obstacle = io::readObstacle(path, settings, columns, facts, threads);
  const pcl::PCLPointCloud2& points = obstacle.points();
  std::string result = counted(std::size_t{points.width} * points.height, "point");
  if (obstacle.isSurface()) result += ", " + counted(obstacle.triangles()->size(), "triangle");
  seconds += step.done(result);
  return obstacle;
}

std::vector<std::string> warningsOf(const io::Obstacle& obstacle, const std::filesystem::path& path)
{
  std::vector<std::string> warnings;
  for (const std::string& remark : obstacle.remarks()) warnings.push_back(path.string() + ": " + remark);
  return warnings;
}

} // namespace pcl_bsh::cli
