// SPDX-License-Identifier: BSD-3-Clause
// Compares children of a node of one cloud with a sphere of the other where spheres prune least. Nodes are too small
// for floats, or far from each other for their size, or one is a leaf that is large beside the other. Walks of pairs
// and of flags ask for this when spheres and slabs leave a pair, before they open or compare it.

#if defined(PCL_BSH_TRAVERSAL_SEPARATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_SEPARATION_INL_H_
#undef PCL_BSH_TRAVERSAL_SEPARATION_INL_H_
#else
#define PCL_BSH_TRAVERSAL_SEPARATION_INL_H_
#endif

#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/traversal/far_nodes.h>
#include <pcl_bsh/traversal/flat_records-inl.h>
#include <pcl_bsh/traversal/leaf_pair-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A node's children and a sphere of the other cloud, in the frame of b's space.
struct ChildrenAndSphere {
  const RelativeFrame& frame;
  bool of_a;    ///< whether the children are a's
  Voxel* voxel; ///< that the node is in; null above the voxels
  const Node& node;
  SphereLanes spheres; ///< the node's children
  Voxel* other_voxel;  ///< that the other node is in; null above the voxels
  const Node& other_node;
  std::uint32_t other_lane;
  Point center; ///< of the other sphere
  float radius; ///< of the other sphere, stretched
  double reach; ///< how far apart points are still of interest, less their radii, in the clouds' unit

  float radiusOf(std::uint32_t lane) const { return spheres.r[lane] * spheres.stretch; }
  bool areInVoxels() const { return voxel && other_voxel; }
  bool isLeaf(std::uint32_t lane) const { return voxel && node.isLeaf(lane); }
  bool otherIsLeaf() const { return other_voxel && other_node.isLeaf(other_lane); }
  LeafRange leaf(std::uint32_t lane) const { return {voxel, node.begin[lane], node.comparedPoints(lane)}; }
  LeafRange otherLeaf() const
  {
    return {other_voxel, other_node.begin[other_lane], other_node.comparedPoints(other_lane)};
  }
};

/// Each function returns those of the children in `near` that are proven to be apart from the other sphere's points.
class Separation {
public:
  Separation(const RecordDistance& distance, const Spaces& a, const Spaces& b, Work& work)
  : distance_(distance),
    a_(a),
    b_(b),
    work_(work)
  {
  }

  /// Compares nodes as small as the float error, by their points as given. @pre both are in voxels
  HWY_NOINLINE std::uint32_t asGiven(const ChildrenAndSphere& compared, std::uint32_t near) const
  {
    alignas(32) float squared[kLanes];
    centersSquared(compared.spheres, compared.center, squared);
    std::uint32_t apart = 0;
    GivenSphere other;
    for (const std::uint32_t lane : Bits(near)) {
      const float radius = compared.radiusOf(lane);
      if (radius > compared.frame.bluntRadius() ||
          !compared.frame.isUndecided(squared[lane],
                                      radius + compared.radius + compared.frame.pruneReach(compared.reach)))
        continue;
      ++work_.exact_decisions;
      if (!other.isKnown())
        other = givenSphereOf(others(compared).storage.view, *compared.other_voxel, compared.other_node,
                              compared.other_lane);
      const GivenSphere own = givenSphereOf(owners(compared).storage.view, *compared.voxel, compared.node, lane);
      if (compared.of_a ? areApart(distance_.ofPoints(), own, other, compared.reach)
                        : areApart(distance_.ofPoints(), other, own, compared.reach))
        apart |= 1u << lane;
    }
    return apart;
  }

  /// Compares a leaf with a much smaller node that is no leaf, by the leaf's points.
  HWY_NOINLINE std::uint32_t byLeafPoints(const ChildrenAndSphere& compared, std::uint32_t near) const
  {
    const bool other_is_leaf = compared.otherIsLeaf();
    std::uint32_t apart = 0;
    for (const std::uint32_t lane : Bits(near)) {
      const float radius = compared.radiusOf(lane);
      const Point center{compared.spheres.x[lane], compared.spheres.y[lane], compared.spheres.z[lane]};
      bool is_apart = false;
      if (!other_is_leaf && compared.isLeaf(lane) && radius > kLargeLeaf * compared.radius)
        is_apart = isLeafApart(compared.frame, compared.leaf(lane), compared.of_a, compared.center, compared.radius,
                               compared.reach);
      else if (other_is_leaf && !compared.isLeaf(lane) && compared.radius > kLargeLeaf * radius)
        is_apart = isLeafApart(compared.frame, compared.otherLeaf(), !compared.of_a, center, radius, compared.reach);
      if (is_apart) apart |= 1u << lane;
    }
    return apart;
  }

  /// Compares nodes far from each other for their size, by their supports towards each other. Then compares a leaf of
  /// points with a much smaller node, point by point.
  /// @param gap as spheresNear() gave it @param by_points whether to compare point by point
  /// @pre both are in voxels, and records are no balls
  HWY_NOINLINE std::uint32_t byExtent(const ChildrenAndSphere& compared, const float* gap, std::uint32_t near,
                                      bool by_points) const
  {
    std::uint32_t far =
        near & spheresFar(gap, compared.spheres.r, compared.spheres.stretch, compared.radius, kFarNodes);
    if (far == 0) return 0;
    const NodeSupport other = nodeSupport(*compared.other_voxel, others(compared).storage.view, compared.other_node,
                                          compared.other_lane, work_);
    const bool other_is_leaf = compared.otherIsLeaf();
    std::uint32_t apart = 0;
    for (const std::uint32_t lane : Bits(far)) {
      const float radius = compared.radiusOf(lane);
      const NodeSupport own = nodeSupport(*compared.voxel, owners(compared).storage.view, compared.node, lane, work_);
      bool is_apart = areFarApart(compared, compared.of_a ? own : other, compared.of_a ? other : own);
      const bool own_points = by_points && !owners(compared).storage.view.triangles,
                 other_points = by_points && !others(compared).storage.view.triangles;
      if (!is_apart && own_points && !other_is_leaf && compared.isLeaf(lane) &&
          radius > kLargeFarLeaf * compared.radius)
        is_apart = isLeafFarApart(compared, compared.leaf(lane), compared.of_a, other);
      else if (!is_apart && other_points && other_is_leaf && !compared.isLeaf(lane) &&
               compared.radius > kLargeFarLeaf * radius)
        is_apart = isLeafFarApart(compared, compared.otherLeaf(), !compared.of_a, own);
      if (is_apart) apart |= 1u << lane;
    }
    return apart;
  }

  /// Compares leaves of triangles with nodes much smaller than their largest ball, by the triangles.
  /// @param flat returns b's triangles laid flat as FlatRecords&; called where they are needed
  template <class Flat>
  HWY_NOINLINE std::uint32_t byTriangles(const ChildrenAndSphere& compared, std::uint32_t near, const Flat& flat) const
  {
    std::uint32_t apart = 0;
    if (others(compared).storage.view.triangles && compared.otherIsLeaf())
      apart = apartFromTriangles(compared.otherLeaf(), !compared.of_a, compared.frame, compared.spheres, near,
                                 compared.reach, flat);
    if (!owners(compared).storage.view.triangles) return apart;
    alignas(32) float x[kLanes] = {compared.center.x}, y[kLanes] = {compared.center.y}, z[kLanes] = {compared.center.z},
                      r[kLanes] = {compared.radius};
    for (const std::uint32_t lane : Bits(near & ~apart)) {
      if (compared.isLeaf(lane) && apartFromTriangles(compared.leaf(lane), compared.of_a, compared.frame,
                                                      {x, y, z, r, 1.0f}, 1, compared.reach, flat) != 0)
        apart |= 1u << lane;
    }
    return apart;
  }

  /// Whether none of a leaf's points is near a sphere of the other cloud, in the frame of b's space.
  /// @param radius stretched. @param reach as ChildrenAndSphere has it
  bool isLeafApart(const RelativeFrame& frame, const LeafRange& leaf, bool leaf_is_a, const Point& center, float radius,
                   double reach) const
  {
    const float within = radius + frame.pruneReach(reach + leaf.largestRadius());
    work_.node_pairs += leaf.count;
    LeafPoints carried;
    if (leaf_is_a) carryLeaf(frame, leaf, carried);
    const float *const x = leaf_is_a ? carried.x : leaf.x(), *const y = leaf_is_a ? carried.y : leaf.y(),
                       *const z = leaf_is_a ? carried.z : leaf.z();
    return pointsNear(x, y, z, leaf.count, center.x, center.y, center.z, within, kSphereMargin) == 0;
  }

private:
  /// Returns the spheres of the other cloud that no triangle of a leaf is near to. Compares only spheres less than half
  /// as large as the leaf's largest ball.
  template <class Flat>
  std::uint32_t apartFromTriangles(const LeafRange& leaf, bool leaf_is_a, const RelativeFrame& frame,
                                   const SphereLanes& spheres, std::uint32_t lanes, double reach,
                                   const Flat& flat) const
  {
    const float within = frame.pruneReach(reach);
    const auto most = static_cast<float>(leaf.largestRadius() / (kLargeBall * frame.unit()));
    alignas(32) float r[kLanes] = {};
    for (const std::uint32_t lane : Bits(lanes)) {
      r[lane] = spheres.r[lane] * spheres.stretch;
      if (!(r[lane] < most)) lanes &= ~(1u << lane);
    }
    if (lanes == 0) return 0;
    work_.node_pairs += leaf.count;
    if (!leaf_is_a)
      return lanes & ~trianglesNear(spheres.x, spheres.y, spheres.z, r, lanes, frame, within, -1.0f, leaf.count,
                                    [&, &records = flat()](std::uint32_t j) -> const FlatRecord& {
                                      return records.of(b_.storage.view, leaf, j);
                                    })
                          .near;
    CarriedTriangles carried;
    carried.carry(a_.storage.view, leaf, frame);
    const float error = roundUp(carried.error);
    const std::uint32_t all = firstBits(leaf.count);
    std::uint32_t apart = 0;
    for (const std::uint32_t lane : Bits(lanes)) {
      FlatTriangle<float> center; // of no size
      center.origin[0] = spheres.x[lane], center.origin[1] = spheres.y[lane], center.origin[2] = spheres.z[lane];
      if (compareWithTriangle(center, carried.leaf, all, r[lane] + within + error, -1.0f).apart == all)
        apart |= 1u << lane;
    }
    return apart;
  }

  const Spaces& owners(const ChildrenAndSphere& compared) const { return compared.of_a ? a_ : b_; }
  const Spaces& others(const ChildrenAndSphere& compared) const { return compared.of_a ? b_ : a_; }

  bool areFarApart(const ChildrenAndSphere& compared, const NodeSupport& a, const NodeSupport& b) const
  {
    return areFarNodesApart(distance_.ofPoints(), a_.pose, a, b_.pose, b, compared.reach, work_.exact_decisions);
  }

  /// Whether a node is apart from each point of a leaf of the other cloud. The leaf's support may not tell that: a leaf
  /// of a cylinder bends by more than distances from a node near the axis differ.
  bool isLeafFarApart(const ChildrenAndSphere& compared, const LeafRange& leaf, bool leaf_is_a,
                      const NodeSupport& node) const
  {
    const PointsView& view = leaf_is_a ? a_.storage.view : b_.storage.view;
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const NodeSupport point(view.point(leaf.record(i)));
      ++work_.node_pairs;
      if (!areFarApart(compared, leaf_is_a ? point : node, leaf_is_a ? node : point)) return false;
    }
    return true;
  }

  const RecordDistance& distance_;
  const Spaces &a_, &b_;
  Work& work_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
