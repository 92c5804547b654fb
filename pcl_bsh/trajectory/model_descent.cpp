// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/model_descent.h>

#include <pcl_bsh/geometry/given_sphere.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl_bsh {
namespace {

class Descent {
public:
  Descent(const TrajectoryQuery& query, VoxelResults& results, const PointAtPose& point)
  : results_(results),
    point_(point),
    model_(query.model.storage()),
    distance_(query.scan.hierarchy().view(), query.scan.pose, query.model.view(),
              query.given[query.path.poses[point.pose].given]),
    sphere_{query.scan.hierarchy().view().point(point.record), query.scan.hierarchy().view().radius(point.record)},
    reach_(query.between.most)
  {
  }

  /// Compares the point with all that lies below a node. @param voxel the node's voxel; null above the voxels
  void all(const Voxel* voxel, const Node& node)
  {
    struct Near {
      double low;
      std::uint32_t child;
      GivenSphere sphere;
    };
    std::array<Near, kNodeChildren> children;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const GivenSphere sphere = sphereOf(voxel, node, i);
      children[count++] = {distance_.ofPoints().enclose(sphere_.center, sphere.center).low - sphere.radius, i, sphere};
    }
    results_.work.node_pairs += count;
    std::sort(children.begin(), children.begin() + count, [](const Near& x, const Near& y) { return x.low < y.low; });
    for (std::size_t i = 0; i < count && !isDone(); ++i)
      if (!areApart(distance_.ofPoints(), sphere_, children[i].sphere, reach_)) open(voxel, node, children[i].child);
  }

  /// Compares the point with all that lies below one of a node's children.
  void open(const Voxel* voxel, const Node& node, std::uint32_t child)
  {
    if (voxel && node.isLeaf(child)) return compare(*voxel, node, child);
    if (voxel) return all(voxel, voxel->nodes[node.child[child]]);
    if (!node.isLeaf(child)) return all(nullptr, model_.top[node.child[child]]);
    const Voxel& entered = model_.built(node.begin[child], results_.work);
    all(&entered, entered.nodes[0]);
  }

  PointMet met;

private:
  bool asksForNearest() const { return point_.best || point_.for_pose; }
  bool isDone() const { return met.collides && !asksForNearest(); }

  GivenSphere sphereOf(const Voxel* voxel, const Node& node, std::uint32_t child) const
  {
    if (!voxel) return storedSphere(model_.frame, node, child);
    if (voxel->given.empty()) return storedSphere(voxel->frame, node, child);
    return givenSphereOf(model_.view, *voxel, node, child);
  }

  void compare(const Voxel& voxel, const Node& node, std::uint32_t child)
  {
    ++results_.work.leaf_pairs;
    const std::uint32_t end = node.begin[child] + node.comparedPoints(child);
    for (std::uint32_t i = node.begin[child]; i < end && !isDone(); ++i) {
      const PointPair pair{point_.record, voxel.records()[i]};
      if (met.collides && distance_.compare(pair, reach_) > 0) continue;
      if (!results_.collide(pair, point_.pose)) continue;
      met.collides = true;
      if (!asksForNearest()) return;
      if (point_.best) results_.consider(*point_.best, pair, point_.pose);
      if (point_.for_pose) results_.considerPose(pair, point_.pose);
      met.gap = std::min(met.gap, distance_.gap(pair));
      reach_ = std::min(reach_, std::nextafter(met.gap, std::numeric_limits<double>::infinity()));
    }
  }

  VoxelResults& results_;
  const PointAtPose point_;
  const SphereHierarchy::Storage& model_;
  const RecordDistance distance_;
  const GivenSphere sphere_; ///< the point
  double reach_;             ///< pairs beyond, less radii, do not collide, or are not the nearest
};

} // namespace

PointMet meet(const TrajectoryQuery& query, VoxelResults& results, const PointAtPose& point, std::uint32_t voxel,
              std::uint32_t node, std::uint32_t child)
{
  Descent descent(query, results, point);
  const SphereHierarchy::Storage& model = query.model.storage();
  if (voxel == kAboveVoxels) {
    descent.open(nullptr, model.top[node], child);
  }
  else {
    const Voxel& entered = model.built(voxel, results.work);
    descent.all(&entered, entered.nodes[0]);
  }
  return descent.met;
}

} // namespace pcl_bsh
