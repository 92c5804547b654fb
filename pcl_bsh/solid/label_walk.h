// SPDX-License-Identifier: BSD-3-Clause
// The descent of one cloud's spheres into a solid: what does not meet the surface gets its label at once.
#pragma once

#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/work.h>
#include <pcl_bsh/solid/point_labels.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace pcl_bsh {

/// The label of a sphere's points before they are looked at: one for all, or unknown.
enum class Whole : std::uint8_t { outside, inside, unknown };

/// A cloud's spheres at one pose of cloud and solid, from the tree above the voxels down to points.
class LabelWalk {
public:
  LabelWalk(const Placed& cloud, const PlacedSolid& solid, Work& work)
  : cloud_(cloud.hierarchy().storage()),
    labels_(cloud.pose, solid),
    work_(work)
  {
    if (cloud_.size > 0) top_ = frameOf(cloud_.frame);
  }

  const SphereHierarchy::Storage& cloud() const noexcept { return cloud_; }

  /// Takes over the gaps that another walk of the same cloud and solid, at the same poses, has found.
  void takeGaps(const LabelWalk& other) { labels_.takeGaps(other.labels_); }

  /// The label of a child of a node above the voxels.
  Whole ofTop(const Node& node, std::uint32_t child) { return of(top_, cloud_.frame.unit, node, child); }

  /// Labels the points of a voxel. The receiver gets all that are not outside: inside(first, last) with a range of
  /// records, or one(record, label). Before, wants(smallest record) asks it whether it needs any points of a node, and
  /// expect(first, last) names records that may follow soon.
  template <class Receiver>
  void labelVoxel(std::uint32_t index, Receiver& receiver)
  {
    const Voxel& voxel = cloud_.voxels[index];
    const PointLabels::Frame frame = frameOf(voxel.frame);
    if (voxel.state.load(std::memory_order_acquire) == Voxel::built) return labelNode(voxel, frame, 0, receiver);
    ++work_.leaf_pairs;
    cloud_.forEachRecord(index,
                         [&](std::uint32_t record) { tell(frame, record, cloud_.view.point(record), receiver); });
  }

private:
  Label labelOf(const PointLabels::Frame& frame, std::uint32_t record)
  {
    return labels_.label(frame, cloud_.view.point(record), work_.exact_decisions);
  }

  PointLabels::Frame frameOf(const LocalFrame& local) const
  {
    // Centres of spheres lie between points; twice their reach is more than enough.
    const double reach = std::max({local.reach[0], local.reach[1], local.reach[2]}) * local.unit;
    return labels_.frameAt(local.origin, 2.0 * reach);
  }

  Whole of(const PointLabels::Frame& frame, double unit, const Node& node, std::uint32_t child)
  {
    ++work_.node_pairs;
    pulse_.step();
    const Point3 center = {static_cast<double>(node.x[child]) * unit, static_cast<double>(node.y[child]) * unit,
                           static_cast<double>(node.z[child]) * unit};
    const Point3 at = labels_.seen(frame, center);
    // A pose may lengthen a radius by little more than half of rigidity_tolerance.
    const double reach = static_cast<double>(node.r[child]) * unit * (1.0 + 4e-6) + frame.error;
    if (!(reach < std::numeric_limits<double>::infinity())) return Whole::unknown;
    if (labels_.columns().isBeyond(at, reach)) return Whole::outside;
    if (!labels_.columns().isClear(at, reach)) return Whole::unknown;
    const std::optional<Label> of_center = labels_.labelAround(at, frame.error); // needs no point's memory
    const Label label = of_center ? *of_center : labelOf(frame, node.lowest[child]);
    return label == Label::outside ? Whole::outside : Whole::inside;
  }

  template <class Receiver>
  void tell(const PointLabels::Frame& frame, std::uint32_t record, const Point3& p, Receiver& receiver)
  {
    if (!receiver.wants(record)) return;
    pulse_.step();
    const Label label = labels_.label(frame, p, work_.exact_decisions);
    if (label != Label::outside) receiver.one(record, label);
  }

  /// Labels a point by its stored place where that decides, else by its given place, which lies anywhere in memory.
  template <class Receiver>
  void labelStored(const Voxel& voxel, const PointLabels::Frame& frame, std::uint32_t i, Receiver& receiver)
  {
    const std::uint32_t record = voxel.records()[i];
    if (!receiver.wants(record)) return;
    pulse_.step();
    const LocalFrame& local = voxel.frame;
    const Point3 at = labels_.seen(frame, {static_cast<double>(voxel.x()[i]) * local.unit,
                                           static_cast<double>(voxel.y()[i]) * local.unit,
                                           static_cast<double>(voxel.z()[i]) * local.unit});
    // Turned, the slack of three axes adds up.
    const double slack = (local.slack(0) + local.slack(1) + local.slack(2)) * local.unit * (1.0 + 4e-6);
    const std::optional<Label> found = labels_.labelAround(at, frame.error + slack);
    const Label label = found ? *found : labels_.label(frame, voxel.point(cloud_.view, i), work_.exact_decisions);
    if (label != Label::outside) receiver.one(record, label);
  }

  template <class Receiver>
  void labelNode(const Voxel& voxel, const PointLabels::Frame& frame, std::uint32_t index, Receiver& receiver)
  {
    const Node& node = voxel.nodes[index];
    const std::uint32_t* records = voxel.records();
    for (std::uint32_t i = 0; i < node.count; ++i) {
      if (!receiver.wants(node.lowest[i])) continue;
      const Whole whole = of(frame, voxel.frame.unit, node, i);
      if (whole == Whole::outside) continue;
      const std::uint32_t begin = node.begin[i], end = node.begin[i + 1];
      if (whole == Whole::inside) {
        receiver.inside(records + begin, records + end);
      }
      else if (node.isLeaf(i) && node.isCoincident(i)) {
        const Label label = labelOf(frame, records[begin]);
        for (std::uint32_t j = begin; j < end && label != Label::outside; ++j) receiver.one(records[j], label);
      }
      else if (!node.isLeaf(i)) {
        labelNode(voxel, frame, node.child[i], receiver);
      }
      else {
        ++work_.leaf_pairs;
        receiver.expect(records + begin, records + end);
        for (std::uint32_t j = begin; j < end; ++j) labelStored(voxel, frame, j, receiver);
      }
    }
  }

  const SphereHierarchy::Storage& cloud_;
  PointLabels labels_;
  PointLabels::Frame top_ = {};
  Work& work_;
  WorkPulse pulse_{work_};
};

} // namespace pcl_bsh
