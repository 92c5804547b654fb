// SPDX-License-Identifier: BSD-3-Clause
// Along a trajectory: every node of the scan carries the list of what can still matter of the model, for an interval of
// poses at once. Seen by the model, the scan's points move in nearly straight lines: a node is a thick segment, the
// model a tree of boxes. How thick follows from the node's sphere and from how far the interval strays from a line;
// whichever is larger is divided.
#include <pcl_bsh/hierarchy/parallel.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/query/trajectory_walk.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>
#include <thread>
#include <tuple>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/query/trajectory.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/query/leaf_pair-inl.h>
#include <pcl_bsh/simd/segment_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNodeStray = 0.5;       // of a node's radius: an interval that strays farther is divided
constexpr double kLeafStray = 0.15;      // of a leaf's
constexpr double kManyPosesStray = 0.08; // likewise, where it has many poses
constexpr float kManyPoses = 64;
constexpr float kFewPoses = 4;   // as quickly looked at one by one as all together
constexpr double kBoxSize = 1.0; // of a node's radius: a larger box of the model is opened

/// A box of the model: a child of one of a voxel's nodes, or of the nodes above the voxels.
struct Candidate {
  const BoxNode* boxes;
  const Node* nodes;
  std::uint32_t voxel;
  std::uint32_t node;
  std::uint32_t lane;

  const BoxNode& box() const { return boxes[node]; }
  bool isLeaf() const { return voxel != kAboveVoxels && nodes[node].isLeaf(lane); }
  float size() const
  {
    float largest = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest = std::max(largest, box().high[axis][lane] - box().low[axis][lane]);
    return 0.5f * largest;
  }
};

/// How points of the scan's voxel are seen by the model: y = m x + g.
struct Sight {
  float m[9], g[3];
};

/// An interval of poses, as the scan's voxel moves during it.
struct Span {
  const PathInterval* interval;
  Sight from, to;
  double stray;   ///< of any point of the voxel from its straight line
  float steps;    ///< poses after the first; 0 where all instants count
  float reach;    ///< of points: within this of a straight line, in floats, is all that collides
  float smallest; ///< motion that floats can tell from none
  float rounding; ///< of places in floats
};

/// One node of the scan on its way through the model, its children tested all at once.
struct Visit {
  Segments<kLanes> children;
  Segment around;
  float radius[kLanes];
  std::vector<Candidate> near[kLanes];
};

/// A leaf of the scan, its points tested all at once.
struct LeafVisit {
  LeafRange points;
  std::size_t slot;   ///< of its flags
  std::uint32_t open; ///< bits of the points that are not settled
  Segments<kLeafPoints> ways;
  Ways<kLeafPoints> motions;
  Segment around;
};

/// The nearest point of the model, so far.
struct Best {
  double time = 0.0;      ///< pose of the path; swept: and fraction of the way to the next
  double gap = kInfinity; ///< swept: the distance
  std::uint32_t record = 0xffffffffu;
  float limit = kInfinity; ///< a larger squared distance is none better
  float reach = kInfinity; ///< the same, as a distance
};

/// What a thread keeps from voxel to voxel, for its storage.
struct Scratch {
  std::deque<Visit> visits;
  std::vector<Candidate> stack, seed;
  std::vector<std::uint8_t> open_lanes;    ///< per node: children that are not settled
  std::vector<std::uint16_t> hit, settled; ///< per child of a node that is a leaf: bits of its points
  std::vector<double> first;               ///< per point: when it collides first
  std::vector<Best> best;                  ///< per point
  std::vector<std::uint16_t> pose_hits;    ///< per pose of a span: points of a leaf
};

class TrajectoryWalk {
public:
  TrajectoryWalk(const Course& course, std::uint32_t voxel, Scratch& scratch)
  : course_(course),
    path_(course.path),
    tree_(course.boxes),
    scan_(course.scan),
    frame_(scan_.frame(voxel)),
    voxel_(&scan_.storage.voxels[voxel]),
    origin_(carried(course.scan.pose, frame_.origin)),
    radius_(voxel_->radius * frame_.unit),
    index_(voxel),
    scratch_(scratch)
  {
    double slack = 0.0;
    for (int k = 0; k < 3; ++k) slack += frame_.slack(k) * frame_.slack(k);
    slack = std::sqrt(slack) * (1.0 + 0x1p-40) * frame_.unit;
    const double skew = path_.skew;
    placing_ = course.error(origin_) + (1.0 + skew) * (slack + tree_.voxel_slack);
    // No farther from each other than this are the origins of two voxels whose points collide, along each axis.
    far_ = (radius_ + course.reach) * (1.0 + skew) + placing_ + tree_.voxel_reach;
    error_ = placing_ + 4.001 * kFloatUnit * 1.7321 * (far_ + 1.7321 * (1.0 + skew) * radius_) + 0x1p-60;
    band_ = distanceBand(course.request.clearance, error_, skew);
  }

  VoxelAnswer run(const std::vector<std::uint32_t>& intervals)
  {
    if (course_.request.pose_summaries) beginPoses(intervals);
    for (const std::uint32_t interval : intervals) {
      const Span span = spanOf(interval);
      scratch_.seed.clear();
      collect(span, aroundVoxel(span), {tree_.top().data(), tree_.storage.top.data(), kAboveVoxels, 0, 0});
      if (scratch_.seed.empty()) continue;
      if (!entered_) enter();
      if (scratch_.open_lanes[0] == 0) break;
      const std::vector<Candidate> candidates = scratch_.seed;
      descend(0, span, candidates, 0);
    }
    if (entered_) finish();
    return answer_;
  }

private:
  // --- how the voxel is seen ---

  Sight sightOf(const PathPose& pose, const Point3& from, double unit) const
  {
    Sight sight;
    const Point3 seen = pose.see(origin_);
    const auto scale = static_cast<float>(frame_.unit / unit);
    for (std::size_t i = 0; i < 9; ++i) sight.m[i] = pose.turn[i] * scale;
    for (std::size_t i = 0; i < 3; ++i) sight.g[i] = roundToFloat((seen[i] - from[i]) / unit);
    return sight;
  }

  Span spanOf(std::uint32_t index) const
  {
    Span span;
    const PathInterval& interval = *(span.interval = &path_.intervals[index]);
    span.from = sightOf(path_.poses[interval.first], {0, 0, 0}, 1.0);
    span.to = sightOf(path_.poses[interval.last], {0, 0, 0}, 1.0);
    double squared = 0.0, coordinate = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      squared += (origin_[axis] - interval.pivot[axis]) * (origin_[axis] - interval.pivot[axis]);
      coordinate = std::max({coordinate, std::abs(static_cast<double>(span.from.g[axis])),
                             std::abs(static_cast<double>(span.to.g[axis]))});
    }
    span.stray = interval.drift + interval.turn * ((std::sqrt(squared) + radius_) * (1.0 + 0x1p-40));
    if (path_.is_swept && !interval.divided()) span.stray = std::min(span.stray, path_.stray);
    span.steps = path_.is_swept ? 0.0f : static_cast<float>(interval.last - interval.first);
    const double reach = course_.reach * (1.0 + path_.skew) + placing_ + span.stray;
    const double rounding =
        static_cast<double>(kSegmentRounding) * (coordinate + 2.01 * radius_ + tree_.radius + reach) + 0x1p-100;
    span.reach = roundUp(reach + rounding);
    span.rounding = roundUp(rounding);
    span.smallest = span.rounding * 0x1p-8f;
    return span;
  }

  static Segment segmentOf(const Point& from, const Point& to, float smallest)
  {
    const float start[3] = {from.x, from.y, from.z}, end[3] = {to.x, to.y, to.z};
    Segment segment;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float motion = end[axis] - start[axis];
      segment.start[axis] = start[axis];
      segment.inverse[axis] = 1.0f / std::copysign(std::max(std::abs(motion), smallest), motion);
    }
    return segment;
  }

  static Segment ballOn(const Span& span, const Point& center, float radius)
  {
    Segment segment = segmentOf(carryPoint(span.from.m, span.from.g, center), carryPoint(span.to.m, span.to.g, center),
                                span.smallest);
    std::fill(segment.reach, segment.reach + 3, span.reach + radius);
    return segment;
  }

  /// A radius in the voxel's unit as the model sees it.
  float seenRadius(float radius) const
  {
    return static_cast<float>(radius * frame_.unit * (1.0 + path_.skew) * (1.0 + 0x1p-20));
  }

  /// The voxel as a box: along each of the model's axes, as far as its own sides reach.
  Segment aroundVoxel(const Span& span) const
  {
    Segment segment = ballOn(span, {0.0f, 0.0f, 0.0f}, 0.0f);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double from = 0.0, to = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        from += std::abs(static_cast<double>(span.from.m[3 * axis + k])) * frame_.reach[k];
        to += std::abs(static_cast<double>(span.to.m[3 * axis + k])) * frame_.reach[k];
      }
      const double extent = std::max(from, to) * (1.0 + 0x1p-20) + span.interval->turn * radius_ / frame_.unit;
      const auto sphere = static_cast<double>(seenRadius(voxel_->radius));
      segment.reach[axis] = roundUp((span.reach + std::min(sphere, extent * frame_.unit)) * (1.0 + 0x1p-20));
    }
    return segment;
  }

  // --- the model's boxes ---

  /// The node below a candidate that is not a leaf, as its first child.
  Candidate below(const Candidate& c)
  {
    if (c.voxel != kAboveVoxels || !c.nodes[c.node].isLeaf(c.lane))
      return {c.boxes, c.nodes, c.voxel, c.nodes[c.node].child[c.lane], 0};
    const std::uint32_t voxel = c.nodes[c.node].begin[c.lane];
    const std::vector<BoxNode>& boxes = tree_.voxel(voxel, answer_.work);
    return {boxes.data(), tree_.storage.voxels[voxel].nodes.data(), voxel, 0, 0};
  }

  /// Bits of the children of a node that a thick segment may meet.
  std::uint32_t near(const Segment& segment, const Candidate& node, float steps)
  {
    const std::uint32_t count = node.nodes[node.node].count;
    answer_.work.node_pairs += count;
    return boxesOnSegment(segment, node.box().low, node.box().high, steps) & firstBits(count);
  }

  /// What the voxel may meet of the model, in boxes of about its own size.
  void collect(const Span& span, const Segment& segment, Candidate node)
  {
    for (std::uint32_t bits = near(segment, node, span.steps); bits != 0; bits &= bits - 1) {
      node.lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (node.isLeaf() || node.size() < 0.5f * static_cast<float>(radius_))
        scratch_.seed.push_back(node);
      else
        collect(span, segment, below(node));
    }
  }

  // --- the scan's nodes ---

  void enter()
  {
    voxel_ = &scan_.voxel(index_, answer_.work);
    entered_ = true;
    const std::vector<Node>& nodes = voxel_->nodes;
    scratch_.open_lanes.resize(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n)
      scratch_.open_lanes[n] = static_cast<std::uint8_t>(firstBits(nodes[n].count));
    scratch_.hit.assign(nodes.size() * kLanes, 0);
    scratch_.settled.assign(nodes.size() * kLanes, 0);
    if (course_.first) scratch_.first.assign(voxel_->count, kInfinity);
    if (course_.closest) scratch_.best.assign(voxel_->count, Best{});
  }

  bool divides(const Span& span, double size) const { return span.interval->divided() && span.stray > size; }

  void descend(std::uint32_t index, const Span& span, const std::vector<Candidate>& candidates, std::size_t depth)
  {
    const Node& node = voxel_->nodes[index];
    float largest = 0.0f;
    for (std::uint32_t lane = 0; lane < node.count; ++lane) largest = std::max(largest, node.r[lane]);
    if (divides(span, kNodeStray * largest * frame_.unit)) {
      for (const std::uint32_t half : {span.interval->left, span.interval->right}) {
        if (scratch_.open_lanes[index] == 0) return;
        descend(index, spanOf(half), candidates, depth);
      }
      return;
    }
    if (scratch_.visits.size() <= depth) scratch_.visits.resize(depth + 1);
    Visit& visit = scratch_.visits[depth];
    begin(visit, node, span);
    for (const Candidate& candidate : candidates) take(visit, candidate, span, scratch_.open_lanes[index]);
    for (std::uint32_t bits = scratch_.open_lanes[index]; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (visit.near[lane].empty()) continue;
      bool open = true;
      if (node.isLeaf(lane)) {
        const LeafRange points{voxel_, node.begin[lane], node.comparedPoints(lane)};
        open = compareLeaf(index * kLanes + lane, points, node, lane, span, visit.near[lane]);
      }
      else {
        descend(node.child[lane], span, visit.near[lane], depth + 1);
        open = scratch_.open_lanes[node.child[lane]] != 0;
      }
      if (!open) scratch_.open_lanes[index] &= static_cast<std::uint8_t>(~(1u << lane));
    }
  }

  void begin(Visit& visit, const Node& node, const Span& span)
  {
    alignas(64) float from[3][kLanes], to[3][kLanes];
    carry(span.from.m, span.from.g, node.x, node.y, node.z, kLanes, from[0], from[1], from[2]);
    carry(span.to.m, span.to.g, node.x, node.y, node.z, kLanes, to[0], to[1], to[2]);
    visit.children.set(from, to, span.smallest);
    float low[3], high[3];
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      visit.near[lane].clear();
      visit.radius[lane] = seenRadius(node.r[lane]);
      visit.children.reach[lane] = (span.reach + visit.radius[lane]) * (1.0f + 0x1p-21f);
    }
    // Around all of them: a box that moves as their bounds' middle does, in the voxel's frame.
    const float* coordinates[3] = {node.x, node.y, node.z};
    float widest = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::numeric_limits<float>::infinity();
      high[axis] = -low[axis];
      for (std::uint32_t lane = 0; lane < node.count; ++lane) {
        low[axis] = std::min(low[axis], coordinates[axis][lane]);
        high[axis] = std::max(high[axis], coordinates[axis][lane]);
      }
    }
    const Point middle{0.5f * (low[0] + high[0]), 0.5f * (low[1] + high[1]), 0.5f * (low[2] + high[2])};
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      const float dx = node.x[lane] - middle.x, dy = node.y[lane] - middle.y, dz = node.z[lane] - middle.z;
      widest = std::max(widest, std::sqrt(dx * dx + dy * dy + dz * dz) * (1.0f + 0x1p-20f) + node.r[lane]);
    }
    visit.around = ballOn(span, middle, seenRadius(widest));
  }

  /// Compares a box of the model with those children of the visit that are in `lanes`: drops it, keeps it for their own
  /// descent, or opens it.
  void take(Visit& visit, const Candidate& candidate, const Span& span, std::uint32_t lanes)
  {
    const std::uint32_t k = candidate.lane;
    const BoxNode& box = candidate.box();
    const float low[3] = {box.low[0][k], box.low[1][k], box.low[2][k]};
    const float high[3] = {box.high[0][k], box.high[1][k], box.high[2][k]};
    answer_.work.node_pairs += static_cast<std::uint64_t>(std::popcount(lanes));
    const std::uint32_t near_lanes =
        lanes & segmentsInBox(visit.children, low, high, span.steps, static_cast<Stays<kLanes>*>(nullptr));
    if (near_lanes == 0) return;
    const bool leaf = candidate.isLeaf();
    const float size = candidate.size();
    std::uint32_t opening = 0;
    for (std::uint32_t bits = near_lanes; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (!leaf && size > static_cast<float>(kBoxSize) * visit.radius[lane])
        opening |= 1u << lane;
      else
        visit.near[lane].push_back(candidate);
    }
    if (opening == 0) return;
    Candidate child = below(candidate);
    for (std::uint32_t bits = near(visit.around, child, span.steps); bits != 0; bits &= bits - 1) {
      child.lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      take(visit, child, span, opening);
    }
  }

  // --- the scan's leaves ---

  /// @return whether any of the leaf's points is not settled.
  bool compareLeaf(std::size_t slot, const LeafRange& points, const Node& node, std::uint32_t lane, const Span& span,
                   const std::vector<Candidate>& candidates)
  {
    const std::uint32_t all = firstBits(points.count);
    if ((all & ~scratch_.settled[slot]) == 0) return false;
    const double share = span.steps > kManyPoses ? kManyPosesStray : kLeafStray;
    const double limit = path_.is_swept ? path_.stray : share * node.r[lane] * frame_.unit;
    if (divides(span, limit)) {
      return compareLeaf(slot, points, node, lane, spanOf(span.interval->left), candidates) &&
             compareLeaf(slot, points, node, lane, spanOf(span.interval->right), candidates);
    }
    LeafVisit leaf;
    leaf.points = points;
    leaf.slot = slot;
    leaf.open = all & ~scratch_.settled[slot];
    alignas(64) float from[3][kLeafPoints], to[3][kLeafPoints];
    carry(span.from.m, span.from.g, points.x(), points.y(), points.z(), points.count, from[0], from[1], from[2]);
    carry(span.to.m, span.to.g, points.x(), points.y(), points.z(), points.count, to[0], to[1], to[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::fill(from[axis] + points.count, from[axis] + kLeafPoints, 0.0f);
      std::fill(to[axis] + points.count, to[axis] + kLeafPoints, 0.0f);
    }
    leaf.ways.set(from, to, span.smallest);
    if (path_.is_swept || span.steps >= kFewPoses) leaf.motions.set(from, to, span.smallest, span.rounding);
    std::fill(leaf.ways.reach, leaf.ways.reach + kLeafPoints, span.reach);
    if (course_.closestOnly())
      for (std::uint32_t i = 0; i < points.count; ++i)
        leaf.ways.reach[i] = std::min(span.reach, reachOf(span, scratch_.best[points.begin + i]));
    leaf.around = ballOn(span, {node.x[lane], node.y[lane], node.z[lane]}, seenRadius(node.r[lane]));
    if (course_.request.pose_summaries) scratch_.pose_hits.assign(span.interval->last - span.interval->first + 1, 0);

    std::vector<Candidate>& stack = scratch_.stack;
    for (const Candidate& candidate : candidates) {
      stack.push_back(candidate);
      while (!stack.empty() && leaf.open != 0) {
        const Candidate next = stack.back();
        stack.pop_back();
        compareBox(leaf, next, span);
      }
      if (leaf.open == 0) break;
    }
    stack.clear();
    if (course_.request.pose_summaries) countPoses(leaf, span, node.points(lane));
    if (!course_.everything()) scratch_.settled[slot] = scratch_.hit[slot];
    return (all & ~scratch_.settled[slot]) != 0;
  }

  void compareBox(LeafVisit& leaf, const Candidate& candidate, const Span& span)
  {
    const std::uint32_t k = candidate.lane;
    const BoxNode& box = candidate.box();
    const float low[3] = {box.low[0][k], box.low[1][k], box.low[2][k]};
    const float high[3] = {box.high[0][k], box.high[1][k], box.high[2][k]};
    Stays<kLeafPoints> stays;
    answer_.work.node_pairs += static_cast<std::uint64_t>(std::popcount(leaf.open));
    const std::uint32_t lanes = leaf.open & segmentsInBox(leaf.ways, low, high, span.steps, &stays);
    if (lanes == 0) return;
    if (!candidate.isLeaf()) {
      Candidate child = below(candidate);
      for (std::uint32_t bits = near(leaf.around, child, span.steps); bits != 0; bits &= bits - 1) {
        child.lane = static_cast<std::uint32_t>(std::countr_zero(bits));
        scratch_.stack.push_back(child);
      }
      return;
    }
    const Node& node = candidate.nodes[candidate.node];
    const LeafRange other{&tree_.storage.voxels[candidate.voxel], node.begin[k], node.comparedPoints(k)};
    if (path_.is_swept)
      compareWays(leaf, lanes, stays, other, candidate.voxel, span);
    else
      comparePoses(leaf, lanes, stays, other, candidate.voxel, span);
  }

  // --- poses ---

  void comparePoses(LeafVisit& leaf, std::uint32_t lanes, Stays<kLeafPoints>& stays, const LeafRange& other,
                    std::uint32_t voxel, const Span& span)
  {
    PoseRanges ranges = rangesOf(lanes, stays, span);
    if (ranges.lanes == 0) return;
    if (static_cast<float>(ranges.end - ranges.begin) > kFewPoses && other.voxel->frame.unit == 1.0) {
      lanes &= nearPoints(leaf, other, voxel, stays);
      ranges = rangesOf(lanes, stays, span);
      lanes = ranges.lanes;
      if (!course_.everything() && !course_.first) {
        // Any pose will do: the one in the middle is nearest.
        for (std::uint32_t bits = lanes; bits != 0; bits &= bits - 1) {
          const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
          if ((leaf.open >> i & 1) == 0) continue;
          const std::uint32_t k = ranges.first[i] + (ranges.last[i] - ranges.first[i]) / 2;
          compareAt(leaf, ranges.at(k, lanes & leaf.open), other, voxel, k, span);
        }
      }
    }
    for (std::uint32_t k = ranges.begin; k < ranges.end && (lanes & leaf.open) != 0; ++k) {
      std::uint32_t here = ranges.at(k, lanes & leaf.open);
      if (course_.first && !course_.everything())
        for (std::uint32_t bits = here; bits != 0; bits &= bits - 1) {
          const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
          if (scratch_.first[leaf.points.begin + i] <= k) here &= ~(1u << i);
        }
      if (here != 0) compareAt(leaf, here, other, voxel, k, span);
    }
  }

  /// Bits of the leaf's points whose ways come near to points of the model's leaf, and when.
  std::uint32_t nearPoints(const LeafVisit& leaf, const LeafRange& other, std::uint32_t voxel,
                           Stays<kLeafPoints>& stays) const
  {
    const Point3 at = tree_.offset(voxel);
    const float shift[3] = {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
    return segmentsNearPoints(leaf.ways, leaf.motions, other.x(), other.y(), other.z(), other.count, shift, stays);
  }

  /// The poses at which each of a leaf's points has to be looked at: first..last, of all of them [begin, end).
  struct PoseRanges {
    std::uint32_t lanes = 0; ///< points that have such a pose
    std::uint32_t first[kLeafPoints], last[kLeafPoints];
    std::uint32_t begin = 0xffffffffu, end = 0;

    std::uint32_t at(std::uint32_t k, std::uint32_t among) const
    {
      std::uint32_t here = 0;
      for (std::uint32_t bits = among & lanes; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
        if (first[i] <= k && k <= last[i]) here |= 1u << i;
      }
      return here;
    }
  };

  static PoseRanges rangesOf(std::uint32_t lanes, const Stays<kLeafPoints>& stays, const Span& span)
  {
    PoseRanges ranges;
    const double steps = span.interval->last - span.interval->first;
    for (std::uint32_t bits = lanes; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
      ranges.first[i] = span.interval->first + static_cast<std::uint32_t>(std::ceil(steps * stays.from[i]));
      ranges.last[i] = span.interval->first + static_cast<std::uint32_t>(std::floor(steps * stays.to[i]));
      if (ranges.first[i] > ranges.last[i]) continue;
      ranges.lanes |= 1u << i;
      ranges.begin = std::min(ranges.begin, ranges.first[i]);
      ranges.end = std::max(ranges.end, ranges.last[i] + 1);
    }
    return ranges;
  }

  void compareAt(LeafVisit& leaf, std::uint32_t lanes, const LeafRange& other, std::uint32_t voxel, std::uint32_t k,
                 const Span& span)
  {
    ++answer_.work.leaf_pairs;
    const double unit = other.voxel->frame.unit;
    const Sight sight = sightOf(path_.poses[k], tree_.offset(voxel), unit);
    bool certain = course_.radii == 0.0 && unit == 1.0 && frame_.unit == 1.0;
    for (const float g : sight.g) certain = certain && std::abs(g) <= far_;
    LeafPoints points;
    carry(sight.m, sight.g, leaf.points.x(), leaf.points.y(), leaf.points.z(), leaf.points.count, points.x, points.y,
          points.z);
    alignas(64) float nearest[kLeafPoints];
    std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
    std::uint32_t hit = 0;
    if (certain) {
      nearestSquared(points, other.x(), other.y(), other.z(), other.count, nearest);
      hit = lanes & atMost(nearest, band_.hit);
      const std::uint32_t undecided = lanes & ~hit & ~above(nearest, band_.miss);
      if (undecided != 0)
        eachPairNotBeyond(points, undecided, other, band_.miss, [&](std::uint32_t i, std::uint32_t j, float) {
          if ((hit >> i & 1) == 0 && collide(leaf.points.record(i), other.record(j), k)) hit |= 1u << i;
          return (undecided & ~hit) == 0;
        });
    }
    else {
      for (std::uint32_t bits = lanes; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
        for (std::uint32_t j = 0; j < other.count && (hit >> i & 1) == 0; ++j)
          if (collide(leaf.points.record(i), other.record(j), k)) hit |= 1u << i;
      }
    }
    if (hit != 0) note(leaf, hit, points, nearest, certain, other, k, span);
  }

  void note(LeafVisit& leaf, std::uint32_t hit, const LeafPoints& points, const float* nearest, bool certain,
            const LeafRange& other, std::uint32_t k, const Span& span)
  {
    scratch_.hit[leaf.slot] = static_cast<std::uint16_t>(scratch_.hit[leaf.slot] | hit);
    if (!course_.everything() && !course_.first) leaf.open &= ~hit;
    if (course_.request.pose_summaries) {
      std::uint16_t& at = scratch_.pose_hits[k - span.interval->first];
      at = static_cast<std::uint16_t>(at | hit);
    }
    for (std::uint32_t bits = hit; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (course_.first) {
        double& first = scratch_.first[leaf.points.begin + i];
        first = std::min(first, static_cast<double>(k));
      }
      if (!course_.everything()) continue;
      // Only what may be as near as the nearest in floats is worth an exact look.
      const float within = certain ? notBeyond(nearest[i]) : std::numeric_limits<float>::infinity();
      Best* best = course_.closest ? &scratch_.best[leaf.points.begin + i] : nullptr;
      const bool for_point = best && !(certain && nearest[i] > best->limit);
      const bool for_pose = course_.request.pose_summaries && !(certain && nearest[i] > poseLimit(k));
      if (!for_point && !for_pose) continue;
      for (std::uint32_t j = 0; j < other.count; ++j) {
        const float dx = points.x[i] - other.x()[j], dy = points.y[i] - other.y()[j], dz = points.z[i] - other.z()[j];
        const float squared = (dx * dx + dy * dy) + dz * dz;
        if (certain && squared > within) continue;
        if (for_point) consider(*best, {leaf.points.record(i), other.record(j)}, k);
        if (for_pose) considerPose({leaf.points.record(i), other.record(j)}, k);
      }
      if (for_point && certain) {
        const double high = highOf(nearest[i]);
        best->limit = std::min(best->limit, notBeyond(nearest[i]));
        best->reach = std::min(best->reach, roundUp(high));
        if (course_.closestOnly()) leaf.ways.reach[i] = std::min(leaf.ways.reach[i], reachOf(span, *best));
      }
      if (for_pose && certain) lowerPoseLimit(k, notBeyond(nearest[i]));
    }
  }

  /// No less than the distance of a pair at this squared one in floats.
  double highOf(float squared) const
  {
    return (std::sqrt(static_cast<double>(squared)) * (1.0 + 0x1p-20) + error_) * (1.0 + path_.skew);
  }

  /// A pair at a larger squared distance in floats is farther than one at this.
  float notBeyond(float squared) const { return distanceBand(highOf(squared), error_, path_.skew).miss; }

  /// How far from a line a point may be that is as near as the best one.
  float reachOf(const Span& span, const Best& best) const
  {
    return best.reach < span.reach ? (span.reach + (best.reach - static_cast<float>(course_.reach))) * (1.0f + 0x1p-18f)
                                   : span.reach;
  }

  ExactDistance exactAt(std::uint32_t k) const
  {
    return ExactDistance(course_.scan.pose, course_.given[path_.poses[k].given]);
  }

  ExactDistance::Pair posed(PointPair pair) const
  {
    const PointsView &a = course_.scan.hierarchy.view(), &b = course_.model.view();
    return {a.point(pair.a), b.point(pair.b), a.radius(pair.a), b.radius(pair.b)};
  }

  bool collide(std::uint32_t a, std::uint32_t b, std::uint32_t k)
  {
    ++answer_.work.exact_decisions;
    const ExactDistance::Pair pair = posed({a, b});
    return exactAt(k).compare(pair.p, pair.q, course_.request.clearance, pair.radius_p, pair.radius_q) <= 0;
  }

  /// Keeps the nearest; of several the first pose, and there the smallest record.
  void consider(Best& best, PointPair pair, std::uint32_t k)
  {
    ++answer_.work.exact_decisions;
    if (best.record != 0xffffffffu) {
      const auto best_pose = static_cast<std::uint32_t>(best.time);
      const int sign = exactAt(k).compareGaps(posed(pair), exactAt(best_pose), posed({pair.a, best.record}));
      if (sign > 0 || (sign == 0 && (k > best_pose || (k == best_pose && pair.b >= best.record)))) return;
    }
    best.time = k;
    best.record = pair.b;
  }

  // --- the motion between poses ---

  /// Points that move in straight lines against points at rest: all instants at once. In double; what that gets wrong
  /// is small against the tolerance (checkTolerance()).
  void compareWays(LeafVisit& leaf, std::uint32_t lanes, Stays<kLeafPoints>& stays, const LeafRange& other,
                   std::uint32_t voxel, const Span& span)
  {
    if (other.voxel->frame.unit == 1.0) lanes &= nearPoints(leaf, other, voxel, stays);
    ++answer_.work.leaf_pairs;
    const double begin = span.interval->first, steps = span.interval->last - span.interval->first;
    for (std::uint32_t bits = lanes; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
      double& first = scratch_.first[leaf.points.begin + i];
      if (!course_.closest && first <= begin + steps * stays.from[i]) continue;
      const std::uint32_t record = leaf.points.record(i);
      const Way way = wayOf(record, span);
      for (std::uint32_t j = 0; j < other.count; ++j) {
        ++answer_.work.exact_decisions;
        const std::uint32_t q = other.record(j);
        const double radii = course_.scan.hierarchy.view().radius(record) + course_.model.view().radius(q);
        const Approach approach = approachOf(way, course_.model.view().point(q), course_.reach - course_.radii + radii);
        if (!approach.contact) continue;
        scratch_.hit[leaf.slot] = static_cast<std::uint16_t>(scratch_.hit[leaf.slot] | 1u << i);
        first = std::min(first, begin + steps * approach.enter);
        if (course_.closest)
          consider(scratch_.best[leaf.points.begin + i], approach.distance - radii, begin + steps * approach.at, q);
      }
    }
  }

  /// Where a point of the scan is seen at a span's ends.
  struct Way {
    Point3 start, motion;
  };

  Way wayOf(std::uint32_t record, const Span& span) const
  {
    const Point3 world = carried(course_.scan.pose, course_.scan.hierarchy.view().point(record));
    const Point3 start = path_.poses[span.interval->first].see(world);
    const Point3 end = path_.poses[span.interval->last].see(world);
    return {start, {end[0] - start[0], end[1] - start[1], end[2] - start[2]}};
  }

  /// A point on its way and one at rest: the instants, in [0, 1], of their closest approach and of the first contact.
  struct Approach {
    bool contact;
    double distance, at, enter;
  };

  Approach approachOf(const Way& way, const Point3& model_point, double near_enough) const
  {
    double length = 0.0, along = 0.0, apart = 0.0, squared = 0.0;
    Point3 away;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      away[axis] = way.start[axis] - (model_point[axis] - tree_.origin[axis]);
      length += way.motion[axis] * way.motion[axis];
      along += way.motion[axis] * away[axis];
      apart += away[axis] * away[axis];
    }
    const double at = length > 0.0 ? std::clamp(-along / length, 0.0, 1.0) : 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double closest = away[axis] + at * way.motion[axis];
      squared += closest * closest;
    }
    const double limit = near_enough * near_enough;
    if (!(squared <= limit)) return {false, 0.0, 0.0, 0.0};
    // Of the two roots the earlier one, written so that it subtracts nothing alike.
    const double root = std::sqrt(std::max(0.0, along * along - length * (apart - limit)));
    const double enter = apart <= limit ? 0.0 : std::min(at, (apart - limit) / (root - along));
    return {true, std::sqrt(squared), at, enter};
  }

  /// Keeps the nearest; of several the first instant, and there the smallest record.
  static void consider(Best& best, double gap, double time, std::uint32_t record)
  {
    if (std::tie(gap, time, record) >= std::tie(best.gap, best.time, best.record)) return;
    best.gap = gap;
    best.time = time;
    best.record = record;
  }

  // --- per pose ---

  void beginPoses(const std::vector<std::uint32_t>& intervals)
  {
    first_pose_ = path_.poses.size();
    std::size_t last = 0;
    for (const std::uint32_t i : intervals) {
      first_pose_ = std::min<std::size_t>(first_pose_, path_.intervals[i].first);
      last = std::max<std::size_t>(last, path_.intervals[i].last);
    }
    if (intervals.empty()) return;
    pose_best_.resize(last + 1 - first_pose_);
    pose_limit_.assign(pose_best_.size(), std::numeric_limits<float>::infinity());
    pose_counts_.assign(pose_best_.size(), 0);
  }

  void countPoses(const LeafVisit& leaf, const Span& span, std::size_t points)
  {
    for (std::size_t i = 0; i < scratch_.pose_hits.size(); ++i) {
      const auto hits = static_cast<std::size_t>(std::popcount(scratch_.pose_hits[i]));
      if (hits != 0) pose_counts_[span.interval->first + i - first_pose_] += points > leaf.points.count ? points : hits;
    }
  }

  float poseLimit(std::uint32_t k) const { return pose_limit_[k - first_pose_]; }
  void lowerPoseLimit(std::uint32_t k, float limit)
  {
    pose_limit_[k - first_pose_] = std::min(pose_limit_[k - first_pose_], limit);
  }

  void considerPose(PointPair pair, std::uint32_t k)
  {
    PoseBest& best = pose_best_[k - first_pose_];
    ++answer_.work.exact_decisions;
    if (best.found && exactAt(k).compareGaps(posed(pair), posed(best.pair)) >= 0) return;
    best = {pair, true};
  }

  // --- the end ---

  void finish()
  {
    const TrajectoryRequest& request = course_.request;
    TrajectoryResult& result = course_.result;
    for (std::uint32_t n = 0; n < voxel_->nodes.size(); ++n) {
      const Node& node = voxel_->nodes[n];
      for (std::uint32_t lane = 0; lane < node.count; ++lane) {
        if (!node.isLeaf(lane)) continue;
        for (std::uint32_t bits = scratch_.hit[n * kLanes + lane]; bits != 0; bits &= bits - 1) {
          const std::uint32_t i = node.begin[lane] + static_cast<std::uint32_t>(std::countr_zero(bits));
          float distance = 0.0f;
          if (course_.first) answer_.first_contact = std::min(answer_.first_contact, scratch_.first[i]);
          if (request.distances) distance = distanceOf(voxel_->records()[i], scratch_.best[i]);
          // A point that stands for others of its place answers for them.
          const std::uint32_t end = node.isCoincident(lane) ? node.begin[lane + 1] : i + 1;
          for (std::uint32_t p = i; p < end; ++p) {
            const std::uint32_t record = voxel_->records()[p];
            ++answer_.colliding;
            if (request.flags) result.flags[record] = 1;
            if (request.first_poses) result.first_pose[record] = givenPose(scratch_.first[i]);
            if (request.distances) result.distance[record] = distance;
            if (request.closest_poses) result.closest_pose[record] = givenPose(scratch_.best[i].time);
            if (course_.closest) result.closest_point[record] = scratch_.best[i].record;
          }
        }
      }
    }
    if (!request.pose_summaries) return;
    const std::lock_guard<std::mutex> lock(course_.mutex);
    for (std::size_t i = 0; i < pose_counts_.size(); ++i) {
      const auto k = static_cast<std::uint32_t>(first_pose_ + i);
      course_.pose_counts[k] += pose_counts_[i];
      PoseBest& best = course_.pose_best[k];
      if (pose_best_[i].found &&
          (!best.found || exactAt(k).compareGaps(posed(pose_best_[i].pair), posed(best.pair)) < 0))
        best = pose_best_[i];
    }
  }

  std::int32_t givenPose(double time) const
  {
    return static_cast<std::int32_t>(path_.poses[static_cast<std::size_t>(time)].given);
  }

  float distanceOf(std::uint32_t record, const Best& best) const
  {
    return roundToFloat(
        path_.is_swept ? best.gap : exactAt(static_cast<std::uint32_t>(best.time)).gap(posed({record, best.record})));
  }

  const Course& course_;
  const PosePath& path_;
  const BoxTree& tree_;
  const Spaces scan_;
  const LocalFrame& frame_;
  const Voxel* voxel_;
  const Point3 origin_; // of the voxel, in the world
  const double radius_;
  const std::uint32_t index_;
  Scratch& scratch_;
  double placing_, far_, error_;
  DistanceBand band_;
  bool entered_ = false;
  VoxelAnswer answer_;

  std::size_t first_pose_ = 0;
  std::vector<PoseBest> pose_best_;
  std::vector<float> pose_limit_;
  std::vector<std::size_t> pose_counts_;
};

} // namespace

VoxelAnswer walkVoxelOnTarget(const Course& course, std::uint32_t voxel, const std::vector<std::uint32_t>& intervals)
{
  thread_local Scratch scratch;
  return TrajectoryWalk(course, voxel, scratch).run(intervals);
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {

HWY_EXPORT(walkVoxelOnTarget);

/// Tells the caller how far things are, in the caller's own thread.
class Progress {
public:
  Progress(const std::function<bool(double)>& report, std::size_t total) : report_(report), total_(total) {}

  bool stopped() const { return stopped_; }

  void step()
  {
    const std::size_t done = ++done_;
    if (report_ && std::this_thread::get_id() == caller_ &&
        !report_(static_cast<double>(done) / static_cast<double>(total_)))
      stopped_ = true;
  }

private:
  const std::function<bool(double)>& report_;
  const std::size_t total_;
  const std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stopped_{false};
};

void allocate(TrajectoryResult& result, const TrajectoryRequest& request, std::size_t records, std::size_t poses)
{
  const auto sized = [records](bool asked) { return asked ? records : 0; };
  result.flags.assign(sized(request.flags), 0);
  result.distance.assign(sized(request.distances), std::numeric_limits<float>::quiet_NaN());
  result.first_pose.assign(sized(request.first_poses), -1);
  result.closest_pose.assign(sized(request.closest_poses), -1);
  result.closest_point.assign(sized(request.distances || request.closest_poses), 0xffffffffu);
  if (request.pose_summaries) result.poses.resize(poses);
}

/// Equal poses in a row were looked at once.
void summarize(const Course& course, TrajectoryResult& result)
{
  const std::vector<PathPose>& poses = course.path.poses;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    PoseSummary summary;
    summary.colliding_points = course.pose_counts[k];
    summary.colliding = summary.colliding_points > 0;
    if (summary.colliding) {
      const PointPair pair = course.pose_best[k].pair;
      const PointsView &a = course.scan.hierarchy.view(), &b = course.model.view();
      summary.distance = ExactDistance(course.scan.pose, course.given[poses[k].given])
                             .gap({a.point(pair.a), b.point(pair.b), a.radius(pair.a), b.radius(pair.b)});
    }
    const std::size_t next = k + 1 < poses.size() ? poses[k + 1].given : result.poses.size();
    std::fill(result.poses.begin() + poses[k].given, result.poses.begin() + static_cast<std::ptrdiff_t>(next), summary);
  }
}

/// Swept: what double arithmetic may get wrong has to fit into a sixteenth of the tolerance.
void checkTolerance(const Course& course)
{
  const LocalFrame& frame = course.scan.hierarchy.storage().frame;
  const Point3 origin = carried(course.scan.pose, frame.origin);
  double size = 3 * course.path.far + 4 * course.boxes.radius + course.reach;
  for (std::size_t axis = 0; axis < 3; ++axis) size += std::abs(origin[axis]) + 2 * frame.reach[axis] * frame.unit;
  const double least = 16 * 0x1p-46 * size;
  if (*course.request.swept >= least) return;
  std::ostringstream message;
  message << "tolerance of the swept motion: " << *course.request.swept << ": too small for coordinates as large as "
          << size << ": give at least " << least;
  throw std::invalid_argument(message.str());
}

/// The instant of a place on a swept path.
FirstContact instantOf(const PosePath& path, double time)
{
  const auto k = static_cast<std::size_t>(time);
  const PathPose& pose = path.poses[k];
  if (k + 1 == path.poses.size()) return {pose.given, 0.0};
  const PathPose& next = path.poses[k + 1];
  const double end = next.given == pose.given ? next.fraction : 1.0;
  const double fraction = pose.fraction + (end - pose.fraction) * (time - static_cast<double>(k));
  return {pose.given, std::min(fraction, 1.0 - 0x1p-53)};
}

} // namespace

TrajectoryResult collideAlong(const Placed& scan, const SphereHierarchy& model,
                              const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request)
{
  check(scan, model_poses, request);
  const DefaultFloatEnvironment environment;
  TrajectoryResult result;
  allocate(result, request, scan.hierarchy.view().count, model_poses.size());
  if (!asksForAnything(request) || scan.hierarchy.empty() || model.empty() || model_poses.empty()) return result;
  Course course(scan, model, model_poses, request, result);
  if (request.swept) checkTolerance(course);
  if (!course.inFloatRange()) return brute_force::collideAlong(scan, model, model_poses, request);
  if (request.pose_summaries) {
    course.pose_best.resize(course.path.poses.size());
    course.pose_counts.resize(course.path.poses.size());
  }
  const std::vector<std::vector<std::uint32_t>> meetings = course.meetings();
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t v = 0; v < meetings.size(); ++v)
    if (!meetings[v].empty()) voxels.push_back(v);

  std::vector<VoxelAnswer> answers(voxels.size());
  Progress progress(request.progress, voxels.size());
  parallelFor(voxels.size(), threadCount(request.threads), [&](std::size_t i) {
    if (progress.stopped()) return;
    answers[i] = HWY_DYNAMIC_DISPATCH(walkVoxelOnTarget)(course, voxels[i], meetings[voxels[i]]);
    progress.step();
  });
  if (progress.stopped()) throw Cancelled();

  double first_contact = std::numeric_limits<double>::infinity();
  for (const VoxelAnswer& answer : answers) {
    result.work += answer.work;
    result.colliding += answer.colliding;
    first_contact = std::min(first_contact, answer.first_contact);
  }
  if (request.swept && std::isfinite(first_contact)) result.first_contact = instantOf(course.path, first_contact);
  if (request.pose_summaries) summarize(course, result);
  return result;
}

} // namespace pcl_bsh
#endif
