// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/meshes/obstacle.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/clouds/formats.h>
#include <pcl_bsh/io/clouds/ply/ply.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/uncertainty.h>

#include <string_view>
#include <utility>

namespace pcl_bsh::io {

Obstacle::Obstacle(CloudPtr points)
: points_(std::move(points)),
  view_(viewOf(*points_)),
  fields_(recordFields(points_->fields))
{
  view_.owner = points_;
}

Obstacle::Obstacle(CloudPtr vertices, const TrianglesPtr& triangles, const SurfaceSettings& settings)
: Obstacle(std::move(vertices))
{
  if (settings.vertices_only || !triangles || triangles->empty()) return;
  view_ = viewOf(trianglesOf(view_, triangles));
  fields_.clear();
  triangles_ = triangles;
}

std::string promiseOf(const Obstacle& surface, bool solid)
{
  const std::string triangles = counted(surface.triangles()->size(), "triangle");
  if (solid) return "the obstacle is a solid of " + triangles + ": what it encloses is part of it";
  return "the obstacle is a surface of " + triangles + ": what it encloses is no part of it without `solid`";
}

Mesh readMesh(const std::filesystem::path& path, const SurfaceSettings& settings, CloudFacts* facts,
              const ReadSettings& reading, unsigned threads)
{
  if (settings.vertices_only) return {readCloud(path, facts, reading, threads), {}};
  return readMesh(path, facts, reading, threads);
}

Obstacle readObstacle(const std::filesystem::path& path, const SurfaceSettings& settings, const ReadSettings& reading,
                      CloudFacts* facts, unsigned threads)
{
  CloudFacts own;
  CloudFacts& told = facts != nullptr ? *facts : own;
  Mesh mesh = readMesh(path, settings, &told, reading, threads);
  Obstacle obstacle = obstacleOf(path, std::move(mesh), settings);
  obstacle.addRemarks(told.remarks);
  return obstacle;
}

bool mayHaveFaces(const std::filesystem::path& path)
{
  const CloudFormat* const format = cloudFormat(extensionOf(path));
  return format && format->has_faces;
}

bool hasFaces(const std::filesystem::path& path)
{
  if (!mayHaveFaces(path)) return false;
  if (extensionOf(path) == ".ply") {
    constexpr std::size_t usual = std::size_t{1} << 16; // bytes of a header
    if (isPlyOfPoints(FileBytes(path, usual).view())) return false;
  }
  return !readMesh(path).triangles.empty();
}

Obstacle obstacleOf(const std::filesystem::path& path, Mesh mesh, const SurfaceSettings& settings)
{
  const auto vertices = std::make_shared<const pcl::PCLPointCloud2>(std::move(mesh.vertices));
  const auto triangles = std::make_shared<const std::vector<Triangle>>(std::move(mesh.triangles));
  try {
    return Obstacle(vertices, triangles, settings);
  }
  catch (const InvalidInput& error) {
    throw files::FileError(path, error.wrong(), error.remedy());
  }
}

std::vector<Obstacle> obstaclesOf(const MeshParts& parts, const pcl::PCLPointCloud2& vertices,
                                  const std::vector<Triangle>& triangles, const SurfaceSettings& settings)
{
  std::vector<Obstacle> obstacles;
  for (Mesh& mesh : meshesOf(parts, vertices, triangles))
    obstacles.push_back(obstacleOf(parts.file, std::move(mesh), settings));
  return obstacles;
}

} // namespace pcl_bsh::io
