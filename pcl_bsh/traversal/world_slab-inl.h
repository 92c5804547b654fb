// SPDX-License-Identifier: BSD-3-Clause
// A node's sphere between the planes of its slab, in the world: how far it reaches along a direction.

#if defined(PCL_BSH_TRAVERSAL_WORLD_SLAB_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_WORLD_SLAB_INL_H_
#undef PCL_BSH_TRAVERSAL_WORLD_SLAB_INL_H_
#else
#define PCL_BSH_TRAVERSAL_WORLD_SLAB_INL_H_
#endif

#include <pcl_bsh/traversal/pair_sides-inl.h>

#include <Eigen/Geometry>

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A sphere's points between two planes. A normal of 0 proves nothing.
struct WorldSlab {
  Eigen::Vector3d normal;
  double h, radius;

  /// How far from its centre it reaches along a unit vector. Normals are not quite of length one: kSlabMargin of all
  /// lengths pays for that.
  double support(const Eigen::Vector3d& along) const
  {
    return std::abs(normal.dot(along)) * h + normal.cross(along).norm() * radius;
  }
};

/// @pre PairSides::haveSlabs(). @param radius of the lane's sphere, in the clouds' unit
inline WorldSlab worldSlabOf(PairSides& sides, const Spaces& side, const Lane& lane, double radius)
{
  const Slabs& slabs = sides.slabsOf(side, lane);
  const Eigen::Vector3d normal(slabs.x[lane.lane], slabs.y[lane.lane], slabs.z[lane.lane]);
  return {side.pose.linear() * normal, slabs.h[lane.lane] * side.frame(lane.space).unit, radius};
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
