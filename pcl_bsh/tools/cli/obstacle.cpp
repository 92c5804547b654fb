// SPDX-License-Identifier: BSD-3-Clause
#include "obstacle.h"

#include "command_line.h"
#include "step.h"

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/search/selected_records.h>

#include <optional>

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

namespace {

/// Loads a file as one obstacle, or as one for each part. Remarks about a file of parts are in `facts` alone.
std::vector<io::Obstacle> load(const ObstacleChoice& choice, const Question& question, const Loading& loading,
                               io::CloudFacts& facts, double& seconds)
{
  ReadChoice reading = loading.reading;
  if (choice.unit) reading.obstacle_unit = choice.unit;
  const io::ReadSettings settings = reading.ofObstacle(
      choice.file, loading.input_unit, choice.uncertainty.value_or(question.obstacle_uncertainty).field);
  const io::SurfaceSettings surface = {question.vertices_only};
  if (!choice.parts && loading.shows)
    return {loadObstacle(choice.file, surface, seconds, settings, &facts, question.threads)};
  if (!choice.parts) return {io::readObstacle(choice.file, surface, settings, &facts, question.threads)};
  std::optional<Step> step;
  if (loading.shows) step.emplace("Loading " + choice.file.string());
  const io::Mesh whole = io::readMesh(choice.file, &facts, settings, question.threads);
  std::vector<io::Obstacle> loaded = obstaclesOf(*choice.parts, whole.vertices, whole.triangles, surface);
  if (step) seconds += step->done(counted(loaded.size(), "part") + ", " + counted(whole.triangles.size(), "triangle"));
  return loaded;
}

} // namespace

std::vector<LoadedObstacle> loadObstacles(const std::vector<ObstacleChoice>& choices, const Question& question,
                                          const Loading& loading, double& seconds,
                                          const std::function<void(const ObstacleChoice&, const io::CloudFacts&)>& told)
{
  std::vector<LoadedObstacle> all;
  std::vector<io::Obstacle> loaded; // of the last file
  io::CloudFacts facts;
  for (const ObstacleChoice& one : choices) {
    if (one.part == 0) loaded.clear();
    if (!one.asked && !loading.unasked) {
      all.emplace_back();
      continue;
    }
    if (loaded.empty()) {
      loaded = load(one, question, loading, facts = {}, seconds);
      if (one.parts) loaded[one.part].addRemarks(facts.remarks); // the first part that is asked about tells them
      if (told) told(one, facts);
    }
    all.push_back({loaded[one.part], facts});
  }
  return all;
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
