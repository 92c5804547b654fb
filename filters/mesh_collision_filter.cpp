// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/mesh_collision_filter.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/filters/selected_records.h>
#include <pcl_bsh/filters/used_vertices.h>
#include <pcl_bsh/hierarchy/points_checksum.h>

#include <stdexcept>
#include <utility>

namespace pcl_bsh {
namespace {

/// Of the vertices' coordinates, and of the polygons.
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

void MeshCollisionFilter::setInputMesh(const pcl::PolygonMesh::ConstPtr& mesh, double tolerance)
{
  if (!mesh) throw std::invalid_argument("input mesh is null: give a mesh without polygons if there is none");
  cover_ = coverOf(mesh, tolerance, true);
  mesh_ = mesh;
  checksum_ = checksumOf(*mesh);
}

void MeshCollisionFilter::setInputSurface(const std::shared_ptr<const SurfaceCover>& cover)
{
  if (!cover) throw std::invalid_argument("input surface is null: give the cover of no triangles if there is none");
  if (!cover->triangles_apart) {
    throw InvalidInput(Input::surface, "input surface", "its balls hold parts of several triangles each",
                       "cover it with triangles_apart");
  }
  cover_ = cover;
  mesh_.reset();
}

Shape MeshCollisionFilter::inputShape() const
{
  if (!cover_) throw std::invalid_argument("input mesh is missing: call setInputMesh() before filtering");
  if (mesh_ && checksumOf(*mesh_) != checksum_)
    throw std::invalid_argument("input mesh has changed since setInputMesh(): call it again");
  return {"the input", cover_};
}

void MeshCollisionFilter::computeFlags(std::vector<Verdict>& flags)
{
  flags = collisionFlags(inputShape());
}

void MeshCollisionFilter::computeTrajectory(TrajectoryResult& result)
{
  result = alongTrajectory(inputShape());
}

void MeshCollisionFilter::filter(pcl::PolygonMesh& output)
{
  if (cover_ && !mesh_)
    throw std::invalid_argument("input mesh is missing: a cover has no polygons to keep: call setInputMesh()");
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
