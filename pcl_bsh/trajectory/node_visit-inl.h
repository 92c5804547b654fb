// SPDX-License-Identifier: BSD-3-Clause
// The state of a walk along a trajectory at one node of the scan, as the model sees it.

#if defined(PCL_BSH_TRAJECTORY_NODE_VISIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_NODE_VISIT_INL_H_
#undef PCL_BSH_TRAJECTORY_NODE_VISIT_INL_H_
#else
#define PCL_BSH_TRAJECTORY_NODE_VISIT_INL_H_
#endif

#include <pcl_bsh/trajectory/boxes/model_boxes-inl.h>
#include <pcl_bsh/trajectory/voxel_in_model_frame-inl.h>
#include <pcl_bsh/traversal/list_walk-inl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Boxes around the nodes of a scan's voxel, along the model's axes where the model first comes near. Walls run along a
/// vehicle's path, so that these boxes are thin where spheres reach across the gap to the vehicle's side.
class OrientedBoxes {
public:
  explicit OrientedBoxes(const VoxelInModelFrame& voxel_frame) : voxel_frame_(voxel_frame) {}

  /// Fits a box around each child of each node. @param map from the voxel into the model, at the pose at which the
  /// boxes are parallel to the model's axes
  void fit(const Voxel& voxel, const AffineMap& map)
  {
    const auto unit = static_cast<float>(voxel_frame_.frame.unit);
    for (std::size_t i = 0; i < 9; ++i) axes_[i] = map.m[i] / unit;
    slack_ = kRounding * voxel.radius * unit;
    halves_.resize(voxel.nodes.size());
    for (std::size_t n = halves_.size(); n-- > 0;) { // children come after their parents
      const Node& node = voxel.nodes[n];
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        Half& half = halves_[n];
        for (std::size_t axis = 0; axis < 3; ++axis) half[axis][lane] = 0.0f;
        if (lane >= node.count) continue;
        const Point center{node.x[lane], node.y[lane], node.z[lane]};
        if (node.isLeaf(lane)) {
          const std::uint32_t end = node.begin[lane] + node.comparedPoints(lane);
          for (std::uint32_t i = node.begin[lane]; i < end; ++i)
            include(half, lane, center, {voxel.x()[i], voxel.y()[i], voxel.z()[i]}, nullptr, 0,
                    voxel.radii ? roundUp(voxel.radii[i] / voxel_frame_.frame.unit) : 0.0f);
          continue;
        }
        const Node& below = voxel.nodes[node.child[lane]];
        for (std::uint32_t i = 0; i < below.count; ++i)
          include(half, lane, center, {below.x[i], below.y[i], below.z[i]}, &halves_[node.child[lane]], i);
      }
    }
  }

  /// How far each child of a node reaches from its centre, along the model's axes, at any instant of the voxel's
  /// motion.
  /// @param radius of each child's sphere: no extent is larger
  void see(std::uint32_t node, const VoxelMotion& motion, const float (&radius)[kLanes],
           float (&extent)[3][kLanes]) const
  {
    if (halves_.empty()) {
      for (std::size_t axis = 0; axis < 3; ++axis) std::copy(radius, radius + kLanes, extent[axis]);
      return;
    }
    const Half& half = halves_[node];
    const float share = kRounding + 4.0f * static_cast<float>(voxel_frame_.path.skew);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float turn[3][3];
      const float* ends[3] = {motion.from.m + 3 * axis, motion.to.m + 3 * axis, motion.bow.m + 3 * axis};
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < 3; ++j) {
          const float* along = axes_ + 3 * j;
          turn[k][j] = std::abs(ends[k][0] * along[0] + ends[k][1] * along[1] + ends[k][2] * along[2]);
        }
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const float first = turn[0][0] * half[0][lane] + turn[0][1] * half[1][lane] + turn[0][2] * half[2][lane];
        const float last = turn[1][0] * half[0][lane] + turn[1][1] * half[1][lane] + turn[1][2] * half[2][lane];
        const float bow = turn[2][0] * half[0][lane] + turn[2][1] * half[1][lane] + turn[2][2] * half[2][lane];
        extent[axis][lane] = std::min(radius[lane], std::max(first, last) + bow + share * radius[lane] + slack_);
      }
    }
  }

private:
  /// The children's boxes: how far they reach from their spheres' centres along each axis, in the voxel's unit.
  using Half = std::array<std::array<float, kLanes>, 3>;

  static constexpr float kRounding = 0x1p-17f; ///< some 20 u of the voxel's radius, and of turns

  void include(Half& half, std::uint32_t lane, const Point& center, const Point& at, const Half* around,
               std::uint32_t its_lane, float radius = 0.0f) const
  {
    const float x = at.x - center.x, y = at.y - center.y, z = at.z - center.z;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float* along = axes_ + 3 * axis;
      const float away = std::abs(along[0] * x + along[1] * y + along[2] * z);
      half[axis][lane] = std::max(half[axis][lane], away + (around ? (*around)[axis][its_lane] : radius));
    }
  }

  const VoxelInModelFrame& voxel_frame_;
  float axes_[9] = {}; ///< of the boxes, seen by the voxel
  float slack_ = 0.0f;
  std::vector<Half> halves_;
};

/// A node of the scan that is tested against the model, all of its children at once.
struct NodeVisit : ListVisit<Siblings> {
  Segments<kLanes, 3> children;
  Segment around;
  float radius[kLanes];
  std::vector<Siblings> candidates; ///< boxes that any of them may meet
  // Set at one pose only. Per child: its box, the squared distance beyond which boxes of the model do not matter, and
  // an upper bound of the distance from each of its points to the nearest point of the model.
  alignas(64) float low[3][kLanes], high[3][kLanes], near_squared[kLanes], bound[kLanes];

  /// @param index of the node in its voxel
  void begin(const Node& entered, std::uint32_t index, const VoxelMotion& motion, const VoxelInModelFrame& voxel_frame,
             const OrientedBoxes& oriented_boxes)
  {
    ListVisit::begin(entered);
    alignas(64) float from[3][kLanes], to[3][kLanes], bow[3][kLanes];
    carry(motion.from.m, motion.from.g, entered.x, entered.y, entered.z, kLanes, from[0], from[1], from[2]);
    carry(motion.to.m, motion.to.g, entered.x, entered.y, entered.z, kLanes, to[0], to[1], to[2]);
    carry(motion.bow.m, motion.bow.g, entered.x, entered.y, entered.z, kLanes, bow[0], bow[1], bow[2]);
    children.set(from, to, bow, motion.smallest);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) radius[lane] = voxel_frame.seenRadius(entered.r[lane]);
    alignas(64) float extent[3][kLanes];
    oriented_boxes.see(index, motion, radius, extent);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::uint32_t lane = 0; lane < kLanes; ++lane)
        children.reach[axis][lane] = (motion.reach + extent[axis][lane]) * (1.0f + kReachMargin);
    children.ball = motion.reach * (1.0f + kReachMargin);
    around = voxel_frame.aroundSegments(motion, from, to, bow, extent, entered.count);
    if (!motion.at_rest) return;
    constexpr float unbounded = std::numeric_limits<float>::infinity();
    std::fill(bound, bound + kLanes, unbounded);
    std::fill(near_squared, near_squared + kLanes, voxel_frame.nearSquared(motion, unbounded));
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        low[axis][lane] = from[axis][lane] - extent[axis][lane] * (1.0f + kReachMargin);
        high[axis][lane] = from[axis][lane] + extent[axis][lane] * (1.0f + kReachMargin);
      }
  }
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
