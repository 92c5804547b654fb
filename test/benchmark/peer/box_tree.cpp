// SPDX-License-Identifier: BSD-3-Clause
#include "box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pcl_bsh::bench {
namespace {

float at(const Point& p, std::size_t axis)
{
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// Squared distances of the nearest places of two boxes, and of their farthest.
struct Range {
  float nearest = 0.0f, farthest = 0.0f;
};

Range rangeOf(const BoxTree::Node& a, const BoxTree::Node& b)
{
  Range range;
  for (std::size_t k = 0; k < 3; ++k) {
    const float apart = std::abs(a.centre[k] - b.centre[k]), reach = a.half[k] + b.half[k];
    const float near = std::max(0.0f, apart - reach), far = apart + reach;
    range.nearest += near * near;
    range.farthest += far * far;
  }
  return range;
}

float sizeOf(const BoxTree::Node& node)
{
  return std::max({node.half[0], node.half[1], node.half[2]});
}

} // namespace

BoxTree::BoxTree(const Points& points) : order_(points.size())
{
  std::iota(order_.begin(), order_.end(), 0u);
  points_ = points;
  const auto count = static_cast<std::uint32_t>(points.size());
  nodes_.reserve(points.size() / 4 + 1);
  nodes_.push_back({{}, {}, 0, count, 0, 0});
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    fit(nodes_[i]);
    const Node node = nodes_[i];
    if (node.count() <= kLeafPoints) continue;
    const std::size_t axis =
        static_cast<std::size_t>(std::max_element(node.half.begin(), node.half.end()) - node.half.begin());
    const std::uint32_t middle = node.begin + node.count() / 2;
    std::nth_element(order_.begin() + node.begin, order_.begin() + middle, order_.begin() + node.end,
                     [&](std::uint32_t p, std::uint32_t q) { return at(points[p], axis) < at(points[q], axis); });
    for (std::uint32_t k = node.begin; k < node.end; ++k) points_[k] = points[order_[k]];
    nodes_[i].child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, {}, node.begin, middle, 0, i});
    nodes_.push_back({{}, {}, middle, node.end, 0, i});
  }
}

void BoxTree::fit(Node& node) const
{
  for (std::size_t k = 0; k < 3; ++k) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      low = std::min(low, at(points_[i], k));
      high = std::max(high, at(points_[i], k));
    }
    node.centre[k] = 0.5f * (low + high);
    node.half[k] = 0.5f * (high - low);
  }
}

BoxPair::BoxPair(const BoxTree& a, const BoxTree& b)
: a_(a),
  b_(b),
  carried_(b.nodes().size()),
  is_carried_(b.nodes().size()),
  is_moved_(b.points().size()),
  moved_(b.points().size())
{
}

void BoxPair::carry(const RigidPose& pose, std::uint32_t node, BoxWork& work)
{
  if (is_carried_[node]) return;
  const BoxTree::Node& from = b_.nodes()[node];
  BoxTree::Node& to = carried_[node];
  to = from;
  for (std::size_t i = 0; i < 3; ++i) {
    double centre = pose.translation[i], half = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      centre += pose.rotation[3 * i + k] * from.centre[k];
      half += std::abs(pose.rotation[3 * i + k]) * from.half[k];
    }
    to.centre[i] = static_cast<float>(centre);
    to.half[i] = static_cast<float>(half * (1.0 + 1e-6)) + 1e-6f * std::abs(to.centre[i]); // no point is rounded out
  }
  is_carried_[node] = 1;
  touched_.push_back(node);
  ++work.updates;
}

const Point* BoxPair::leafOfB(const RigidPose& pose, const BoxTree::Node& leaf)
{
  if (!is_moved_[leaf.begin]) {
    for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) moved_[i] = pose.apply(b_.points()[i]);
    is_moved_[leaf.begin] = 1;
    moved_from_.push_back(leaf.begin);
  }
  return moved_.data() + leaf.begin;
}

/// Calls visit(a's node, its number, b's node, whole): two leaves, or a box that is wholly within d of the other; until
/// it returns true.
template <typename Visit>
void BoxPair::descend(const RigidPose& pose, float d, BoxWork& work, bool whole, const Visit& visit)
{
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack = {{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    if (whole && unflagged_[i] == 0) continue;
    carry(pose, j, work);
    const BoxTree::Node &a = a_.nodes()[i], &b = carried_[j];
    ++work.tests;
    const Range range = rangeOf(a, b);
    if (range.nearest > d * d) continue;
    const bool all = range.farthest <= d * d;
    if (all || (a.isLeaf() && b.isLeaf())) {
      if (visit(a, i, b, all)) break;
    }
    else if (b.isLeaf() || (!a.isLeaf() && sizeOf(a) >= sizeOf(b))) {
      stack.emplace_back(a.child + 1, j);
      stack.emplace_back(a.child, j);
    }
    else {
      stack.emplace_back(i, b.child + 1);
      stack.emplace_back(i, b.child);
    }
  }
  for (const std::uint32_t node : touched_) is_carried_[node] = 0;
  for (const std::uint32_t place : moved_from_) is_moved_[place] = 0;
  touched_.clear();
  moved_from_.clear();
}

bool BoxPair::any(const RigidPose& pose, float d, BoxWork& work)
{
  bool found = false;
  descend(pose, d, work, false, [&](const BoxTree::Node& a, std::uint32_t, const BoxTree::Node& b, bool all) {
    if (all) return found = true;
    ++work.leaf_pairs;
    const Point* const q = leafOfB(pose, b);
    for (std::uint32_t i = a.begin; i < a.end; ++i)
      for (std::uint32_t k = 0; k < b.count(); ++k) found |= squaredDistance(a_.points()[i], q[k]) <= d * d;
    return found;
  });
  return found;
}

void BoxPair::setFlag(std::uint32_t place, std::uint32_t leaf, std::vector<std::uint8_t>& flags)
{
  flags[a_.records()[place]] = 1;
  for (std::uint32_t node = leaf;; node = a_.nodes()[node].parent) {
    --unflagged_[node];
    if (node == 0) break;
  }
}

void BoxPair::settle(const BoxTree::Node& node, std::vector<std::uint8_t>& flags)
{
  std::vector<std::uint32_t> below = {static_cast<std::uint32_t>(&node - a_.nodes().data())};
  while (!below.empty()) {
    const std::uint32_t i = below.back();
    below.pop_back();
    const BoxTree::Node& n = a_.nodes()[i];
    if (unflagged_[i] == 0) continue;
    if (!n.isLeaf()) {
      below.push_back(n.child);
      below.push_back(n.child + 1);
      continue;
    }
    for (std::uint32_t k = n.begin; k < n.end; ++k)
      if (!flags[a_.records()[k]]) setFlag(k, i, flags);
  }
}

void BoxPair::flag(const RigidPose& pose, float d, std::vector<std::uint8_t>& flags, BoxWork& work)
{
  flags.assign(a_.points().size(), 0);
  unflagged_.clear();
  for (const BoxTree::Node& node : a_.nodes()) unflagged_.push_back(node.count());
  descend(pose, d, work, true, [&](const BoxTree::Node& a, std::uint32_t number, const BoxTree::Node& b, bool all) {
    if (all) {
      settle(a, flags);
      return false;
    }
    ++work.leaf_pairs;
    const Point* const q = leafOfB(pose, b);
    for (std::uint32_t i = a.begin; i < a.end; ++i) {
      if (flags[a_.records()[i]]) continue;
      bool near = false;
      for (std::uint32_t k = 0; k < b.count(); ++k) near |= squaredDistance(a_.points()[i], q[k]) <= d * d;
      if (near) setFlag(i, number, flags);
    }
    return false;
  });
}

} // namespace pcl_bsh::bench
