// SPDX-License-Identifier: BSD-3-Clause
#include "reference_distance.h"

#include <algorithm>

namespace pcl_bsh::bench {
namespace {

using Vector = std::array<double, 3>;

double length(const Vector& v)
{
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// Distance from a point to a box, 0 inside.
double toBox(const Vector& p, const Vector& centre, const Vector& half)
{
  Vector out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = std::max(0.0, std::abs(p[k] - centre[k]) - half[k]);
  return length(out);
}

} // namespace

ReferenceTree::ReferenceTree(const Points& points) : points_(points)
{
  for (const Point& p : points_) reach_ = std::max(reach_, length({p.x, p.y, p.z}));
  if (!points_.empty()) split(0, static_cast<std::uint32_t>(points_.size()));
}

std::uint32_t ReferenceTree::split(std::uint32_t begin, std::uint32_t end)
{
  constexpr std::uint32_t kLeaf = 8;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector low = {kInfinity, kInfinity, kInfinity}, high = {-kInfinity, -kInfinity, -kInfinity};
  for (std::uint32_t i = begin; i < end; ++i) {
    const Vector p = {points_[i].x, points_[i].y, points_[i].z};
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
  Node node{};
  std::size_t longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    node.centre[k] = 0.5 * (low[k] + high[k]);
    node.half[k] = 0.5 * (high[k] - low[k]);
    if (node.half[k] > node.half[longest]) longest = k;
  }
  node.radius = length(node.half);
  node.begin = begin;
  node.end = end;
  const auto id = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(node);
  if (end - begin > kLeaf) {
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto less = [longest](const Point& p, const Point& q) {
      return longest == 0 ? p.x < q.x : longest == 1 ? p.y < q.y : p.z < q.z;
    };
    std::nth_element(points_.begin() + begin, points_.begin() + middle, points_.begin() + end, less);
    split(begin, middle);
    const std::uint32_t right = split(middle, end);
    nodes_[id].right = right;
  }
  return id;
}

struct ReferenceTree::Descent {
  const ReferenceTree& a;
  const ReferenceTree& b;
  RigidPose to_a;
  RigidPose to_b;
  double best;

  /// No pair below these nodes is nearer. Each side's box against the other's sphere: no oriented boxes needed.
  double lowerBound(const Node& node_a, const Node& node_b) const
  {
    return std::max(toBox(to_a.apply(node_b.centre), node_a.centre, node_a.half) - node_b.radius,
                    toBox(to_b.apply(node_a.centre), node_b.centre, node_b.half) - node_a.radius);
  }

  void visit(std::uint32_t ia, std::uint32_t ib)
  {
    const Node& node_a = a.nodes_[ia];
    const Node& node_b = b.nodes_[ib];
    if (node_a.right == 0 && node_b.right == 0) return compare(node_a, node_b);
    const bool open_a = node_b.right == 0 || (node_a.right != 0 && node_a.radius > node_b.radius);
    const std::array<std::uint32_t, 2> child =
        open_a ? std::array{ia + 1, node_a.right} : std::array{ib + 1, node_b.right};
    std::array<double, 2> bound;
    for (std::size_t k = 0; k < 2; ++k)
      bound[k] = open_a ? lowerBound(a.nodes_[child[k]], node_b) : lowerBound(node_a, b.nodes_[child[k]]);
    const std::size_t nearer = bound[0] <= bound[1] ? 0 : 1;
    for (const std::size_t k : {nearer, 1 - nearer})
      if (bound[k] < best) open_a ? visit(child[k], ib) : visit(ia, child[k]);
  }

  void compare(const Node& node_a, const Node& node_b)
  {
    for (std::uint32_t j = node_b.begin; j < node_b.end; ++j) {
      const Point& point = b.points_[j];
      const Vector q = to_a.apply(Vector{point.x, point.y, point.z});
      for (std::uint32_t i = node_a.begin; i < node_a.end; ++i) {
        const Point& p = a.points_[i];
        best = std::min(best, length({p.x - q[0], p.y - q[1], p.z - q[2]}));
      }
    }
  }
};

double ReferenceTree::distance(const ReferenceTree& other, const RigidPose& pose, double bound) const
{
  if (nodes_.empty() || other.nodes_.empty()) return bound;
  Descent descent{*this, other, pose, pose.inverse(), bound};
  descent.visit(0, 0);
  return descent.best;
}

} // namespace pcl_bsh::bench
