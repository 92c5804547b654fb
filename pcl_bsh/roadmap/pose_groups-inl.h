// SPDX-License-Identifier: BSD-3-Clause
// Two hierarchies at a group of poses: what is apart at the middle pose by more than the clearance and the group's
// motion is apart at all of them.

#if defined(PCL_BSH_ROADMAP_POSE_GROUPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_ROADMAP_POSE_GROUPS_INL_H_
#undef PCL_BSH_ROADMAP_POSE_GROUPS_INL_H_
#else
#define PCL_BSH_ROADMAP_POSE_GROUPS_INL_H_
#endif

#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/roadmap/pose_batch.h>
#include <pcl_bsh/traversal/pair_walk-inl.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// Pairs of nodes that may meet, each node as a sphere, in columns: all of them are tested at a pose at once.
class NodePairs {
public:
  explicit NodePairs(const Eigen::Isometry3d& T_world_a) : T_world_a_(T_world_a) {}

  std::size_t size() const { return lanes_.size(); }
  const LanePair& lanes(std::size_t i) const { return lanes_[i]; }

  /// The sum of both radii, and what roundings add.
  double radius(std::size_t i) const { return columns_[kRadius][i]; }

  /// Of the larger node that can be opened; 0 where both are leaves.
  double larger(std::size_t i) const { return larger_[i]; }

  /// Spheres hold the points as given, too. Each coordinate of a centre is rounded less than 16 times on its way to the
  /// other one: 2^-46 of all that is added covers that. (What the pose of b adds is covered by findNear().)
  void add(const PairWalk& walk, const LanePair& lanes)
  {
    double radius[2];
    const Eigen::Vector3d a = place(walk.a, lanes.a, radius[0]), b = place(walk.b, lanes.b, radius[1]);
    const Eigen::Vector3d at = T_world_a_ * a;
    const double added = a.lpNorm<1>() + b.lpNorm<1>() + at.lpNorm<1>() + T_world_a_.translation().lpNorm<1>();
    const bool leaf_a = walk.isLeaf(walk.a, lanes.a), leaf_b = walk.isLeaf(walk.b, lanes.b);
    lanes_.push_back(lanes);
    larger_.push_back(std::max(leaf_a ? 0.0 : radius[0], leaf_b ? 0.0 : radius[1]));
    const double row[kColumns] = {at.x(),
                                  at.y(),
                                  at.z(),
                                  b.x(),
                                  b.y(),
                                  b.z(),
                                  (radius[0] + radius[1]) * (1.0 + 2 * kPoseStretch) + added * 0x1p-46 +
                                      kVanishingLength};
    for (std::size_t k = 0; k < kColumns; ++k) columns_[k].push_back(row[k]);
  }

  void addCopy(std::size_t i)
  {
    lanes_.push_back(LanePair(lanes_[i]));
    larger_.push_back(double{larger_[i]});
    for (auto& column : columns_) column.push_back(double{column[i]});
  }

  void removeByLast(std::size_t i)
  {
    lanes_[i] = lanes_.back();
    larger_[i] = larger_.back();
    for (auto& column : columns_) column[i] = column.back();
    resize(size() - 1);
  }

  void resize(std::size_t count)
  {
    lanes_.resize(count);
    larger_.resize(count);
    for (auto& column : columns_) column.resize(count);
  }

  /// Calls near(i, squared distance of the centres) for those pairs from `from` on that are not proven to be farther
  /// apart than `reach`, b standing at this pose.
  template <class Near>
  void findNear(const Eigen::Isometry3d& T_world_b, double reach, std::size_t from, const Near& near)
  {
    const std::size_t end = size();
    squared_.resize(end);
    const Eigen::Matrix3d r = T_world_b.linear();
    const Eigen::Vector3d t = T_world_b.translation();
    measure(r, t, from, end);
    const double limit = reach * (1.0 + 0x1p-40) + t.lpNorm<1>() * 0x1p-46;
    for (std::size_t i = from; i < end; ++i) {
      const double apart = (limit + columns_[kRadius][i]) * (1.0 + 0x1p-40);
      if (!(squared_[i] > apart * apart + kVanishingLength)) near(i, squared_[i]);
    }
  }

private:
  static constexpr std::size_t kColumns = 7, kRadius = 6;

  static Eigen::Vector3d place(const Spaces& side, const Lane& lane, double& radius)
  {
    const LocalFrame& frame = side.frame(lane.space);
    const Node& node = side.node(lane.space, lane.node);
    radius = static_cast<double>(node.r[lane.lane]) * frame.unit;
    const Eigen::Vector3d local(node.x[lane.lane], node.y[lane.lane], node.z[lane.lane]);
    return Eigen::Vector3d(frame.origin[0], frame.origin[1], frame.origin[2]) + frame.unit * local;
  }

  void measure(const Eigen::Matrix3d& r, const Eigen::Vector3d& t, std::size_t from, std::size_t end)
  {
    const double r00 = r(0, 0), r01 = r(0, 1), r02 = r(0, 2), r10 = r(1, 0), r11 = r(1, 1), r12 = r(1, 2),
                 r20 = r(2, 0), r21 = r(2, 1), r22 = r(2, 2), t0 = t[0], t1 = t[1], t2 = t[2];
    const double *const ax = columns_[0].data(), *const ay = columns_[1].data(), *const az = columns_[2].data();
    const double *const bx = columns_[3].data(), *const by = columns_[4].data(), *const bz = columns_[5].data();
    double* HWY_RESTRICT const squared = squared_.data();
    for (std::size_t i = from; i < end; ++i) { // vectorised by the compiler
      const double x = r00 * bx[i] + r01 * by[i] + r02 * bz[i] + t0 - ax[i];
      const double y = r10 * bx[i] + r11 * by[i] + r12 * bz[i] + t1 - ay[i];
      const double z = r20 * bx[i] + r21 * by[i] + r22 * bz[i] + t2 - az[i];
      squared[i] = x * x + y * y + z * z;
    }
  }

  const Eigen::Isometry3d& T_world_a_;
  std::vector<LanePair> lanes_;
  std::vector<double> larger_;
  std::array<std::vector<double>, kColumns> columns_; ///< centre of a in the world, of b in its frame; both radii
  std::vector<double> squared_;
};

/// A group has so many parts.
inline constexpr std::size_t kPartsOfGroup = 4;

/// Pairs at which a group stops to open nodes: each of its poses tests all of them. What is opened for more poses pays
/// more often.
inline constexpr std::size_t mostPairs(std::size_t poses)
{
  return 32 + 8 * poses;
}

/// A group that moves by more than this share of the larger body's radius opens no nodes: it would leave out few of
/// them, and each of its poses would have to test them all.
inline constexpr double kWidestMotion = 0.5;

/// Divides the poses of a batch into smaller and smaller groups, and hands on from each to its parts the pairs of nodes
/// that may still meet.
/// @tparam Decide decide(i, pairs, from) is called for the poses at which pairs are left, those from `from` on; at
///   other poses nothing collides
template <class Decide>
class PoseGroups {
public:
  PoseGroups(const PoseBatch& batch, double clearance, Decide decide)
  : batch_(batch),
    pairs_(batch.a.pose),
    clearance_(clearance),
    widest_(kWidestMotion * std::max(batch.body.radius, BodyBall(batch.a.hierarchy()).radius)),
    decide_(std::move(decide))
  {
  }

  Work run()
  {
    const std::size_t count = batch_.poses.size(), middle = count / 2;
    const Placed b{batch_.b, batch_.poses[middle]};
    {
      PairWalk walk(batch_.a, b);
      walk.seed(clearance_ + motionAround(middle, 0, count, std::numeric_limits<double>::infinity()),
                [&](const LanePair& pair, const PairWalk::Step&, std::uint32_t) { pairs_.add(walk, pair); });
      work_ += walk.work;
    }
    if (pairs_.size() != 0) visit(0, count, 0);
    return work_;
  }

private:
  /// @return as far as it is known where it exceeds `most`
  double motionAround(std::size_t middle, std::size_t begin, std::size_t end, double most) const
  {
    double motion = 0.0;
    for (std::size_t i = begin; i < end && !(motion > most); ++i)
      motion = std::max(motion, motionBound(batch_.body, batch_.poses[middle], batch_.poses[i]) +
                                    (batch_.motions ? batch_.motions->extents[i] : 0.0));
    return motion;
  }

  /// @param from where the pairs begin that may meet at these poses
  void visit(std::size_t begin, std::size_t end, std::size_t from)
  {
    pulse_.look();
    if (end - begin == 1) return decide_(begin, pairs_, from);
    const std::size_t own = pairs_.size(), middle = begin + (end - begin) / 2;
    const double motion = motionAround(middle, begin, end, widest_);
    const bool opens = motion <= widest_;
    if (opens) refine(begin, end, from, motion);
    const std::size_t first = opens ? own : from;
    if (pairs_.size() != first) {
      const std::size_t part = (end - begin + kPartsOfGroup - 1) / kPartsOfGroup;
      for (std::size_t i = begin; i < end; i += part) visit(i, std::min(end, i + part), first);
    }
    pairs_.resize(own);
  }

  /// Appends the pairs, of those from `from` on or below them, which may meet at any of these poses. A node much
  /// smaller than the motion is not opened: its children are as near as it is.
  void refine(std::size_t begin, std::size_t end, std::size_t from, double motion)
  {
    const std::size_t middle = begin + (end - begin) / 2, own = pairs_.size();
    const double reach = clearance_ + motion;
    const Placed b{batch_.b, batch_.poses[middle]};
    bool opens = false;
    work_.node_pairs += own - from;
    pairs_.findNear(b.pose, reach, from, [&](std::size_t i, double) {
      opens = opens || pairs_.larger(i) > motion;
      pairs_.addCopy(i);
    });
    if (!opens) return;
    const std::size_t most = own + mostPairs(end - begin);
    PairWalk walk(batch_.a, b);
    PairWalk::Step step;
    for (std::size_t i = own; i < pairs_.size() && pairs_.size() < most;) {
      if (!(pairs_.larger(i) > motion)) {
        ++i;
        continue;
      }
      const LanePair pair = pairs_.lanes(i);
      const Opened opened = walk.choose(pair);
      walk.step(pair, opened, reach, step);
      pairs_.removeByLast(i);
      for (std::uint32_t near = step.near; near != 0; near &= near - 1)
        pairs_.add(walk, PairWalk::childOf(pair, opened, step, static_cast<std::uint32_t>(std::countr_zero(near))));
    }
    work_ += walk.work;
  }

  const PoseBatch& batch_;
  NodePairs pairs_; ///< of the groups from the batch down to the present one, after each other
  const double clearance_;
  const double widest_; ///< motion of a group that opens nodes
  Decide decide_;
  Work work_;
  WorkPulse pulse_{work_};
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
