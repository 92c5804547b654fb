// SPDX-License-Identifier: BSD-3-Clause
// The spaces of b that a walk through one voxel of a has entered, and nodes of a in the frame of each.

#if defined(PCL_BSH_DISTANCES_ENTERED_SPACES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_ENTERED_SPACES_INL_H_
#undef PCL_BSH_DISTANCES_ENTERED_SPACES_INL_H_
#else
#define PCL_BSH_DISTANCES_ENTERED_SPACES_INL_H_
#endif

#include <pcl_bsh/distances/distance_query.h>
#include <pcl_bsh/distances/distance_visit-inl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Each space is an obstacle. The first one is above the voxels of b.
class EnteredSpaces {
public:
  static constexpr std::uint32_t kAbove = 0;

  EnteredSpaces(const DistancesQuery& query, DistanceScratch& scratch, Work& work)
  : a(query.a),
    b(query.b),
    rotation_(query.rotation),
    unit_(query.unit),
    scratch_(scratch),
    obstacles_(scratch.obstacles),
    work_(work)
  {
    forget();
    if (scratch_.obstacle_of.size() < b.storage.voxel_count) scratch_.obstacle_of.resize(b.storage.voxel_count);
  }
  ~EnteredSpaces() { forget(); }
  EnteredSpaces(const EnteredSpaces&) = delete;
  EnteredSpaces& operator=(const EnteredSpaces&) = delete;

  /// Enters the space above the voxels of b. @param voxel of a
  void begin(std::uint32_t voxel)
  {
    voxel_ = voxel;
    add(kAboveVoxels, nullptr);
  }

  const DistanceObstacle& operator[](std::uint32_t obstacle) const { return obstacles_[obstacle]; }

  /// The first child of a sphere that is opened. Entering a voxel builds it.
  ObstacleSphere childOf(const ObstacleSphere& sphere)
  {
    const Node& node = *sphere.node;
    if (sphere.level > 0) return sphere.below(obstacles_[sphere.obstacle].voxel->nodes[node.child[sphere.lane]], 0);
    if (!sphere.isLeaf()) return {&b.storage.top[node.child[sphere.lane]], 0, 0, kAbove};
    const std::uint32_t voxel = node.begin[sphere.lane];
    if (scratch_.obstacle_of[voxel] == 0) {
      const Voxel* const entered = &b.voxel(voxel, work_);
      add(voxel, entered);
      scratch_.obstacle_of[voxel] = static_cast<std::uint32_t>(obstacles_.size() - 1);
    }
    const std::uint32_t obstacle = scratch_.obstacle_of[voxel];
    return {obstacles_[obstacle].voxel->nodes.data(), 0, 1, obstacle};
  }

  /// The children of the visit in the frame of an obstacle.
  const CarriedNode& carried(DistanceVisit& visit, std::uint32_t obstacle)
  {
    if (visit.carried.size() <= obstacle) visit.carried.resize(2 * std::size_t{obstacle} + 8);
    CarriedNode& own = visit.carried[obstacle];
    if (own.stamp == visit.stamp) return own;
    own.stamp = visit.stamp;
    const RelativeFrame& frame = obstacles_[obstacle].frame;
    carry(frame.m.data(), frame.g.data(), visit.node->x, visit.node->y, visit.node->z, kLanes, own.x, own.y, own.z);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) own.r[lane] = visit.node->r[lane] * frame.stretch_a;
    own.center = carryPoint(frame.m.data(), frame.g.data(), visit.around.center);
    own.radius = visit.around.radius * frame.stretch_a;
    work_.volumes_carried += visit.node->count + std::uint64_t{1};
    return own;
  }

  /// Adds the slabs of the children. @pre carried() was called for this visit. @param voxel of a
  const CarriedNode& carriedSlabs(DistanceVisit& visit, std::uint32_t obstacle, const Voxel& voxel)
  {
    CarriedNode& own = visit.carried[obstacle];
    if (own.slabs_stamp == visit.stamp) return own;
    own.slabs_stamp = visit.stamp;
    const auto index = visit.node - voxel.nodes.data();
    const Slabs& slabs = a.storage.voxels[voxel_].slabs.of(voxel, a.storage.view, work_)[index];
    carrySlabs(obstacles_[obstacle], slabs, own);
    return own;
  }

  /// The slab of a sphere below a voxel. @param radius of it, stretched
  Slab slabOfSphere(const ObstacleSphere& sphere, float radius)
  {
    const DistanceObstacle& obstacle = obstacles_[sphere.obstacle];
    const Voxel& voxel = *obstacle.voxel;
    const Node& node = *sphere.node;
    LazySlabs& slabs = b.storage.voxels[obstacle.space].slabs;
    return slabOf(slabs.of(voxel, b.storage.view, work_)[&node - voxel.nodes.data()], sphere.lane,
                  {node.x[sphere.lane], node.y[sphere.lane], node.z[sphere.lane]}, radius);
  }

  const Spaces a, b;

private:
  void add(std::uint32_t space, const Voxel* voxel)
  {
    const RelativeFrame frame(a.frame(voxel_), a.pose, b.frame(space), b.pose, rotation_);
    obstacles_.emplace_back(voxel, b.frame(space), frame, unit_, a.frame(voxel_).unit);
    obstacles_.back().space = space;
    if (voxel && b.storage.view.triangles) {
      Voxel& entered = b.storage.voxels[space];
      obstacles_.back().slabs = entered.slabs.of(*voxel, b.storage.view, work_);
      if (b.storage.hasLongTriangles(space))
        obstacles_.back().cross_slabs = entered.cross_slabs.of(*voxel, b.storage.view, work_);
    }
    if (scratch_.leaves.size() < obstacles_.size()) scratch_.leaves.resize(2 * obstacles_.size());
  }

  void forget() noexcept
  {
    for (const DistanceObstacle& obstacle : obstacles_)
      if (obstacle.space != kAboveVoxels) scratch_.obstacle_of[obstacle.space] = 0;
    obstacles_.clear();
  }

  const RelativeRotation& rotation_;
  const double unit_; ///< of bounds, in the clouds' unit
  DistanceScratch& scratch_;
  std::vector<DistanceObstacle>& obstacles_;
  Work& work_;
  std::uint32_t voxel_ = kNoVoxel; ///< of a
};

/// Bounds between a voxel of a and the voxels of b, from the tree above these alone, in the walk's unit.
class VoxelBounds {
public:
  struct Range {
    float lower = std::numeric_limits<float>::infinity();
    float upper;
  };

  /// @param above the space of the tree above b's voxels, as seen from the voxel of a @param work counts the tests
  VoxelBounds(const DistanceObstacle& above, const Spaces& b, Work& work) : above_(above), b_(b), work_(work) {}

  /// How near and how far the voxels of b are from a sphere around the origin of a's voxel.
  /// @param cut what is farther is of no interest
  Range range(float radius, float cut)
  {
    Range range{std::numeric_limits<float>::infinity(), cut};
    boundBelow(b_.storage.top[0], radius * above_.frame.stretch_a, range);
    return range;
  }

  /// A lower bound of the distance from any point of the voxel of a to any of b. It bounds that of any node's centre,
  /// too, if the radius is of the voxel's sphere: this holds the box around its points, in which centres lie. The
  /// smallest sphere of the points would not do.
  float least(float radius)
  {
    const Node& root = b_.storage.top[0];
    float lower[kLanes], upper[kLanes] = {}, least = std::numeric_limits<float>::infinity();
    boundChildren(root, radius * above_.frame.stretch_a, lower, upper);
    for (std::uint32_t lane = 0; lane < root.count; ++lane) least = std::min(least, orNone(lower[lane]));
    return least;
  }

private:
  /// Bounds the distances from such a sphere to the children of a node above the voxels of b.
  void boundChildren(const Node& node, float radius, float* lower, float* upper)
  {
    CarriedNode spheres;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      spheres.x[lane] = node.x[lane];
      spheres.y[lane] = node.y[lane];
      spheres.z[lane] = node.z[lane];
      spheres.r[lane] = node.r[lane] * above_.frame.stretch_b;
    }
    boundDistances(spheres, above_, {above_.frame.g[0], above_.frame.g[1], above_.frame.g[2]}, radius, lower, upper);
    work_.node_pairs += node.count;
  }

  void boundBelow(const Node& node, float radius, Range& range)
  {
    float lower[kLanes], upper[kLanes];
    std::fill(std::begin(upper), std::end(upper), range.upper);
    boundChildren(node, radius, lower, upper);
    for (std::uint32_t lane = 0; lane < node.count; ++lane) range.upper = std::min(range.upper, upper[lane]);
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (lower[lane] > range.upper) continue;
      if (node.isLeaf(lane))
        range.lower = std::min(range.lower, orNone(lower[lane]));
      else
        boundBelow(b_.storage.top[node.child[lane]], radius, range);
    }
  }

  const DistanceObstacle& above_;
  const Spaces& b_;
  Work& work_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
