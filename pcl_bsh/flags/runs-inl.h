// SPDX-License-Identifier: BSD-3-Clause
// Flags the points of a voxel of a as they follow each other in the cloud, without a tree of their own. A question that
// is asked once is answered before such a tree would be built. Neighbours in a scan mostly collide with the same leaf
// of b.

#if defined(PCL_BSH_FLAGS_RUNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_RUNS_INL_H_
#undef PCL_BSH_FLAGS_RUNS_INL_H_
#else
#define PCL_BSH_FLAGS_RUNS_INL_H_
#endif

#include <pcl_bsh/flags/leaf-inl.h>
#include <pcl_bsh/hierarchy/build/local_points-inl.h>

#include <cmath>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Steps that a voxel, and each of its points, may cost before a tree is the better way.
inline constexpr std::uint64_t kStepsOfVoxel = 2048;
inline constexpr std::uint64_t kMostStepsPerPoint = 20;

/// The greatest radius of a group, as a multiple of the reach.
inline constexpr float kWidestGroup = 3.0f;

/// Flags the points of one voxel in groups. Tells the writer only of points that collide or may collide.
class FlagRuns {
public:
  /// @param voxel listed. @param obstacles all voxels of b that it can reach; points have no radii
  FlagRuns(const Voxel& voxel, const PointsView& view, const std::vector<ObstacleVoxel>& obstacles,
           const FlagQuery& query, FlagWriter& writer, Work& work)
  : voxel_(voxel),
    view_(view),
    obstacles_(obstacles),
    query_(query),
    writer_(writer),
    work_(work),
    slack_(roundUp(storedSlack(voxel.frame)))
  {
  }

  /// @return false where it takes too many steps: then some points that collide may have been reported, and all have to
  /// be flagged by other means
  bool run() { return view_.scalar == Scalar::float32 ? runOf<float>() : runOf<double>(); }

private:
  /// A leaf of b, and the bits of the points that were open and near it when it was found.
  struct NearLeaf {
    LeafRange leaf;
    std::uint32_t points = 0;
  };
  static constexpr std::size_t kMostCollected = 64;

  /// Long runs are divided evenly, short ones joined into groups of at most a leaf's points.
  template <class T>
  bool runOf()
  {
    const LocalReader<T> read(voxel_.frame, view_);
    allowed_ = steps() + kStepsOfVoxel;
    std::uint32_t held = 0;
    eachListedRun(voxel_, view_, [&](const Run& run) {
      const auto groups = static_cast<std::uint32_t>((run.points - 1) / kMaxLeafPoints + 1);
      for (std::uint32_t k = 0; k < groups && !isTooMuch(); ++k) {
        const std::uint32_t from = divided(run.points, k, groups), to = divided(run.points, k + 1, groups);
        if (held + (to - from) > kLeafPoints) flag(std::exchange(held, 0));
        read(Run{run.number + from, to - from}, points_ + held);
        held += to - from;
      }
      return !isTooMuch();
    });
    if (!isTooMuch()) flag(held);
    return !isTooMuch();
  }

  static std::uint32_t divided(std::uint32_t points, std::uint32_t k, std::uint32_t groups)
  {
    return static_cast<std::uint32_t>(std::uint64_t{points} * k / groups);
  }

  std::uint64_t steps() const { return work_.node_pairs + kLeafPoints * work_.leaf_pairs + work_.exact_decisions; }
  bool isTooMuch() const { return given_up_ || steps() > allowed_; }

  /// Whether a group is so wide beside the reach that a leaf of b settles few points: a tree's compact leaves are
  /// better.
  bool isTooWide() const
  {
    const ObstacleVoxel& obstacle = obstacles_.front();
    const float(&half)[3] = around_.half;
    const float radius = std::sqrt((half[0] * half[0] + half[1] * half[1]) + half[2] * half[2]);
    return !(radius * obstacle.frame.stretch_a <= kWidestGroup * obstacle.sure_reach);
  }

  /// Flags a group of points: first by the leaf of b that hit the group before it, then voxel by voxel of b.
  void flag(std::uint32_t count)
  {
    if (count == 0) return;
    allowed_ += kMostStepsPerPoint * count;
    std::fill(points_ + count, std::end(points_), points_[0]);
    const LaneTag d;
    for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
      LaneVector x, y, z, record;
      hn::LoadInterleaved4(d, reinterpret_cast<const float*>(points_ + i), x, y, z, record);
      hn::Store(x, d, stored_.x + i);
      hn::Store(y, d, stored_.y + i);
      hn::Store(z, d, stored_.z + i);
    }
    open_ = firstBits(count);
    carried_to_ = nullptr;
    if (hit_in_ && compare(*hit_in_, hit_leaf_) && open_ == 0) return;
    enclose();
    if (!begun_ && isTooWide()) {
      given_up_ = true;
      return;
    }
    begun_ = true;
    const ObstacleVoxel* const before = hit_in_;
    if (before && flagIn(*before)) return;
    for (const ObstacleVoxel& obstacle : obstacles_)
      if (&obstacle != before && flagIn(obstacle)) return;
  }

  /// Flags open points that collide with one voxel of b. The leaf that a point is nearest to settles its neighbours,
  /// where most points collide; the others are compared with all leaves that are near.
  /// @pre `around_` holds the open points. @return whether the group needs no other voxel of b
  bool flagIn(const ObstacleVoxel& obstacle)
  {
    const Node& root = obstacle.voxel->nodes[0];
    approach(obstacle);
    if (nearBox(obstacle, root) == 0) return false;
    carryTo(obstacle);
    for (int before = 2 * kLeafPoints; open_ != 0 && 2 * std::popcount(open_) <= before;) {
      before = std::popcount(open_);
      const std::uint32_t target = middleOpen();
      seek(obstacle, root, {carried_.x[target], carried_.y[target], carried_.z[target], obstacle.reach, 0.0f});
    }
    if (open_ == 0 || isTooMuch()) return true;
    if (open_ != enclosed_) {
      enclose();
      approach(obstacle);
    }
    collect(obstacle, root);
    compareCollected(obstacle);
    return open_ == 0 || isTooMuch();
  }

  std::uint32_t middleOpen() const
  {
    std::uint32_t bits = open_;
    for (int below = (std::popcount(open_) - 1) / 2; below > 0; --below) bits &= bits - 1;
    return static_cast<std::uint32_t>(std::countr_zero(bits));
  }

  /// The box around the open points. Points follow each other in a line mostly: a sphere would hold far more.
  void enclose()
  {
    const LaneTag d;
    const auto middle = [&](const float* values, float& half) {
      LaneVector low = hn::Set(d, std::numeric_limits<float>::max()), high = hn::Neg(low);
      for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
        const auto is_open = laneMask(d, open_ >> i);
        const LaneVector value = hn::Load(d, values + i);
        low = hn::Min(low, hn::IfThenElse(is_open, value, low));
        high = hn::Max(high, hn::IfThenElse(is_open, value, high));
      }
      const float least = hn::GetLane(hn::MinOfLanes(d, low)), most = hn::GetLane(hn::MaxOfLanes(d, high));
      const float center = 0.5f * least + 0.5f * most;
      half = std::max(most - center, center - least) * (1.0f + kRadiusMargin) + slack_;
      return center;
    };
    around_.center = {middle(stored_.x, around_.half[0]), middle(stored_.y, around_.half[1]),
                      middle(stored_.z, around_.half[2])};
    enclosed_ = open_;
  }

  static hn::Mask<LaneTag> laneMask(LaneTag d, std::uint32_t bits)
  {
    const std::uint8_t lowest[8] = {static_cast<std::uint8_t>(bits)};
    return hn::LoadMaskBits(d, lowest);
  }

  /// Takes the box into an obstacle's frame.
  void approach(const ObstacleVoxel& obstacle)
  {
    const float* m = obstacle.frame.m.data();
    seen_.center = carryPoint(m, obstacle.frame.g.data(), around_.center);
    const float(&half)[3] = around_.half;
    for (std::size_t axis = 0; axis < 3; ++axis, m += 3)
      seen_.half[axis] = (std::abs(m[0]) * half[0] + std::abs(m[1]) * half[1]) + std::abs(m[2]) * half[2];
    ++work_.volumes_carried;
  }

  void carryTo(const ObstacleVoxel& obstacle)
  {
    if (carried_to_ == &obstacle) return;
    carry(obstacle.frame.m.data(), obstacle.frame.g.data(), stored_.x, stored_.y, stored_.z, kLeafPoints, carried_.x,
          carried_.y, carried_.z);
    carried_to_ = &obstacle;
  }

  /// Bits of a node's children that the open points may be near.
  std::uint32_t nearBox(const ObstacleVoxel& obstacle, const Node& node)
  {
    work_.node_pairs += node.count;
    return spheresNearBox(spheresOf(obstacle, node), seen_, obstacle.reach) & firstBits(node.count);
  }

  static SphereLanes spheresOf(const ObstacleVoxel& obstacle, const Node& node)
  {
    return {node.x, node.y, node.z, node.r, obstacle.frame.stretch_b};
  }

  /// Compares the open points with the leaves below a node that are near the ball, the nearest first, until some
  /// collide, or it is too much. @return whether some do
  bool seek(const ObstacleVoxel& obstacle, const Node& node, const QueryBall& ball)
  {
    alignas(32) float gap[kLanes];
    work_.node_pairs += node.count;
    std::uint32_t near = spheresNear(spheresOf(obstacle, node), ball, gap) & firstBits(node.count);
    while (near != 0 && !isTooMuch()) {
      const std::uint32_t lane = smallestLane(gap, near);
      near &= ~(1u << lane);
      if (node.isLeaf(lane) ? compare(obstacle, leafOf(obstacle, node, lane))
                            : seek(obstacle, obstacle.voxel->nodes[node.child[lane]], ball))
        return true;
    }
    return false;
  }

  /// Lists the leaves below a node that open points are near; compares them when the list is full. Ends early where it
  /// is too much.
  void collect(const ObstacleVoxel& obstacle, const Node& node)
  {
    for (std::uint32_t near = nearBox(obstacle, node); near != 0 && open_ != 0 && !isTooMuch(); near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      if (!node.isLeaf(lane)) {
        collect(obstacle, obstacle.voxel->nodes[node.child[lane]]);
        continue;
      }
      const std::uint32_t points =
          open_ & pointsNear(carried_.x, carried_.y, carried_.z, kLeafPoints, node.x[lane], node.y[lane], node.z[lane],
                             node.r[lane] * obstacle.frame.stretch_b + obstacle.reach, kSphereMargin);
      ++work_.node_pairs;
      if (points == 0) continue;
      if (collected_ == kMostCollected) compareCollected(obstacle);
      near_[collected_++] = {leafOf(obstacle, node, lane), points};
    }
  }

  /// Compares the leaves on the list, those that most open points are near first, and empties it.
  void compareCollected(const ObstacleVoxel& obstacle)
  {
    for (;;) {
      NearLeaf* best = nullptr;
      int most = 0;
      for (std::size_t k = 0; k < collected_; ++k) {
        const int points = std::popcount(near_[k].points & open_);
        if (points > most) best = near_ + k, most = points;
      }
      if (!best) break;
      best->points = 0;
      compare(obstacle, best->leaf);
    }
    collected_ = 0;
  }

  static LeafRange leafOf(const ObstacleVoxel& obstacle, const Node& node, std::uint32_t lane)
  {
    return {obstacle.voxel, node.begin[lane], node.comparedPoints(lane)};
  }

  /// Flags the open points that collide with a leaf of b. @return whether some do
  bool compare(const ObstacleVoxel& obstacle, const LeafRange& leaf)
  {
    ++work_.leaf_pairs;
    carryTo(obstacle);
    alignas(64) float nearest[kLeafPoints];
    std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
    nearestSquared(carried_, leaf.x(), leaf.y(), leaf.z(), firstBits(leaf.count), nearest);
    std::uint32_t hit = open_ & atMost(nearest, obstacle.band.hit);
    const std::uint32_t undecided = open_ & ~hit & ~above(nearest, obstacle.band.miss);
    if (query_.certain)
      hit |= compareUncertain(obstacle, leaf, nearest, {undecided, open_ & ~hit});
    else if (undecided != 0)
      eachPairNotBeyond(carried_, undecided, leaf, obstacle.band.miss, [&](std::uint32_t i, std::uint32_t j, float s) {
        if ((hit >> i & 1) == 0 && query_.pairs.collide(obstacle.frame, s, {points_[i].record, leaf.record(j)}, work_))
          hit |= 1u << i;
        return (undecided & ~hit) == 0;
      });
    if (hit == 0) return false;
    tellBits(writer_, Finding::colliding, hit, [this](std::uint32_t i) { return points_[i].record; });
    open_ &= ~hit;
    hit_in_ = &obstacle;
    hit_leaf_ = leaf;
    return true;
  }

  /// Reports which points may collide. @param nearest squared distances to the leaf @return points that surely collide
  std::uint32_t compareUncertain(const ObstacleVoxel& obstacle, const LeafRange& leaf, const float* nearest,
                                 OpenPoints open)
  {
    std::uint32_t perhaps = open.perhaps & atMost(nearest, obstacle.possible.hit);
    open.perhaps &= ~perhaps & ~above(nearest, obstacle.possible.miss);
    const OpenPoints hit = hitUncertain(
        obstacle, carried_, [this](std::uint32_t i) { return points_[i].record; }, leaf, open, query_, work_);
    perhaps = (perhaps | hit.perhaps) & ~hit.surely;
    tellBits(writer_, Finding::possible, perhaps, [this](std::uint32_t i) { return points_[i].record; });
    return hit.surely;
  }

  const Voxel& voxel_;
  const PointsView& view_;
  const std::vector<ObstacleVoxel>& obstacles_;
  const FlagQuery& query_;
  FlagWriter& writer_;
  Work& work_;
  const float slack_;

  std::uint64_t allowed_ = 0; ///< steps
  bool begun_ = false, given_up_ = false;
  PointRecord points_[kLeafPoints];
  LeafPoints stored_, carried_; ///< the group, in the frames of its voxel and of an obstacle
  const ObstacleVoxel* carried_to_ = nullptr;
  std::uint32_t open_ = 0; ///< bits of those that are not flagged
  QueryBox around_;        ///< of the points in `enclosed_`, in the frame of their voxel
  std::uint32_t enclosed_ = 0;
  QueryBox seen_; ///< the same in an obstacle's frame
  const ObstacleVoxel* hit_in_ = nullptr;
  LeafRange hit_leaf_; ///< the last one that points collided with
  NearLeaf near_[kMostCollected];
  std::size_t collected_ = 0; ///< of them
};

/// Flags the points of a voxel of a, where it lists them and this was not done before. @return whether all are flagged
inline bool flagRuns(const SphereHierarchy::Storage& a, std::uint32_t voxel,
                     const std::vector<ObstacleVoxel>& obstacles, const FlagQuery& query, FlagWriter& writer,
                     Work& work)
{
  if (query.pairs.haveRadii()) return false;
  return a.readOnce(
      voxel, [&](const Voxel& listed) { return FlagRuns(listed, a.view, obstacles, query, writer, work).run(); });
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
