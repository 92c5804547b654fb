// SPDX-License-Identifier: BSD-3-Clause
// An obstacle or a model from a file: the points of a cloud or, where the file has faces, a surface.
//
//   const io::Obstacle crate = io::readObstacle("crate.off", {});
//   SphereHierarchy obstacle(crate.view());          // of a surface, of its triangles
#pragma once

#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/meshes/mesh_parts.h>
#include <pcl_bsh/question/shape.h>

#include <pcl/PCLPointCloud2.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::io {

/// How meshes are taken.
struct SurfaceSettings {
  bool vertices_only = false; ///< a mesh is its vertices, and what lies between them is nothing
};

using CloudPtr = std::shared_ptr<const pcl::PCLPointCloud2>;
using TrianglesPtr = std::shared_ptr<const std::vector<Triangle>>;

/// Shares what it holds with its copies.
class Obstacle {
public:
  Obstacle() = default;

  /// Points alone. @param points not null
  explicit Obstacle(CloudPtr points);

  /// A surface, unless the settings or a lack of triangles say otherwise.
  /// @param vertices not null. @param triangles may be null
  /// @throws InvalidInput as viewOf() does of triangles
  Obstacle(CloudPtr vertices, const TrianglesPtr& triangles, const SurfaceSettings& settings);

  const pcl::PCLPointCloud2& points() const { return *points_; } ///< as read; of a surface, its vertices
  const CloudPtr& cloud() const { return points_; }              ///< the same
  bool isSurface() const { return triangles_ != nullptr; }
  const std::vector<Triangle>* triangles() const { return triangles_.get(); } ///< null where it is no surface

  /// The records that queries ask about: points or triangles, which it keeps alive.
  const PointsView& view() const { return view_; }

  /// The shape for ask(). @param name that its user knows it by
  Shape shape(std::string name) const { return {std::move(name), view_, fields_}; }

  const char* partName() const { return isSurface() ? "triangle" : "point"; } ///< of a record of the view

  /// Remarks for users about how the file was read, a line each, without its name.
  const std::vector<std::string>& remarks() const { return remarks_; }
  void addRemarks(const std::vector<std::string>& more) { remarks_.insert(remarks_.end(), more.begin(), more.end()); }

private:
  CloudPtr points_;
  TrianglesPtr triangles_;
  PointsView view_;
  std::vector<RecordField> fields_; ///< of its points; none of a surface
  std::vector<std::string> remarks_;
};

/// The promise to users about an obstacle that is a surface, in one sentence. @param solid it counts with its
/// inside
std::string promiseOf(const Obstacle& surface, bool solid);

/// Reads a mesh like readMesh(), without faces where the settings take a mesh for its vertices. Arguments and errors
/// are those of readMesh().
Mesh readMesh(const std::filesystem::path& path, const SurfaceSettings& settings, CloudFacts* facts,
              const ReadSettings& reading, unsigned threads);

/// Reads any file that readCloud() reads.
/// @param reading, @param facts and @param threads as readCloud() takes them
/// @throws files::FileError as readMesh() does, and where its faces are no surface
Obstacle readObstacle(const std::filesystem::path& path, const SurfaceSettings& settings,
                      const ReadSettings& reading = {}, CloudFacts* facts = nullptr, unsigned threads = 0);

/// The obstacle of a file whose mesh is read already.
/// @throws files::FileError naming the file, where its faces are no surface
Obstacle obstacleOf(const std::filesystem::path& path, Mesh mesh, const SurfaceSettings& settings);

/// Each part of a file as an obstacle. Arguments and errors are those of meshesOf().
/// @throws files::FileError naming the file, where the faces of a part are no surface
std::vector<Obstacle> obstaclesOf(const MeshParts& parts, const pcl::PCLPointCloud2& vertices,
                                  const std::vector<Triangle>& triangles, const SurfaceSettings& settings);

/// Whether files of that name's extension may have faces.
bool mayHaveFaces(const std::filesystem::path& path);

/// Whether readMesh() finds triangles in a file. Reads the whole file where its beginning cannot tell. Throws as
/// readMesh() does, also for a file of which nothing but corners would be compared.
bool hasFaces(const std::filesystem::path& path);

} // namespace pcl_bsh::io
