// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/mesh_collision_filter.h>

#include <pcl_bsh/filters/gathered_result.h>
#include <pcl_bsh/hierarchy/points_checksum.h>
#include <pcl_bsh/search/selected_records.h>
#include <pcl_bsh/search/used_vertices.h>

#include <array>
#include <stdexcept>
#include <utility>

namespace pcl_bsh {
namespace {

/// Checksum of the vertices' coordinates, and of the polygons.
std::uint64_t checksumOf(const pcl::PolygonMesh& mesh)
{
  std::uint64_t sum = pcl_bsh::checksumOf(viewOf(mesh.cloud));
  for (const pcl::Vertices& polygon : mesh.polygons) {
    sum = mixed(sum, polygon.vertices.size());
    for (const pcl::index_t vertex : polygon.vertices) sum = mixed(sum, static_cast<std::uint64_t>(vertex));
  }
  return sum;
}

} // namespace

void MeshCollisionFilter::setInputMesh(const pcl::PolygonMesh::ConstPtr& mesh)
{
  if (!mesh) throw std::invalid_argument("input mesh is null: give a mesh without polygons where you have no mesh");
  std::vector<std::uint32_t> polygons = trianglesOf(*mesh).polygons;
  triangles_ = viewOf(mesh);
  polygons_ = std::move(polygons);
  mesh_ = mesh;
  checksum_ = checksumOf(*mesh);
}

void MeshCollisionFilter::setInputSurface(const TrianglesView& triangles)
{
  triangles_ = viewOf(triangles);
  mesh_.reset();
}

Shape MeshCollisionFilter::inputShape() const
{
  if (!triangles_) throw std::invalid_argument("input mesh is missing: call setInputMesh() before filtering");
  if (mesh_ && checksumOf(*mesh_) != checksum_)
    throw std::invalid_argument("input mesh has changed since setInputMesh(): call it again");
  return {"the input", *triangles_};
}

TrajectoryResult MeshCollisionFilter::ofPolygons(TrajectoryResult found)
{
  if (!mesh_) return found;
  TrajectoryResult gathered = gatheredResult(found, mesh_->polygons.size(),
                                             [&](std::size_t t) { return std::array<std::size_t, 1>{polygons_[t]}; });
  undecided_ = gathered.undecided;
  return gathered;
}

void MeshCollisionFilter::computeFlags(std::vector<Verdict>& flags)
{
  TrajectoryResult found;
  found.flags = collisionFlags(inputShape());
  flags = ofPolygons(std::move(found)).flags;
}

void MeshCollisionFilter::computeTrajectory(TrajectoryResult& result)
{
  result = ofPolygons(alongTrajectory(inputShape()));
}

void MeshCollisionFilter::filter(pcl::PolygonMesh& output)
{
  if (triangles_ && !mesh_)
    throw std::invalid_argument(
        "input mesh is missing: a list of triangles is no mesh to keep of: call setInputMesh()");
  std::vector<Verdict> flags;
  computeFlags(flags);
  pcl::PolygonMesh kept;
  kept.header = mesh_->header;
  for (std::size_t p = 0; p < flags.size(); ++p)
    if ((flags[p] != Verdict::free) == negative_) kept.polygons.push_back(mesh_->polygons.at(p));
  const pcl::Indices vertices = keepUsedVertices(
      viewOf(mesh_->cloud).count, kept.polygons, [](pcl::Vertices & polygon) -> auto& { return polygon.vertices; });
  kept.cloud = selectedRecords(mesh_->cloud, vertices);
  output = std::move(kept);
}

} // namespace pcl_bsh
