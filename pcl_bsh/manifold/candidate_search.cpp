// SPDX-License-Identifier: BSD-3-Clause
// Best first by bounds of scores. Pairs of nodes and of records wait in a list that is kept from goal to goal, so that
// none is opened twice.
#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/manifold/candidate_search.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/manifold/candidate_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/traversal/visit_pairs-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A pair of nodes, as lanes of their parents, and the sphere of the probe's node in the world.
struct WaitingNodes {
  LanePair lanes;
  Eigen::Vector3d middle;
  double radius, slack, least_gap;
  bool is_measured = false; ///< leaves whose points have bounded the gap
  bool is_opened = false;
};
struct WaitingRecords {
  PointPair pair;
  Eigen::Vector3d place;
  double least_gap;
  bool is_known; ///< least_gap is the gap
  bool is_beyond = false;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};
struct NearRecord {
  PointPair pair;
  double least_gap, most_gap;
};
/// Memory of one search after another.
struct ChannelScratch {
  std::vector<WaitingNodes> nodes;
  std::vector<WaitingRecords> records;
  std::vector<NearRecord> of_leaf; ///< that is compared
  std::vector<SearchTurn> order;
};

/// To be had by a ScratchLease.
struct CandidateScratch {
  std::array<ChannelScratch, kMostChannels> of_channels;
  std::size_t bytes() const noexcept
  {
    std::size_t all = 0;
    for (const ChannelScratch& one : of_channels)
      all += one.nodes.capacity() * sizeof(WaitingNodes) + one.records.capacity() * sizeof(WaitingRecords) +
             one.of_leaf.capacity() * sizeof(NearRecord) + one.order.capacity() * sizeof(SearchTurn);
    return all;
  }
};

class ChannelSearch {
public:
  ChannelSearch(const Channel& channel, double most_gap, double thickness, ChannelScratch& scratch)
  : channel_(channel),
    walk_(channel.probe, channel.surface),
    most_gap_(most_gap),
    thickness_(thickness),
    // A rounded distance, less the thickness, is no greater than the greatest gap only within this.
    reach_(std::nextafter(most_gap + thickness + 0x1p-50 * (most_gap + thickness), kInfinity)),
    pairs_(channel.probe, channel.surface, reach_),
    nodes_(scratch.nodes),
    records_(scratch.records),
    of_leaf_(scratch.of_leaf),
    order_(scratch.order)
  {
    nodes_.clear();
    records_.clear();
    of_leaf_.clear();
    walk_.makeWholes();
    walk_.seedWhole(reach_, [this](LanePair pair, const PairWalk::Step& step) {
      alignas(32) float keys[kLanes];
      walk_.boundKeys(pair, step, keys);
      pair.key = keys[0];
      wait(pair);
    });
  }

  void seek(const PatchGoal& goal, Candidate& best, Work& work)
  {
    order_.clear();
    for (std::size_t i = 0; i < nodes_.size(); ++i) consider(boundOf(goal, nodes_[i]), {i, false}, best);
    for (std::size_t i = 0; i < records_.size(); ++i) consider(boundOf(goal, records_[i]), {i, true}, best);
    std::make_heap(order_.begin(), order_.end());
    SearchPulse pulse({}, order_.size(), walk_.work);
    while (!order_.empty() && !(order_.front().bound < best.score)) {
      pulse.step(order_.size());
      const SearchTurn turn = order_.front();
      std::pop_heap(order_.begin(), order_.end());
      order_.pop_back();
      if (turn.of.second)
        decide(goal, records_[turn.of.first], best);
      else
        open(goal, turn.of.first, best);
    }
    forgetOpened();
    work += std::exchange(walk_.work, Work());
  }

private:
  static double down(double x) { return x - std::abs(x) * 0x1p-52 - std::numeric_limits<double>::denorm_min(); }

  double boundOf(const PatchGoal& goal, const WaitingNodes& nodes)
  {
    const double bound = goal.bound(nodes.middle, nodes.radius, nodes.slack, nodes.least_gap);
    if (bound == -kInfinity || !goal.hasEndedPatches() || !walk_.haveSlabs(nodes.lanes.a, nodes.lanes.b)) return bound;
    // A leaf of a flat face may reach farther across its patch than the patch is high, but hardly along the patch's
    // normal.
    const WorldSlab slab = worldSlabOf(walk_, walk_.a, nodes.lanes.a, nodes.radius);
    if (slab.normal.isZero(0.0)) return bound;
    const double margin = static_cast<double>(kSlabMargin) * nodes.radius;
    const auto reach = [&](const Eigen::Vector3d& n) { return slab.support(n) + margin + nodes.slack; };
    return goal.isTaken(nodes.middle, nodes.slack, reach) ? -kInfinity : bound;
  }
  static double boundOf(const PatchGoal& goal, const WaitingRecords& records)
  {
    return goal.score(records.place, records.least_gap);
  }

  bool consider(double bound, std::pair<std::size_t, bool> of, const Candidate& best)
  {
    if (bound < best.score || bound == -kInfinity) return false;
    order_.push_back({bound, of});
    return true;
  }

  template <class Waiting>
  void enter(const PatchGoal& goal, const std::vector<Waiting>& all, std::size_t from, const Candidate& best)
  {
    for (std::size_t i = from; i < all.size(); ++i)
      if (consider(boundOf(goal, all[i]), {i, std::is_same_v<Waiting, WaitingRecords>}, best))
        std::push_heap(order_.begin(), order_.end());
  }

  void wait(const LanePair& lanes)
  {
    const Node& node = walk_.nodeOf(walk_.a, lanes.a);
    const LocalFrame& frame = walk_.a.frame(lanes.a.space);
    const std::uint32_t of = lanes.a.lane;
    Eigen::Vector3d middle(node.x[of], node.y[of], node.z[of]);
    for (int k = 0; k < 3; ++k) middle[k] = middle[k] * frame.unit + frame.origin[static_cast<std::size_t>(k)];
    const double size = middle.norm(), radius = double{node.r[of]} * frame.unit * (1.0 + 0x1p-18);
    middle = walk_.a.pose * middle;
    const double slack = kDoubleMargin * (size + walk_.a.pose.translation().norm() + middle.norm() + radius);
    // An edge may lie beyond the other one, with a gap less than 0: the distance of the spheres does not bound it.
    const double least = channel_.isOfEdges() ? -most_gap_ - 2 * thickness_ : down(lanes.key - thickness_);
    nodes_.push_back({lanes, middle, radius, slack, least});
  }

  void open(const PatchGoal& goal, std::size_t index, const Candidate& best)
  {
    const LanePair pair = nodes_[index].lanes;
    const Opened opened = walk_.choose(pair);
    if (opened == Opened::neither && measures() && !std::exchange(nodes_[index].is_measured, true)) {
      nodes_[index].is_opened = !measure(nodes_[index]);
      if (!nodes_[index].is_opened && consider(boundOf(goal, nodes_[index]), {index, false}, best))
        std::push_heap(order_.begin(), order_.end());
      return;
    }
    nodes_[index].is_opened = true;
    const std::size_t nodes = nodes_.size(), records = records_.size();
    if (opened == Opened::neither) {
      compare(pair);
      enter(goal, records_, records, best);
      return;
    }
    walk_.step<true>(pair, opened, std::max(reach_, 0.0), step_);
    if (step_.near == 0) return;
    alignas(32) float keys[kLanes];
    walk_.boundKeys(PairWalk::childOf(pair, opened, step_, 0), step_, keys);
    for (std::uint32_t near = step_.near; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      LanePair child = PairWalk::childOf(pair, opened, step_, lane);
      child.key = std::max(keys[lane], pair.key);
      if (child.key <= reach_) wait(child);
    }
    enter(goal, nodes_, nodes, best);
  }

  /// Whether points bound how near two leaves are.
  bool measures() const { return !walk_.haveTriangles() && !pairs_.haveRadii(); }

  /// Bounds the gap of two leaves by that of their points in floats. Most leaves are as near as the best candidate by
  /// their spheres and slabs, but none of their points is: pairs of such points never become records.
  /// @return whether any points may be within the reach
  bool measure(WaitingNodes& leaves_waiting)
  {
    const ComparedLeaves leaves = walk_.compare(leaves_waiting.lanes, reach_);
    float least = std::numeric_limits<float>::infinity();
    bool is_bounded = true;
    const float miss = leaves.frame.band(reach_).miss;
    eachPairNotBeyond(leaves.points, leaves.near, leaves.b, miss, [&](std::uint32_t, std::uint32_t, float squared) {
      if (squared > miss) return false;
      is_bounded = is_bounded && squared >= 0.0f; // not where squares leave the range of floats
      least = std::min(least, squared);
      return false;
    });
    if (is_bounded && least > miss) return false;
    const double apart = std::sqrt(static_cast<double>(least)) * leaves.frame.unit() * (1.0 - 0x1p-20);
    if (is_bounded && leaves.frame.band(apart).miss < least)
      leaves_waiting.least_gap = std::max(leaves_waiting.least_gap, down(apart - thickness_));
    return true;
  }

  void compare(const LanePair& pair)
  {
    const ComparedLeaves leaves = walk_.compare(pair, reach_);
    if (leaves.near == 0) return;
    const auto found = [&](std::uint32_t i, std::uint32_t j) {
      if (channel_.isOfEdges())
        addEdges({leaves.a.record(i), leaves.b.record(j)});
      else
        add({leaves.a.record(i), leaves.b.record(j)});
      return false;
    };
    if (walk_.haveTriangles()) {
      eachPairNearTriangles(
          leaves, walk_.a.storage.view, walk_.b.storage.view, walk_.flat(), [this] { return reach_; }, found);
    }
    else if (pairs_.haveRadii()) {
      eachBallPairNear(leaves.frame, leaves.points, leaves.near, leaves.a, leaves.b, reach_, -kInfinity,
                       [&](std::uint32_t i, std::uint32_t j, float, bool) { return found(i, j); });
    }
    else {
      const float miss = leaves.frame.band(reach_).miss;
      eachPairNotBeyond(
          leaves.points, leaves.near, leaves.b, miss,
          [&](std::uint32_t i, std::uint32_t j, float squared) { return !(squared > miss) && found(i, j); });
    }
    addNearestOfLeaf();
  }

  void add(PointPair pair)
  {
    if (!channel_.enclosed.empty() && channel_.enclosed[pair.a]) return;
    const RecordDistance::Pair posed = pairs_.posed(pair);
    const auto [low, high] = pairs_.distance.enclose(posed);
    if (!std::isfinite(high)) {
      const double gap = pairs_.distance.gap(posed) - thickness_;
      if (gap <= most_gap_) records_.push_back({pair, probePlace(channel_, pair.a), gap, true});
      return;
    }
    const double radii = posed.radius_p + posed.radius_q, rounding = kFewDoubleRoundings * (high + radii);
    const double least = down(down(low - radii - rounding) - thickness_);
    if (least <= most_gap_) of_leaf_.push_back({pair, least, high - radii + 2 * rounding - thickness_});
  }

  /// Keeps records that may be the nearest one of their probe in the leaf: no other is the best candidate.
  void addNearestOfLeaf()
  {
    std::sort(of_leaf_.begin(), of_leaf_.end(), [](const NearRecord& l, const NearRecord& r) {
      return l.pair.a != r.pair.a ? l.pair.a < r.pair.a : l.least_gap < r.least_gap;
    });
    for (std::size_t i = 0, end = 0; i < of_leaf_.size(); i = end) {
      double most = kInfinity;
      for (end = i; end < of_leaf_.size() && of_leaf_[end].pair.a == of_leaf_[i].pair.a; ++end)
        most = std::min(most, of_leaf_[end].most_gap);
      const Eigen::Vector3d place = probePlace(channel_, of_leaf_[i].pair.a);
      for (std::size_t k = i; k < end && of_leaf_[k].least_gap <= most; ++k)
        records_.push_back({of_leaf_[k].pair, place, of_leaf_[k].least_gap, false});
    }
    of_leaf_.clear();
  }

  void addEdges(PointPair pair)
  {
    const auto crossing = crossingOf(channel_, pair);
    if (!crossing) return;
    ++walk_.work.exact_decisions;
    const double apart = pairs_.distance.gap(pair);
    const bool is_beyond = crossing->normal.dot(crossing->on_probe - crossing->on_surface) < 0.0;
    if (!(apart <= most_gap_ + thickness_)) return;
    const double gap = (is_beyond ? -apart : apart) - thickness_;
    records_.push_back({pair, crossing->on_probe, gap, true, is_beyond, crossing->normal});
  }

  void decide(const PatchGoal& goal, WaitingRecords& of, Candidate& best)
  {
    if (!of.is_known) {
      ++walk_.work.exact_decisions;
      of.least_gap = pairs_.distance.gap(of.pair) - thickness_;
      of.is_known = true;
    }
    const Candidate candidate{
        goal.score(of.place, of.least_gap), of.least_gap, channel_.number, of.pair, of.is_beyond, of.place, of.normal};
    if (candidate.isThere() && candidate.isBefore(best)) best = candidate;
  }

  void forgetOpened()
  {
    nodes_.erase(std::remove_if(nodes_.begin(), nodes_.end(), [](const WaitingNodes& one) { return one.is_opened; }),
                 nodes_.end());
  }

  const Channel& channel_;
  PairWalk walk_;
  const double most_gap_, thickness_, reach_;
  const PointPairs pairs_;
  PairWalk::Step step_;
  std::vector<WaitingNodes>& nodes_;
  std::vector<WaitingRecords>& records_;
  std::vector<NearRecord>& of_leaf_;
  std::vector<SearchTurn>& order_;
};

class SearchOfAll final : public CandidateSearch {
public:
  SearchOfAll(const std::vector<Channel>& channels, double most_gap, double thickness)
  {
    for (std::size_t i = 0; i < channels.size(); ++i)
      searches_[i].emplace(channels[i], most_gap, thickness, (*scratch_).of_channels[i]);
  }

  void seek(const PatchGoal& goal, Candidate& best, Work& work) override
  {
    for (std::optional<ChannelSearch>& search : searches_)
      if (search) search->seek(goal, best, work);
  }

private:
  const ScratchLease<CandidateScratch> scratch_;
  std::array<std::optional<ChannelSearch>, kMostChannels> searches_;
};

} // namespace

void searchOnTarget(const std::vector<Channel>& channels, double most_gap, double thickness,
                    const std::function<void(CandidateSearch&)>& choose)
{
  SearchOfAll search(channels, most_gap, thickness);
  choose(search);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(searchOnTarget);

void searchCandidates(const std::vector<Channel>& channels, double most_gap, double thickness,
                      const std::function<void(CandidateSearch&)>& choose)
{
  HWY_DYNAMIC_DISPATCH(searchOnTarget)(channels, most_gap, thickness, choose);
}

} // namespace pcl_bsh
#endif
