// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/pairs/object_boxes.h>

#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/scene/scene.h>

#include <cmath>

namespace pcl_bsh {
namespace {

constexpr double kLooseBall = 0.125; // of a part's size
constexpr double kMargin = 0x1p-45;  // of the largest number that went into a bound: far above what rounding takes

double largest(const Box3& box)
{
  return std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
}

Box3 boxOfCorners(const PointsView& triangles)
{
  Box3 box;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t record = triangles.record(i);
    if (!isFinite(triangles.point(record))) continue;
    for (const Point3& corner : triangles.triangles->triangle(record)) {
      const Eigen::Vector3d at(corner[0], corner[1], corner[2]);
      box.merge({at, at});
    }
  }
  return box;
}

} // namespace

Box3 moved(const Box3& box, const Eigen::Isometry3d& pose)
{
  if (box.empty()) return box;
  const Eigen::Vector3d center = pose * box.center();
  const Eigen::Vector3d half = pose.linear().cwiseAbs() * box.half();
  Box3 result{center - half, center + half};
  result.grow(kMargin * (largest(box) + pose.translation().cwiseAbs().maxCoeff()));
  if (!result.low.allFinite() || !result.high.allFinite()) { // too large to compute with: it may be anywhere
    result.low.setConstant(-std::numeric_limits<double>::infinity());
    result.high.setConstant(std::numeric_limits<double>::infinity());
  }
  return result;
}

double outreach(const SphereHierarchy& hierarchy)
{
  const SphereHierarchy::Storage& storage = hierarchy.storage();
  return storage.uncertainty.most > 0.0 ? (storage.largest_radius + storage.uncertainty.most) * (1.0 + kMargin)
                                        : storage.largest_radius;
}

Box3 boxOf(const LocalFrame& frame)
{
  Box3 box;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double half = (frame.reach[axis] + frame.slack(k)) * frame.unit;
    box.low[k] = frame.origin[axis] - half;
    box.high[k] = frame.origin[axis] + half;
  }
  return box;
}

Box3 boxOf(const SphereHierarchy& hierarchy)
{
  const SphereHierarchy::Storage& storage = hierarchy.storage();
  if (storage.size == 0) return Box3();
  Box3 box = boxOf(storage.frame);
  // Balls of large triangles, those of a floor, say, reach far beyond them.
  if (storage.view.triangles && storage.largest_radius > kLooseBall * box.half().norm()) {
    box = boxOfCorners(storage.view);
    box.grow(storage.uncertainty.most * (1.0 + kMargin) + kMargin * largest(box));
    return box;
  }
  box.grow(outreach(hierarchy) + kMargin * largest(box));
  return box;
}

Box3 boxOf(const SceneObject& object)
{
  Box3 box;
  for (const ScenePart& part : object.parts) box.merge(moved(boxOf(*part.hierarchy), part.pose));
  return box;
}

double motionBound(const Box3& box, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to)
{
  if (box.empty()) return 0.0;
  const Eigen::Vector3d center = box.center();
  const double shift = (to * center - from * center).norm();
  const double turn = (to.linear() - from.linear()).norm() * box.half().norm();
  const double rounding =
      kMargin * (largest(box) + from.translation().cwiseAbs().maxCoeff() + to.translation().cwiseAbs().maxCoeff());
  return (shift + turn) * (1.0 + kMargin) + rounding;
}

} // namespace pcl_bsh
