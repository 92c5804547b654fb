// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/triangle/triangle_distance.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/neighbors/neighbor_scratch.h>
#include <pcl_bsh/robot/convex_distance.h>
#include <pcl_bsh/robot/obstacle_gap.h>
#include <pcl_bsh/robot/outward.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl_bsh::robots {

namespace {

/// A descent to the record with the least gap, nearest nodes first.
template <class Probe>
class GapWalk {
public:
  GapWalk(const SphereHierarchy& hierarchy, const Probe& probe, double limit)
  : cloud_(hierarchy.storage()),
    probe_(probe),
    limit_(limit)
  {
  }

  Gap run()
  {
    if (cloud_.size > 0)
      visit(cloud_.frame, cloud_.top, 0, [&](const Node& node, std::uint32_t i) {
        const Voxel& voxel = cloud_.built(node.begin[i], work_);
        visit(voxel.frame, voxel.nodes, 0,
              [&](const Node& leaf, std::uint32_t k) { compare(voxel, leaf.begin[k], leaf.begin[k + 1]); });
      });
    if (!(best_.upper <= limit_) && !(lowest_.lower <= limit_)) return {{limit_, kInfinity}};
    return {{lowest_.lower, best_.upper}, best_.record, lowest_.record};
  }

private:
  double reach() const { return std::min(best_.upper, limit_); }

  template <class Leaf>
  void visit(const LocalFrame& frame, const std::vector<Node>& nodes, std::uint32_t index, const Leaf& leaf)
  {
    const Node& node = nodes[index];
    std::array<std::pair<double, std::uint32_t>, kNodeChildren> children;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const auto at = [&](const float* of, std::size_t axis) {
        return frame.origin[axis] + frame.unit * static_cast<double>(of[i]);
      };
      const Eigen::Vector3d center(at(node.x, 0), at(node.y, 1), at(node.z, 2));
      const double radius = frame.unit * static_cast<double>(node.r[i]);
      constexpr double roundings = 0x1p-44;
      const double gap =
          probe_.toPoint(center) - radius - roundings * (center.lpNorm<1>() + radius) - cloud_.uncertainty.most;
      if (gap <= reach()) children[count++] = {gap, i};
    }
    std::sort(children.begin(), children.begin() + count);
    for (std::uint32_t k = 0; k < count && children[k].first <= reach(); ++k) {
      const std::uint32_t i = children[k].second;
      if (node.isLeaf(i))
        leaf(node, i);
      else
        visit(frame, nodes, node.child[i], leaf);
    }
  }

  void compare(const Voxel& voxel, std::uint32_t begin, std::uint32_t end)
  {
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t record = voxel.records()[i];
      const double uncertain = cloud_.view.uncertainty + cloud_.view.ownUncertainty(record);
      Interval gap = cloud_.view.triangles
                         ? probe_.toTriangle(cloud_.view.triangles->triangle(record), reach() + uncertain)
                         : ofPoint(voxel.point(cloud_.view, i), record);
      gap.lower -= uncertain;
      gap.upper += uncertain;
      if (gap.lower > reach()) continue;
      if (gap.lower < lowest_.lower) lowest_ = {gap, record};
      if (gap.upper < best_.upper) best_ = {gap, record};
    }
  }

  Interval ofPoint(const Point3& p, std::uint32_t record) const
  {
    const double gap = probe_.toPoint({p[0], p[1], p[2]}) - cloud_.view.radius(record);
    return {gap, gap};
  }

  const SphereHierarchy::Storage& cloud_;
  const Probe& probe_;
  const double limit_;
  Gap best_{{kInfinity, kInfinity}}, lowest_{{kInfinity, kInfinity}}; ///< by their upper and lower bounds
  BuildWork work_;
};

struct PointProbe {
  const Eigen::Vector3d& at;
  TriangleDistance triangles{Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};

  double toPoint(const Eigen::Vector3d& p) const { return (p - at).norm(); }
  Interval toTriangle(const std::array<Point3, 3>& corners, double) const
  {
    const TriangleDistance::Enclosure found = triangles.enclose(Point3{at.x(), at.y(), at.z()}, corners);
    if (std::isfinite(found.high)) return {found.low, found.high};
    const double rounded = triangles.distance(Point3{at.x(), at.y(), at.z()}, corners);
    return {rounded * (1.0 - 0x1p-52), rounded * (1.0 + 0x1p-52)};
  }
};

struct SolidProbe {
  const Solid& solid;
  const Kinematics::Pose& pose;

  double toPoint(const Eigen::Vector3d& p) const
  {
    return signedDistance(solid, pose.rotation.transpose() * (p - pose.translation));
  }
  Interval toTriangle(const std::array<Point3, 3>& corners, double limit) const
  {
    const double round = roundness(solid);
    Interval found = convexDistance(
        [&](const Eigen::Vector3d& direction) { return pose * support(solid, pose.rotation.transpose() * direction); },
        [&](const Eigen::Vector3d& direction) {
          Eigen::Vector3d best;
          double most = -kInfinity;
          for (const Point3& corner : corners) {
            const Eigen::Vector3d p(corner[0], corner[1], corner[2]);
            if (const double along = direction.dot(p); along > most) most = along, best = p;
          }
          return best;
        },
        limit + round);
    found.lower -= round;
    found.upper -= round;
    return found;
  }
};

} // namespace

Obstacle::Obstacle(const SphereHierarchy& hierarchy) : hierarchy_(&hierarchy)
{
  const PointsView& view = hierarchy.view();
  if (view.triangles || view.uncertainties) return;
  if (!view.radii) {
    radius_ = 0.0;
    return;
  }
  if (view.size() == 0) return;
  const double first = view.radius(view.record(0));
  for (std::size_t i = 0; i < view.size(); ++i)
    if (view.radius(view.record(i)) != first) return;
  radius_ = first;
}

double Obstacle::mostUncertain() const noexcept
{
  return hierarchy_->storage().uncertainty.most;
}

Gap Obstacle::gap(const Eigen::Vector3d& place, double limit) const
{
  const Eigen::Vector3d point = pose.inverse() * place;
  if (!radius_) return GapWalk<PointProbe>(*hierarchy_, {point}, limit).run();
  Gap gap{{limit, kInfinity}};
  const double uncertain = hierarchy_->view().uncertainty, within = limit + *radius_ + uncertain;
  if (within < 0.0) return gap;
  const ScratchLease<NeighborScratch> scratch;
  Work work;
  findNearest(hierarchy_->storage(), {point.x(), point.y(), point.z()}, 1, within, *scratch, work);
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < (*scratch).squared.size(); ++i) {
    if (!((*scratch).squared.data()[i] < least)) continue;
    least = (*scratch).squared.data()[i];
    gap.record = (*scratch).records.data()[i];
  }
  gap.possible = gap.record;
  if (gap.record == kNothing) return gap;
  // Squares are rounded once to float; those that are denormal err by an absolute amount.
  const double distance = std::sqrt(static_cast<double>(least));
  gap.lower = distance * (1.0 - 0x1p-23) - 0x1p-70 - *radius_ - uncertain;
  gap.upper = distance * (1.0 + 0x1p-23) + 0x1p-70 - *radius_ + uncertain;
  return gap;
}

Gap Obstacle::gap(const Solid& solid, const Kinematics::Pose& place, double limit) const
{
  if (const auto* ball = std::get_if<Sphere>(&solid)) {
    Gap found = gap(place.translation, limit + ball->radius);
    found.lower -= ball->radius;
    found.upper -= ball->radius;
    return found;
  }
  const Kinematics::Pose seen = pose.inverse() * place;
  return GapWalk<SolidProbe>(*hierarchy_, {solid, seen}, limit).run();
}

} // namespace pcl_bsh::robots
