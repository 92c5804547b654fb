// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/box_tree.h>

#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr double kVanishing = 0x1p-140; ///< above what underflows
constexpr float kNone = std::numeric_limits<float>::infinity();

/// Sets a child's box to [low, high] on an axis, moved by offset, widened for the rounding of both.
void place(BoxNode& node, std::uint32_t lane, std::size_t axis, double low, double high, double offset, double slack)
{
  const double margin = slack + kFewDoubleRoundings * (std::abs(offset) + std::abs(low) + std::abs(high)) + kVanishing;
  node.low[axis][lane] = roundDown(offset + low - margin);
  node.high[axis][lane] = roundUp(offset + high + margin);
}

/// The box of a child is the one around the boxes of the node below it.
void enclose(BoxNode& node, std::uint32_t lane, const BoxNode& below)
{
  const std::uint32_t count = below.count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.low[axis][lane] = *std::min_element(below.low[axis], below.low[axis] + count);
    node.high[axis][lane] = *std::max_element(below.high[axis], below.high[axis] + count);
  }
}

struct LeafBox {
  float low[3], high[3];
  std::uint32_t number; ///< BoxNode::leaf()
};

/// A tree of boxes over a voxel's leaves.
class LeafGrouping {
public:
  LeafGrouping(std::vector<LeafBox> leaves, const float* stretch) : leaves_(std::move(leaves)), stretch_(stretch) {}

  std::vector<BoxNode> run()
  {
    group(measured(leaves_.begin(), leaves_.end()));
    return std::move(boxes_);
  }

private:
  using Place = std::vector<LeafBox>::iterator;

  struct Group {
    Place begin, end;
    std::size_t axis = 0; ///< along which it is divided, at a place of the leaves' middles
    float size = -1.0f;   ///< along it, by the stretch; negative: one leaf
    float twice_at = 0.0f;
  };

  static constexpr std::ptrdiff_t kLeastShare = 16; ///< a half with less than this part: the leaves' number is halved

  static float twiceMiddle(const LeafBox& leaf, std::size_t axis) { return leaf.low[axis] + leaf.high[axis]; }

  Group measured(Place begin, Place end) const
  {
    Group group{begin, end};
    for (std::size_t axis = 0; axis < 3 && end - begin > 1; ++axis) {
      float least = kNone, most = -kNone;
      for (Place leaf = begin; leaf != end; ++leaf) {
        least = std::min(least, twiceMiddle(*leaf, axis));
        most = std::max(most, twiceMiddle(*leaf, axis));
      }
      const float size = (most - least) / stretch_[axis];
      if (size <= group.size) continue;
      group.axis = axis;
      group.size = size;
      group.twice_at = 0.5f * least + 0.5f * most;
    }
    return group;
  }

  /// In the middle of its space; of its leaves, where nearly all are on one side, so that the tree is never deep.
  Place divided(const Group& group) const
  {
    const Place place = std::partition(
        group.begin, group.end, [&](const LeafBox& leaf) { return twiceMiddle(leaf, group.axis) < group.twice_at; });
    const std::ptrdiff_t count = group.end - group.begin;
    if (kLeastShare * std::min(place - group.begin, group.end - place) > count) return place;
    const Place middle = group.begin + count / 2;
    std::nth_element(group.begin, middle, group.end, [&](const LeafBox& a, const LeafBox& b) {
      return twiceMiddle(a, group.axis) < twiceMiddle(b, group.axis);
    });
    return middle;
  }

  /// @return the node that it becomes
  std::uint32_t group(const Group& whole)
  {
    Group parts[kNodeChildren] = {whole};
    std::uint32_t count = 1;
    while (count < kNodeChildren) {
      Group& largest =
          *std::max_element(parts, parts + count, [](const Group& a, const Group& b) { return a.size < b.size; });
      if (largest.size < 0.0f) break;
      const Place middle = divided(largest);
      parts[count++] = measured(middle, largest.end);
      largest = measured(largest.begin, middle);
    }
    const auto index = static_cast<std::uint32_t>(boxes_.size());
    boxes_.emplace_back().count = count;
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      const bool is_leaf = parts[lane].size < 0.0f;
      const std::uint32_t below = is_leaf ? BoxNode::kLeaf | parts[lane].begin->number : group(parts[lane]);
      boxes_[index].child[lane] = below;
      if (!is_leaf) {
        enclose(boxes_[index], lane, boxes_[below]);
        continue;
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        boxes_[index].low[axis][lane] = parts[lane].begin->low[axis];
        boxes_[index].high[axis][lane] = parts[lane].begin->high[axis];
      }
    }
    return index;
  }

  std::vector<LeafBox> leaves_;
  const float* stretch_;
  std::vector<BoxNode> boxes_;
};

} // namespace

BoxTree::BoxTree(const SphereHierarchy::Storage& of, const Travel& travel)
: storage(of),
  origin(of.frame.origin),
  voxels_(std::make_unique<Entry[]>(of.voxel_count))
{
  std::fill(low, low + 3, kNone);
  std::fill(high, high + 3, -kNone);
  for (std::size_t v = 0; v < storage.voxel_count; ++v) {
    const LocalFrame& frame = storage.voxels[v].frame;
    double slack = 0.0;
    for (int k = 0; k < 3; ++k) {
      slack += frame.slack(k) * frame.slack(k);
      voxel_reach = std::max(voxel_reach, frame.reach[static_cast<std::size_t>(k)] * frame.unit);
    }
    voxel_slack = std::max(voxel_slack, std::sqrt(slack) * (1.0 + kDoubleMargin) * frame.unit);
  }
  if (storage.size > 0) fitTop();
  setStretch(travel);
}

void BoxTree::setStretch(const Travel& travel)
{
  const double all = travel.way[0] + travel.way[1] + travel.way[2] + travel.turned * radius;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double ratio = travel.way[axis] / (all - travel.way[axis]);
    stretch[axis] = ratio > 1.0 ? roundToFloat(std::min(ratio, kMostStretch)) : 1.0f; // 1 at rest, too
  }
}

Point3 BoxTree::offset(std::uint32_t index) const
{
  const Point3& at = storage.voxels[index].frame.origin;
  return {at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]};
}

void BoxTree::fitTop()
{
  top_.resize(storage.top.size());
  for (std::size_t n = top_.size(); n-- > 0;) { // children come after their parents
    const Node& node = storage.top[n];
    top_[n].count = node.count;
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!node.isLeaf(lane)) {
        top_[n].child[lane] = node.child[lane];
        enclose(top_[n], lane, top_[node.child[lane]]);
        continue;
      }
      top_[n].child[lane] = BoxNode::kLeaf | node.begin[lane];
      const LocalFrame& frame = storage.voxels[node.begin[lane]].frame;
      const Point3 at = offset(node.begin[lane]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double reach = frame.reach[axis] * frame.unit;
        place(top_[n], lane, axis, -reach, reach, at[axis], frame.slack(static_cast<int>(axis)) * frame.unit);
      }
    }
  }
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = *std::min_element(top_[0].low[axis], top_[0].low[axis] + storage.top[0].count);
    high[axis] = *std::max_element(top_[0].high[axis], top_[0].high[axis] + storage.top[0].count);
    const double reach = std::max(std::abs(static_cast<double>(low[axis])), std::abs(static_cast<double>(high[axis])));
    squared += reach * reach;
  }
  radius = std::sqrt(squared) * (1.0 + kDoubleMargin);
}

const std::vector<BoxNode>& BoxTree::voxel(std::uint32_t index, Work& work) const
{
  Entry& entry = voxels_[index];
  std::call_once(entry.once, [&] {
    const Voxel& built = storage.built(index, work);
    entry.boxes = fitVoxel(built, index);
    for (const BoxNode& node : entry.boxes) work.volumes_built += node.count;
  });
  return entry.boxes;
}

std::vector<BoxNode> BoxTree::fitVoxel(const Voxel& voxel, std::uint32_t index) const
{
  std::vector<LeafBox> leaves;
  const Point3 at = offset(index);
  const float* coordinates[3] = {voxel.x(), voxel.y(), voxel.z()};
  const double unit = voxel.frame.unit;
  for (std::uint32_t n = 0; n < voxel.nodes.size(); ++n) {
    const Node& node = voxel.nodes[n];
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!node.isLeaf(lane)) continue;
      LeafBox& leaf = leaves.emplace_back();
      leaf.number = static_cast<std::uint32_t>(n * kNodeChildren + lane);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [least, most] =
            std::minmax_element(coordinates[axis] + node.begin[lane], coordinates[axis] + node.begin[lane + 1]);
        BoxNode box;
        place(box, 0, axis, *least * unit, *most * unit, at[axis], voxel.frame.slack(static_cast<int>(axis)) * unit);
        leaf.low[axis] = box.low[axis][0];
        leaf.high[axis] = box.high[axis][0];
      }
    }
  }
  return LeafGrouping(std::move(leaves), stretch).run();
}

} // namespace pcl_bsh
