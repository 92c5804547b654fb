// SPDX-License-Identifier: BSD-3-Clause
// An obstacle or a model from a file: the points of a cloud or, where the file has faces, a surface.
//
//   const io::Obstacle crate = io::readObstacle("crate.off", {}, clearance);
//   SphereHierarchy obstacle(crate.view());          // of a surface, balls that cover it
//   crate.partOf(pair.b);                            // the point, or the triangle, that a record of the view stands
//   for
//
// Of a surface, free is farther than the clearance from it, for certain, and colliding is within clearance +
// tolerance(). What a closed surface encloses is not part of it.
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/question/shape.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// How meshes are taken.
struct SurfaceSettings {
  /// By how much balls may stick out, in the cloud's unit; finite and > 0. None: usualTolerance().
  std::optional<double> tolerance;
  bool vertices_only = false;   ///< a mesh is its vertices, and what lies between them is nothing
  bool triangles_apart = false; ///< for a mesh that is asked about (SurfaceRequest::triangles_apart)
};

using CloudPtr = std::shared_ptr<const pcl::PCLPointCloud2>;
using TrianglesPtr = std::shared_ptr<const std::vector<Triangle>>;

/// The tolerance where users say none.
struct UsualTolerance {
  double tolerance = 0.0;
  /// A tenth of the clearance or, where that is 0, a 10,000th of the diagonal of the triangles' box; `tolerance` is
  /// greater where the cover would take more than some seven million balls (50,000 where the clearance is 0), or
  /// the coordinates round too much.
  double wanted = 0.0;
};

UsualTolerance usualTolerance(const PointsView& vertices, const std::vector<Triangle>& triangles, double clearance);

/// Covers a mesh to the tolerance of the settings, or to the usual one.
/// @param clearance of the query, for the usual tolerance
/// @param progress as SurfaceRequest has it
/// @param remarks what users should know of the cover is appended, a line each, without the file's name
/// @throws InvalidInput as coverSurface() does. Cancelled
SurfaceCover coverMesh(const PointsView& vertices, const std::vector<Triangle>& triangles,
                       const SurfaceSettings& settings, double clearance, const std::function<bool(double)>& progress,
                       std::vector<std::string>& remarks);

/// Shares what it holds with its copies.
class Obstacle {
public:
  Obstacle() = default;

  /// Points alone. @param points not null
  explicit Obstacle(CloudPtr points) : points_(std::move(points)) {}

  /// A surface, unless the settings or a lack of triangles say otherwise.
  /// @param vertices not null. @param triangles may be null
  /// @param clearance of the query, for the usual tolerance
  /// @param progress as SurfaceRequest has it
  /// @throws InvalidInput as coverSurface() does. Cancelled
  Obstacle(CloudPtr vertices, const TrianglesPtr& triangles, const SurfaceSettings& settings, double clearance,
           const std::function<bool(double)>& progress = nullptr);

  const pcl::PCLPointCloud2& points() const { return *points_; } ///< as read; of a surface, its vertices
  const CloudPtr& cloud() const { return points_; }              ///< the same
  bool isSurface() const { return cover_ != nullptr; }
  const std::vector<Triangle>* triangles() const { return triangles_.get(); } ///< null where it is no surface
  const std::shared_ptr<const SurfaceCover>& cover() const { return cover_; } ///< likewise
  double tolerance() const { return cover_ ? cover_->tolerance : 0.0; }       ///< 0 where it is no surface

  /// What queries ask: the points, or the balls of the cover. Keeps them alive.
  PointsView view() const;

  /// The same for ask(). @param name that its user knows it by
  Shape shape(std::string name) const;

  /// The point (a record of points()) or the triangle that a record of the view stands for.
  std::uint32_t partOf(std::uint32_t record) const { return cover_ ? cover_->triangles[record] : record; }
  const char* partName() const { return cover_ ? "triangle" : "point"; }

  /// What users should know of the cover, and of how the file was read, a line each, without its name.
  const std::vector<std::string>& remarks() const { return remarks_; }
  void addRemarks(const std::vector<std::string>& more) { remarks_.insert(remarks_.end(), more.begin(), more.end()); }

private:
  CloudPtr points_;
  TrianglesPtr triangles_;
  std::shared_ptr<const SurfaceCover> cover_;
  std::vector<std::string> remarks_;
};

/// What verdicts and distances mean where the obstacle is a surface, in one sentence.
/// @param beside whose tolerance comes on top; empty: none
std::string promiseOf(const Obstacle& surface, const std::string& beside = "");

/// What readMesh() reads, without faces where the settings take a mesh for its vertices. Arguments and errors are its.
Mesh readMesh(const std::filesystem::path& path, const SurfaceSettings& settings, CloudFacts* facts,
              const ColumnNames& columns, unsigned threads);

/// Reads any file that readCloud() reads.
/// @param columns, @param facts and @param threads as readCloud() takes them
/// @throws files::FileError as readMesh() does, and where its faces cannot be covered. Cancelled
Obstacle readObstacle(const std::filesystem::path& path, const SurfaceSettings& settings, double clearance,
                      const std::function<bool(double)>& progress = nullptr, const ColumnNames& columns = {},
                      CloudFacts* facts = nullptr, unsigned threads = 0);

/// That of a file whose mesh is read already.
/// @throws files::FileError naming the file, where its faces cannot be covered. Cancelled
Obstacle obstacleOf(const std::filesystem::path& path, Mesh mesh, const SurfaceSettings& settings, double clearance,
                    const std::function<bool(double)>& progress = nullptr);

/// Whether readMesh() finds triangles in a file, which it reads where a beginning cannot tell. Throws as it does.
bool hasFaces(const std::filesystem::path& path);

} // namespace pcl_bsh::io
