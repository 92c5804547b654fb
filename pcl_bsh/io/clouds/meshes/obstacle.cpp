// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/meshes/obstacle.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/search/cloud_view.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace pcl_bsh::io {
namespace {

/// With a clearance, queries visit what is near: some 400 MB while the cover is made. Without one, as for distances,
/// they may compare points with many of the balls.
constexpr double most_usual_balls = 7e6, most_without_clearance = 5e4;
/// Of the best cover of a plane: what a cover takes beyond it.
constexpr double usual_excess = 1.3;
/// In shares of a coordinate and of the diagonal: well above what coverSurface() refuses.
constexpr double least_of_coordinate = 1e-13, least_of_diagonal = 1e-11;

Eigen::Vector3d at(const PointsView& vertices, std::uint32_t record)
{
  const Point3 p = vertices.point(record);
  return {p[0], p[1], p[2]};
}

} // namespace

UsualTolerance usualTolerance(const PointsView& vertices, const std::vector<Triangle>& triangles, double clearance)
{
  Eigen::AlignedBox3d box;
  double area = 0.0;
  for (const Triangle& triangle : triangles) {
    const bool exists = std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t record) {
      return record < vertices.count && isFinite(vertices.point(record));
    });
    if (!exists) continue; // coverSurface() refuses it
    const Eigen::Vector3d a = at(vertices, triangle[0]), b = at(vertices, triangle[1]), c = at(vertices, triangle[2]);
    box.extend(a).extend(b).extend(c);
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  constexpr double any = 1e-6; // where nothing depends on it
  if (box.isEmpty()) return {any, any};
  const double diagonal = box.diagonal().norm();
  const double magnitude = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  UsualTolerance usual;
  usual.wanted = clearance > 0.0 ? clearance / 10 : diagonal / 10000;
  SurfaceCover best;
  best.area = area;
  best.tolerance = 1.0;
  const double most_balls = clearance > 0.0 ? most_usual_balls : most_without_clearance;
  usual.tolerance = std::max({usual.wanted, std::sqrt(usual_excess * best.hexagonalOptimum() / most_balls),
                              least_of_coordinate * magnitude + least_of_diagonal * diagonal});
  if (usual.tolerance == 0.0) usual.tolerance = usual.wanted = any; // a mesh that is one place, the origin
  return usual;
}

SurfaceCover coverMesh(const PointsView& vertices, const std::vector<Triangle>& triangles,
                       const SurfaceSettings& settings, double clearance, const std::function<bool(double)>& progress,
                       std::vector<std::string>& remarks)
{
  SurfaceRequest request;
  request.triangles_apart = settings.triangles_apart;
  request.progress = progress;
  if (settings.tolerance) {
    request.tolerance = *settings.tolerance;
  }
  else {
    const UsualTolerance usual = usualTolerance(vertices, triangles, clearance);
    request.tolerance = usual.tolerance;
    if (usual.tolerance > usual.wanted) {
      std::ostringstream remark;
      remark << "its surface is taken to a tolerance of " << usual.tolerance << ", since one of " << usual.wanted
             << " would take too many balls, or is too fine for its coordinates: give a surface tolerance to choose";
      remarks.push_back(remark.str());
    }
  }
  return coverSurface(vertices, triangles, request);
}

Obstacle::Obstacle(CloudPtr vertices, const TrianglesPtr& triangles, const SurfaceSettings& settings, double clearance,
                   const std::function<bool(double)>& progress)
: points_(std::move(vertices))
{
  if (settings.vertices_only || !triangles || triangles->empty()) return;
  cover_ =
      std::make_shared<SurfaceCover>(coverMesh(viewOf(*points_), *triangles, settings, clearance, progress, remarks_));
  triangles_ = triangles;
}

PointsView Obstacle::view() const
{
  PointsView view = cover_ ? cover_->view() : viewOf(*points_);
  if (cover_)
    view.owner = cover_;
  else
    view.owner = points_;
  return view;
}

Shape Obstacle::shape(std::string name) const
{
  if (cover_) return {std::move(name), cover_};
  return {std::move(name), view(), recordFields(points_->fields)};
}

std::string promiseOf(const Obstacle& surface, const std::string& beside)
{
  return promiseOfObstacle(*surface.cover(), beside);
}

Mesh readMesh(const std::filesystem::path& path, const SurfaceSettings& settings, CloudFacts* facts,
              const ColumnNames& columns, unsigned threads)
{
  if (settings.vertices_only) return {readCloud(path, facts, columns, threads), {}};
  return readMesh(path, facts, columns, threads);
}

Obstacle readObstacle(const std::filesystem::path& path, const SurfaceSettings& settings, double clearance,
                      const std::function<bool(double)>& progress, const ColumnNames& columns, CloudFacts* facts,
                      unsigned threads)
{
  CloudFacts own;
  CloudFacts& told = facts != nullptr ? *facts : own;
  Mesh mesh = readMesh(path, settings, &told, columns, threads);
  Obstacle obstacle = obstacleOf(path, std::move(mesh), settings, clearance, progress);
  obstacle.addRemarks(told.remarks);
  return obstacle;
}

bool hasFaces(const std::filesystem::path& path)
{
  const std::string extension = extensionOf(path);
  if (extension != ".obj" && extension != ".off" && extension != ".ply" && extension != ".stl") return false;
  if (extension == ".ply") {
    constexpr std::size_t usual = std::size_t{1} << 16; // bytes of a header
    const FileBytes beginning(path, usual);
    const std::string_view header = beginning.view().substr(0, beginning.view().find("end_header"));
    const auto names = [&](const char* element) { return header.find(element) != std::string_view::npos; };
    if (header.size() < beginning.view().size() && !names("face") && !names("tristrips")) return false;
  }
  return !readMesh(path).triangles.empty();
}

Obstacle obstacleOf(const std::filesystem::path& path, Mesh mesh, const SurfaceSettings& settings, double clearance,
                    const std::function<bool(double)>& progress)
{
  const auto vertices = std::make_shared<const pcl::PCLPointCloud2>(std::move(mesh.vertices));
  const auto triangles = std::make_shared<const std::vector<Triangle>>(std::move(mesh.triangles));
  try {
    return Obstacle(vertices, triangles, settings, clearance, progress);
  }
  catch (const InvalidInput& error) {
    throw files::FileError(path, error.wrong(), error.remedy());
  }
}

} // namespace pcl_bsh::io
