// SPDX-License-Identifier: BSD-3-Clause
#include "obstacle.h"

#include "command_line.h"
#include "step.h"

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/search/selected_records.h>

namespace pcl_bsh::cli {

io::Obstacle loadObstacle(const std::filesystem::path& path, const io::SurfaceSettings& settings, double& seconds,
                          const io::ReadSettings& reading, io::CloudFacts* facts, unsigned threads)
{
  Step step("Loading " + path.string());
  io::Obstacle obstacle = io::readObstacle(path, settings, reading, facts, threads);
  const pcl::PCLPointCloud2& points = obstacle.points();
  std::string result = counted(std::size_t{points.width} * points.height, "point");
  if (obstacle.isSurface()) result += ", " + counted(obstacle.triangles()->size(), "triangle");
  seconds += step.done(result);
  return obstacle;
}

std::vector<io::Obstacle> loadParts(const io::MeshParts& parts, const io::SurfaceSettings& settings, double& seconds,
                                    const io::ReadSettings& reading, io::CloudFacts& facts, unsigned threads)
{
  Step step("Loading " + parts.file.string());
  const io::Mesh whole = io::readMesh(parts.file, &facts, reading, threads);
  std::vector<io::Obstacle> obstacles = obstaclesOf(parts, whole.vertices, whole.triangles, settings);
  obstacles.front().addRemarks(facts.remarks);
  seconds += step.done(counted(obstacles.size(), "part") + ", " + counted(whole.triangles.size(), "triangle"));
  return obstacles;
}

void requireWritableFlags(const std::filesystem::path& file, const io::Obstacle& obstacle)
{
  if (obstacle.isSurface()) return io::requireWritableMesh(file);
  io::requireWritableCloud(file);
  withField(withoutRecords(obstacle.points()), collision_field_name, {});
}

void writeFlags(const std::filesystem::path& file, const io::Obstacle& obstacle, const std::vector<Verdict>& flags,
                const io::CloudFacts& facts)
{
  if (!obstacle.isSurface()) {
    io::writeCloud(file, withField(obstacle.points(), collision_field_name, flags), facts.viewpoint, facts.las);
    return;
  }
  const std::vector<std::uint8_t> values = numbersOf(flags);
  io::writeMesh(file, obstacle.points(), *obstacle.triangles(), {{collision_field_name, &values}}, facts.viewpoint);
}

std::vector<std::string> warningsOf(const io::Obstacle& obstacle, const std::filesystem::path& path)
{
  std::vector<std::string> warnings;
  for (const std::string& remark : obstacle.remarks()) warnings.push_back(path.string() + ": " + remark);
  return warnings;
}

} // namespace pcl_bsh::cli
