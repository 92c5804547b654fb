// SPDX-License-Identifier: BSD-3-Clause
// Clusters: the cloud's hierarchy against itself, uniting sets of points. A node whose points are known to be of one
// cluster stands for all of them; a pair of such nodes of the same cluster is done.
#include <pcl_bsh/clusters/clusters.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/request_check.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/clusters/clusters.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/clusters/disjoint_sets.h>
#include <pcl_bsh/traversal/visit_pairs-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

class ClusterWalk : public PairVisitor {
public:
  ClusterWalk(const SphereHierarchy& cloud, double distance, Progress& progress)
  : PairVisitor(Watch{&progress, 1.0}),
    placed_{cloud},
    walk_(placed_, placed_),
    pairs_(placed_, placed_, distance),
    sets_(cloud.view().count),
    united_(cloud.storage().voxel_count)
  {
    united_above_.resize(cloud.storage().top.size() * kNodeChildren);
  }

  DisjointSets run(Work& work)
  {
    walk_.seed(reach(), [this](const LanePair& pair, const PairWalk::Step&, std::uint32_t) { stack_.push_back(pair); });
    nearestLast(stack_, 0);
    visitPairs(walk_, stack_, *this);
    work = walk_.work;
    return std::move(sets_);
  }

  // As visitPairs() asks.

  double reach() const { return pairs_.reach.length(); }

  Next visit(const LanePair& pair) { return settled(pair) ? Next::prune : Next::go_on; }

  Next opened(const LanePair& pair, Opened opened, const PairWalk::Step& step)
  {
    parent_united_ = united(opened == Opened::a ? pair.a : pair.b) != 0;
    inside_ = step.inside(reach());
    return Next::go_on;
  }

  bool keep(LanePair& child, Opened opened, const PairWalk::Step&, std::uint32_t lane)
  {
    if (parent_united_) united(opened == Opened::a ? child.a : child.b) = 1;
    if ((inside_ >> lane & 1u) == 0) return true;
    unite(child);
    return false;
  }

  Next compare(const LanePair& pair)
  {
    compareLeaves(pair);
    return Next::go_on;
  }

private:
  /// Whether nothing below the pair can join two clusters any more.
  bool settled(const LanePair& pair)
  {
    return isOneCluster(pair.a) && isOneCluster(pair.b) &&
           sets_.find(anyRecord(pair.a)) == sets_.find(anyRecord(pair.b));
  }

  bool isOneCluster(const Lane& lane)
  {
    std::uint8_t& known = united(lane);
    if (known != 0 || !walk_.isLeaf(walk_.a, lane)) return known != 0;
    const Node& node = walk_.nodeOf(walk_.a, lane);
    const std::uint32_t* records = walk_.a.storage.voxels[lane.space].records();
    const std::uint32_t first = sets_.find(records[node.begin[lane.lane]]);
    for (std::uint32_t i = node.begin[lane.lane]; i < node.begin[lane.lane + 1]; ++i)
      if (sets_.find(records[i]) != first) return false;
    known = 1;
    return true;
  }

  /// Every point of one lane is within the distance of every point of the other: all are of one cluster.
  void unite(const LanePair& pair)
  {
    const std::uint32_t anchor = anyRecord(pair.a);
    for (const Lane& lane : {pair.a, pair.b}) {
      if (united(lane) != 0)
        sets_.unite(anchor, anyRecord(lane));
      else
        eachRecord(lane, [&](std::uint32_t record) { sets_.unite(anchor, record); });
      united(lane) = 1;
    }
  }

  void compareLeaves(const LanePair& pair)
  {
    const Node &node_a = walk_.nodeOf(walk_.a, pair.a), &node_b = walk_.nodeOf(walk_.b, pair.b);
    if (node_a.lowest[pair.a.lane] > node_b.lowest[pair.b.lane]) return; // its mirror image is compared
    const ComparedLeaves leaves = walk_.compare(pair);
    const LeafRange &a = leaves.a, &b = leaves.b;
    uniteCoincident(a, node_a.points(pair.a.lane)); // of each leaf: it meets itself, too
    const DistanceBand band = leaves.frame.band(reach());
    const auto found = [&](std::uint32_t i, std::uint32_t j, bool surely) {
      const std::uint32_t p = a.record(i), q = b.record(j);
      if (sets_.find(p) != sets_.find(q) && (surely || withinDistance({p, q}))) sets_.unite(p, q);
      return false;
    };
    if (pairs_.ofTriangles())
      eachBallPairNear(leaves.frame, leaves.points, leaves.near, a, b, reach(), pairs_.surelyOfBalls(),
                       [&](std::uint32_t i, std::uint32_t j, float, bool surely) { return found(i, j, surely); });
    else
      eachPairNotBeyond(leaves.points, leaves.near, b, band.miss, [&](std::uint32_t i, std::uint32_t j, float squared) {
        return found(i, j, squared <= band.hit);
      });
  }

  /// Unites points of a leaf that coincide: only one of them is compared, and answers for all.
  void uniteCoincident(const LeafRange& leaf, std::uint32_t points)
  {
    const std::uint32_t* records = leaf.voxel->records() + leaf.begin;
    for (std::uint32_t i = leaf.count; i < points; ++i) sets_.unite(records[0], records[i]);
  }

  bool withinDistance(PointPair pair)
  {
    ++walk_.work.exact_decisions;
    return pairs_.distance.compare(pair, RecordDistance::Sum{reach()}) <= 0;
  }

  std::uint8_t& united(const Lane& lane)
  {
    if (lane.space == kAboveVoxels) return united_above_[lane.node * kNodeChildren + lane.lane];
    std::vector<std::uint8_t>& of_voxel = united_[lane.space];
    if (of_voxel.empty()) of_voxel.resize(walk_.a.storage.voxels[lane.space].nodes.size() * kNodeChildren);
    return of_voxel[lane.node * kNodeChildren + lane.lane];
  }

  std::uint32_t anyRecord(const Lane& lane) const { return walk_.nodeOf(walk_.a, lane).lowest[lane.lane]; }

  template <class Use>
  void eachRecord(const Lane& lane, const Use& use)
  {
    const Node& node = walk_.nodeOf(walk_.a, lane);
    const std::uint32_t begin = node.begin[lane.lane], end = node.begin[lane.lane + 1];
    if (lane.space != kAboveVoxels) {
      const std::uint32_t* records = walk_.a.storage.voxels[lane.space].records();
      std::for_each(records + begin, records + end, use);
      return;
    }
    for (std::uint32_t v = begin; v < end; ++v) {
      const Voxel& voxel = walk_.a.voxel(v, walk_.work);
      std::for_each(voxel.records(), voxel.records() + voxel.count, use);
    }
  }

  const Placed placed_; ///< the walk refers to its pose
  PairWalk walk_;
  PointPairs pairs_;
  DisjointSets sets_;
  std::vector<std::vector<std::uint8_t>> united_; ///< per voxel, per lane of its nodes: known to be of one cluster
  std::vector<std::uint8_t> united_above_;
  std::vector<LanePair> stack_;
  bool parent_united_ = false; ///< whether the node whose children are tested is known to be of one cluster
  std::uint32_t inside_ = 0;   ///< bits of its children: each point is within reach of all of the other node's
};

} // namespace

DisjointSets clusterOnTarget(const SphereHierarchy& cloud, double distance, Progress& progress, Work& work)
{
  return ClusterWalk(cloud, distance, progress).run(work);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(clusterOnTarget);

namespace {

void requireDistance(double distance)
{
  if (std::isfinite(distance) && distance >= 0.0) return;
  throw InvalidInput(Input::cluster_distance, "distance", plainText(distance), "give a finite length >= 0")
      .withValue(distance);
}

std::vector<std::uint32_t> finiteRecords(const PointsView& view)
{
  std::vector<std::uint32_t> records;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Point3 p = view.point(view.record(i));
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) records.push_back(view.record(i));
  }
  std::sort(records.begin(), records.end());
  records.erase(std::unique(records.begin(), records.end()), records.end());
  return records;
}

/// @param result whose memory is used again
void number(DisjointSets sets, const PointsView& view, Clusters& result)
{
  result.sizes.clear();
  result.of.assign(view.count, kNothing);
  Pulse pulse;
  for (const std::uint32_t record : finiteRecords(view)) {
    pulse.count(1);
    std::int32_t& root = result.of[sets.find(record)]; // the smallest of its set: comes first
    if (root == kNothing) {
      root = static_cast<std::int32_t>(result.sizes.size());
      result.sizes.push_back(0);
    }
    result.of[record] = root;
    ++result.sizes[static_cast<std::size_t>(root)];
  }
}

} // namespace

Clusters euclideanClusters(const SphereHierarchy& cloud, double distance, const Effort& effort)
{
  Clusters result;
  euclideanClusters(cloud, distance, result, effort);
  return result;
}

void euclideanClusters(const SphereHierarchy& cloud, double distance, Clusters& result, const Effort& effort)
{
  requireDistance(distance);
  checkExact(effort);
  const DefaultFloatEnvironment environment;
  Progress progress(effort.progress);
  Clusters found = std::exchange(result, {}); // should something throw, it is empty
  found.work = {};
  DisjointSets sets = HWY_DYNAMIC_DISPATCH(clusterOnTarget)(cloud, distance, progress, found.work);
  progress.finish();
  number(std::move(sets), cloud.view(), found);
  result = std::move(found);
}

} // namespace pcl_bsh
#endif
