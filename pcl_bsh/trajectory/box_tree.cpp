// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/box_tree.h>

#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <cmath>

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
void enclose(BoxNode& node, std::uint32_t lane, const BoxNode& below, std::uint32_t count)
{
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.low[axis][lane] = *std::min_element(below.low[axis], below.low[axis] + count);
    node.high[axis][lane] = *std::max_element(below.high[axis], below.high[axis] + count);
  }
}

} // namespace

BoxTree::BoxTree(const SphereHierarchy::Storage& of)
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
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!node.isLeaf(lane)) {
        enclose(top_[n], lane, top_[node.child[lane]], storage.top[node.child[lane]].count);
        continue;
      }
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
    fitVoxel(built, index, entry.boxes);
    work.volumes_built += countChildren(built.nodes);
  });
  return entry.boxes;
}

void BoxTree::fitVoxel(const Voxel& voxel, std::uint32_t index, std::vector<BoxNode>& boxes) const
{
  boxes.resize(voxel.nodes.size());
  const Point3 at = offset(index);
  const float* coordinates[3] = {voxel.x(), voxel.y(), voxel.z()};
  for (std::size_t n = boxes.size(); n-- > 0;) {
    const Node& node = voxel.nodes[n];
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (!node.isLeaf(lane)) {
        enclose(boxes[n], lane, boxes[node.child[lane]], voxel.nodes[node.child[lane]].count);
        continue;
      }
      const double unit = voxel.frame.unit;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float* from = coordinates[axis] + node.begin[lane];
        float least = from[0], most = from[0];
        for (std::uint32_t i = 1; i < node.points(lane); ++i) {
          least = std::min(least, from[i]);
          most = std::max(most, from[i]);
        }
        place(boxes[n], lane, axis, least * unit, most * unit, at[axis],
              voxel.frame.slack(static_cast<int>(axis)) * unit);
      }
    }
  }
}

} // namespace pcl_bsh
