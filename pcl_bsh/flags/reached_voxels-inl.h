// SPDX-License-Identifier: BSD-3-Clause
// The voxels of b that one voxel of a can reach: found by spheres, then entered.

#if defined(PCL_BSH_FLAGS_REACHED_VOXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_REACHED_VOXELS_INL_H_
#undef PCL_BSH_FLAGS_REACHED_VOXELS_INL_H_
#else
#define PCL_BSH_FLAGS_REACHED_VOXELS_INL_H_
#endif

#include <pcl_bsh/flags/query.h>
#include <pcl_bsh/flags/slabs-inl.h>
#include <pcl_bsh/query/progress.h>

#include <algorithm>
#include <optional>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// The voxels of b that a walk reaches. Each becomes an obstacle.
class ReachedVoxels {
public:
  ReachedVoxels(const FlagQuery& query, const Spaces& a, const Spaces& b, FlagScratch& scratch, Work& work)
  : numbers(scratch.reached),
    obstacles(scratch.obstacles),
    spheres(scratch.spheres),
    query_(query),
    a_(a),
    b_(b),
    reach_(query.pairs.reach.length()),
    flat_(scratch.flat),
    work_(work)
  {
    obstacles.clear();
    spheres.clear();
    numbers.clear();
    flat_.prepare(b_.storage);
  }

  /// Finds the voxels that a voxel of a reaches. @return the finding for all points of that voxel, if spheres tell
  std::optional<Finding> find(std::uint32_t voxel)
  {
    const RelativeFrame above(a_.frame(voxel), a_.pose, b_.frame(kAboveVoxels), b_.pose, query_.rotation);
    if (above.separates(reach_ + a_.storage.largest_radius + b_.storage.largest_radius)) return Finding::free;
    ++work_.volumes_carried; // the voxel's own sphere
    if (!find(voxel, above, b_.storage.top[0])) return Finding::colliding;
    return numbers.empty() ? std::optional(Finding::free) : std::nullopt;
  }

  std::size_t pointsToBuild() const
  {
    std::size_t points = 0;
    for (const std::uint32_t other : numbers) points += b_.storage.pointsToBuild(other);
    return points;
  }

  /// Builds the voxels that were found, and makes obstacles of them. @param voxel of a
  void enter(std::uint32_t voxel, WorkPulse& pulse)
  {
    for (const std::uint32_t other : numbers) {
      pulse.look();
      const RelativeFrame frame(a_.frame(voxel), a_.pose, b_.frame(other), b_.pose, query_.rotation);
      const auto flat = [&](double length) {
        return b_.storage.view.triangles ? FlatRecord::usualBand(frame, length) : DistanceBand();
      };
      const Node& root = b_.voxel(other, work_).nodes[0];
      for (std::uint32_t lane = 0; lane < root.count; ++lane)
        spheres.push_back({&root, static_cast<std::uint16_t>(lane), 1, static_cast<std::uint32_t>(obstacles.size())});
      obstacles.push_back(
          {&b_.storage.voxels[other], frame, frame.pruneReach(reach_),
           frame.acceptReach(query_.surePairs().reach.least - a_.storage.view.off_middle - b_.storage.view.off_middle),
           frame.acceptReach(query_.surely.hit), frame.bluntRadius(), query_.surely.band(frame),
           query_.length_band.band(frame), query_.surely.band(flat), query_.length_band.band(flat), nullptr, nullptr,
           b_.storage.hasLongTriangles(other)});
    }
  }

  /// Whether a triangle may be near the sphere of a voxel of a. If not, the voxel need not be built.
  /// @param mayFit() whether slabs are worth fitting by now
  template <class MayFit>
  HWY_NOINLINE bool haveTrianglesNear(std::uint32_t voxel, FlagSlabs& slabs, const MayFit& mayFit)
  {
    return std::any_of(obstacles.begin(), obstacles.end(), [&](ObstacleVoxel& obstacle) {
      const Point center{obstacle.frame.g[0], obstacle.frame.g[1], obstacle.frame.g[2]};
      const float radius = a_.storage.voxels[voxel].radius * obstacle.frame.stretch_a;
      return hasTriangleNear(obstacle, obstacle.voxel->nodes[0], center, radius, slabs, mayFit);
    });
  }

  /// Returns which of up to eight spheres, in an obstacle's frame, the triangles of a leaf may be near to.
  LanesNear nearTo(const LeafRange& leaf, const ObstacleVoxel& obstacle, const float* x, const float* y, const float* z,
                   const float* r, std::uint32_t lanes, float sure_reach)
  {
    return trianglesNear(x, y, z, r, lanes, obstacle.frame, obstacle.reach, sure_reach, leaf.count,
                         [&](std::uint32_t j) -> const FlatRecord& { return flat_.of(b_.storage.view, leaf, j); });
  }

  std::vector<std::uint32_t>& numbers;
  std::vector<ObstacleVoxel>& obstacles;
  std::vector<ObstacleSphere>& spheres; ///< of the obstacles' roots

private:
  /// @return false when all points of the voxel collide
  bool find(std::uint32_t voxel, const RelativeFrame& frame, const Node& node)
  {
    const float radius = a_.storage.voxels[voxel].radius * frame.stretch_a;
    const QueryBall ball{frame.g[0], frame.g[1], frame.g[2], radius + frame.pruneReach(reach_),
                         frame.acceptReach(query_.surely.hit) - radius * (1.0f + kSphereMargin)};
    const SphereLanes tested{node.x, node.y, node.z, node.r, frame.stretch_b};
    work_.node_pairs += node.count;
    if ((spheresInside(tested, ball) & firstBits(node.count)) != 0) return false;
    for (const std::uint32_t lane : Bits(spheresNear(tested, ball, nullptr) & firstBits(node.count))) {
      if (node.isLeaf(lane))
        numbers.push_back(node.begin[lane]);
      else if (!find(voxel, frame, b_.storage.top[node.child[lane]]))
        return false;
    }
    return true;
  }

  /// Whether a triangle below a node may be near a sphere, carried.
  template <class MayFit>
  bool hasTriangleNear(ObstacleVoxel& obstacle, const Node& node, const Point& center, float radius, FlagSlabs& slabs,
                       const MayFit& mayFit)
  {
    const SphereLanes tested{node.x, node.y, node.z, node.r, obstacle.frame.stretch_b};
    const QueryBall ball{center.x, center.y, center.z, radius + obstacle.reach, 0.0f};
    work_.node_pairs += node.count;
    std::uint32_t near = spheresNear(tested, ball, nullptr) & firstBits(node.count);
    if (near != 0 && obstacle.has_long_triangles && mayFit()) {
      slabs.fit(obstacle);
      near = slabs.nearSphere(obstacle, node, tested, center, radius, near);
    }
    for (const std::uint32_t lane : Bits(near)) {
      if (!node.isLeaf(lane)) {
        const Node& below = obstacle.voxel->nodes[node.child[lane]];
        if (hasTriangleNear(obstacle, below, center, radius, slabs, mayFit)) return true;
        continue;
      }
      const LeafRange leaf{obstacle.voxel, node.begin[lane], node.comparedPoints(lane)};
      alignas(64) float x[kLanes], y[kLanes], z[kLanes], r[kLanes];
      for (std::uint32_t i = 0; i < kLanes; ++i) x[i] = center.x, y[i] = center.y, z[i] = center.z, r[i] = radius;
      work_.node_pairs += leaf.count;
      if (nearTo(leaf, obstacle, x, y, z, r, 1, -1.0f).near != 0) return true;
    }
    return false;
  }

  const FlagQuery& query_;
  const Spaces &a_, &b_;
  const double reach_; ///< of all pairs
  FlatRecords& flat_;
  Work& work_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
