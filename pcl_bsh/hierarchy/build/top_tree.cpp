// SPDX-License-Identifier: BSD-3-Clause
// The octree above the voxels, so that a descent sees one sphere tree from the cloud down to the points.
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace pcl_bsh {
namespace {

/// A voxel's bounds in the cloud's frame, in doubles; rounding is made good by `kSlack` of the largest coordinate.
struct CloudBox {
  std::array<double, 3> low, high;
};

constexpr double kSlack = kFewDoubleRoundings;

class TopBuilder {
public:
  TopBuilder(const std::vector<Voxel*>& voxels, const LocalFrame& frame, std::vector<Node> reuse)
  : nodes(std::move(reuse)),
    voxels_(voxels),
    frame_(frame)
  {
    nodes.clear();
    cut(0, static_cast<std::uint32_t>(voxels.size()));
  }

  std::vector<Node> nodes;

private:
  /// The node over voxels [begin, end). Its children are cells of a binary octree: the fullest one is halved, where its
  /// keys first differ, until there are eight.
  std::uint32_t cut(std::uint32_t begin, std::uint32_t end)
  {
    const auto node = static_cast<std::uint32_t>(nodes.size());
    nodes.emplace_back();
    std::array<std::uint32_t, kNodeChildren + 1> starts = {begin, end};
    std::uint32_t count = 1;
    while (count < kNodeChildren) {
      std::uint32_t fullest = 0;
      for (std::uint32_t i = 1; i < count; ++i)
        if (starts[i + 1] - starts[i] > starts[fullest + 1] - starts[fullest]) fullest = i;
      if (starts[fullest + 1] - starts[fullest] == 1) break;
      const std::uint32_t middle = halve(starts[fullest], starts[fullest + 1]);
      std::copy_backward(starts.begin() + fullest + 1, starts.begin() + count + 1, starts.begin() + count + 2);
      starts[fullest + 1] = middle;
      ++count;
    }
    nodes[node].count = count;
    nodes[node].begin[0] = begin;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t from = starts[i], to = starts[i + 1];
      const std::uint32_t below = to - from == 1 ? Node::kLeaf : cut(from, to);
      nodes[node].begin[i + 1] = to;
      nodes[node].child[i] = below;
      nodes[node].lowest[i] = lowestRecord(from, to);
      fitSphere(nodes[node], i);
    }
    nodes[node].clearUnused();
    return node;
  }

  /// The first voxel of [begin, end) whose key has the highest bit set in which these keys differ.
  std::uint32_t halve(std::uint32_t begin, std::uint32_t end) const
  {
    const std::uint64_t bit = std::bit_floor(voxels_[begin]->key ^ voxels_[end - 1]->key);
    const auto middle = std::partition_point(voxels_.begin() + begin, voxels_.begin() + end,
                                             [bit](const Voxel* v) { return (v->key & bit) == 0; });
    return static_cast<std::uint32_t>(middle - voxels_.begin());
  }

  std::uint32_t lowestRecord(std::uint32_t begin, std::uint32_t end) const
  {
    std::uint32_t lowest = 0xffffffffu;
    for (std::uint32_t v = begin; v < end; ++v) lowest = std::min(lowest, voxels_[v]->lowest);
    return lowest;
  }

  CloudBox boxOf(std::uint32_t v) const
  {
    const LocalFrame& f = voxels_[v]->frame;
    CloudBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      const double origin = f.origin[k] / frame_.unit - frame_.origin[k] / frame_.unit;
      const double half = (f.reach[k] + f.slack(static_cast<int>(k))) * (f.unit / frame_.unit);
      box.low[k] = origin - half;
      box.high[k] = origin + half;
    }
    return box;
  }

  /// Around the voxels' boxes; each box's farthest corner decides.
  void fitSphere(Node& node, std::uint32_t i) const
  {
    CloudBox all = boxOf(node.begin[i]);
    for (std::uint32_t v = node.begin[i] + 1; v < node.begin[i + 1]; ++v) {
      const CloudBox box = boxOf(v);
      for (std::size_t k = 0; k < 3; ++k) {
        all.low[k] = std::min(all.low[k], box.low[k]);
        all.high[k] = std::max(all.high[k], box.high[k]);
      }
    }
    std::array<float, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = roundToFloat(0.5 * all.low[k] + 0.5 * all.high[k]);
    double radius = 0.0;
    for (std::uint32_t v = node.begin[i]; v < node.begin[i + 1]; ++v) {
      const CloudBox box = boxOf(v);
      double squared = 0.0, largest = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double corner = std::max(std::abs(box.low[k] - c[k]), std::abs(box.high[k] - c[k]));
        squared += corner * corner;
        largest =
            std::max({largest, std::abs(box.low[k]), std::abs(box.high[k]), std::abs(frame_.origin[k] / frame_.unit)});
      }
      const double ball = static_cast<double>(voxels_[v]->largest_radius) / frame_.unit;
      radius = std::max(radius, (std::sqrt(squared) + ball) * (1.0 + kSlack) + 4 * kSlack * largest);
    }
    node.x[i] = c[0], node.y[i] = c[1], node.z[i] = c[2];
    node.r[i] = roundUp(radius + kSmallestLength);
  }

  const std::vector<Voxel*>& voxels_;
  const LocalFrame& frame_;
};

} // namespace

std::vector<Node> buildTop(const std::vector<Voxel*>& voxels, const LocalFrame& frame, std::vector<Node> reuse)
{
  return std::move(TopBuilder(voxels, frame, std::move(reuse)).nodes);
}

} // namespace pcl_bsh
