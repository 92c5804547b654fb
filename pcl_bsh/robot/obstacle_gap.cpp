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
  /// @param any whether any record within the limit will do
  GapWalk(const SphereHierarchy& hierarchy, const Probe& probe, double limit, bool any = false)
  : cloud_(hierarchy.storage()),
    probe_(probe),
    limit_(limit),
    any_(any)
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
  double reach() const { return any_ && best_.upper <= limit_ ? -kInfinity : std::min(best_.upper, limit_); }

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
      const double gap = probe_.atLeast(center, reach() + radius + cloud_.uncertainty.most) - radius -
                         roundings * (center.lpNorm<1>() + radius) - cloud_.uncertainty.most;
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
                         : ofPoint(voxel.point(cloud_.view, i), record, uncertain);
      gap.lower -= uncertain;
      gap.upper += uncertain;
      if (gap.lower > reach()) continue;
      if (gap.lower < lowest_.lower) lowest_ = {gap, record};
      if (gap.upper < best_.upper) best_ = {gap, record};
    }
  }

  Interval ofPoint(const Point3& p, std::uint32_t record, double uncertain) const
  {
    const double radius = cloud_.view.radius(record);
    const Interval found = probe_.toPoint({p[0], p[1], p[2]}, reach() + radius + uncertain);
    return {found.lower - radius, found.upper - radius};
  }

  const SphereHierarchy::Storage& cloud_;
  const Probe& probe_;
  const double limit_;
  const bool any_;
  Gap best_{{kInfinity, kInfinity}}, lowest_{{kInfinity, kInfinity}}; ///< by their upper and lower bounds
  BuildWork work_;
};

template <class Record>
Interval enclosed(const TriangleDistance& distances, const Record& record, const Triangle3& triangle)
{
  const TriangleDistance::Enclosure found = distances.enclose(record, triangle);
  if (std::isfinite(found.high)) return {found.low, found.high};
  const double rounded = distances.distance(record, triangle);
  return {rounded * (1.0 - 0x1p-52), rounded * (1.0 + 0x1p-52)};
}

struct PointProbe {
  const Eigen::Vector3d& at;
  TriangleDistance triangles{Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};

  double atLeast(const Eigen::Vector3d& p, double) const { return (p - at).norm(); }
  Interval toPoint(const Eigen::Vector3d& p, double) const
  {
    const double distance = (p - at).norm();
    return {distance, distance};
  }
  Interval toTriangle(const Triangle3& corners, double) const
  {
    return enclosed(triangles, Point3{at.x(), at.y(), at.z()}, corners);
  }
};

/// The planes that bound a triangle: its own, and those through its edges at right angles to it. Their normals have
/// length 1.
class Planes {
public:
  /// Sets the planes. @return whether they are known: rounding turns those of a narrow triangle too far
  bool set(const Triangle3& triangle, const Kinematics::Pose& pose)
  {
    // Coordinates are off by 2^-50 of their size, so an edge by less than 2^-35 of its length, and normals turn by less
    // than a few 2^-25.
    constexpr double kNarrow = 0x1p-10, kShort = 0x1p-14;
    std::array<Eigen::Vector3d, 3> at;
    double size = pose.translation.lpNorm<1>();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d corner(triangle[k][0], triangle[k][1], triangle[k][2]);
      at[k] = pose * corner;
      size = std::max(size, corner.lpNorm<1>());
    }
    const Eigen::Vector3d one = at[1] - at[0], other = at[2] - at[0], across = one.cross(other);
    const double length = across.norm();
    const bool is_wide = length > kNarrow * one.norm() * other.norm();
    if (!is_wide || !(std::min(one.norm(), other.norm()) > kShort * size)) return false;
    const Eigen::Vector3d normal = across / length;
    put(0, normal, at[0]);
    for (std::size_t k = 0; k < 3; ++k)
      put(static_cast<Eigen::Index>(k) + 1, (at[(k + 1) % 3] - at[k]).cross(normal).normalized(), at[k]);
    return true;
  }

  /// Returns a lower bound of a point's distance from the triangle. @param turned how far off its distance from a plane
  /// is
  double atLeast(const Eigen::Vector3d& p, double turned) const
  {
    const Eigen::Vector4d beyond =
        normals_.col(0) * p.x() + normals_.col(1) * p.y() + normals_.col(2) * p.z() - offsets_;
    const double above = std::max(std::abs(beyond[0]) - turned, 0.0);
    const double outside = std::max(std::max({beyond[1], beyond[2], beyond[3]}) - turned, 0.0);
    return std::sqrt(above * above + outside * outside);
  }

private:
  void put(Eigen::Index i, const Eigen::Vector3d& normal, const Eigen::Vector3d& place)
  {
    normals_.row(i) = normal;
    offsets_[i] = normal.dot(place);
  }

  Eigen::Matrix<double, 4, 3> normals_;
  Eigen::Vector4d offsets_;
};

/// Triangles in the obstacle's frame.
class PatchProbe {
public:
  PatchProbe(const Patch& patch, const Kinematics::Pose& pose, const Eigen::Vector3d& center)
  : patch_(patch),
    center_(center),
    distances_(Eigen::Isometry3d::Identity(), pose.isometry())
  {
    for (std::size_t i = 0; i < std::min(kPlanes, count()); ++i)
      if (planes_[i].set(patch_.triangle(patch_.begin + i), pose)) known_ |= 1u << i;
  }

  double atLeast(const Eigen::Vector3d& p, double enough) const { return near(p, enough, false).lower; }

  /// @param enough bounds beyond it need not be near to each other
  Interval toPoint(const Eigen::Vector3d& p, double enough) const { return near(p, enough, true); }
  Interval toTriangle(const Triangle3& corners, double) const
  {
    Interval all{kInfinity, kInfinity};
    for (std::size_t i = 0; i < count(); ++i)
      add(all, enclosed(distances_, corners, patch_.triangle(patch_.begin + i)));
    return all;
  }

private:
  std::size_t count() const { return static_cast<std::size_t>(patch_.end - patch_.begin); }

  Interval near(const Eigen::Vector3d& p, double enough, bool both) const
  {
    const double far = (p - center_).norm() - patch_.radius;
    if (far > enough) return {far, kInfinity};
    Interval all{kInfinity, kInfinity};
    for (std::size_t i = 0; i < count(); ++i) {
      const bool is_known = i < kPlanes && (known_ >> i & 1u) != 0;
      const double least = is_known ? planes_[i].atLeast(p, kTurned * (far + 2.0 * patch_.radius)) : 0.0;
      add(all, least > enough || (is_known && !both)
                   ? Interval{least, kInfinity}
                   : enclosed(distances_, Point3{p.x(), p.y(), p.z()}, patch_.triangle(patch_.begin + i)));
    }
    return all;
  }

  static void add(Interval& all, const Interval& one)
  {
    all = {std::min(all.lower, one.lower), std::min(all.upper, one.upper)};
  }

  static constexpr std::size_t kPlanes = 16;
  static constexpr double kTurned = 0x1p-20; ///< by which rounding turns normals, at most

  const Patch& patch_;
  const Eigen::Vector3d center_;
  const TriangleDistance distances_;
  std::array<Planes, kPlanes> planes_; ///< of the first triangles
  std::uint32_t known_ = 0;            ///< of these, a bit each
};

struct SolidProbe {
  const Solid& solid;
  const Kinematics::Pose& pose;

  double atLeast(const Eigen::Vector3d& p, double) const
  {
    return signedDistance(solid, pose.rotation.transpose() * (p - pose.translation));
  }
  Interval toPoint(const Eigen::Vector3d& p, double) const
  {
    const double distance = atLeast(p, 0.0);
    return {distance, distance};
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
        [&](const Interval& bounds) { return bounds.lower > limit + round; },
        pose.translation - Eigen::Vector3d(corners[0][0], corners[0][1], corners[0][2]));
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
  const auto areAlike = [&] {
    if (!view.indices) return std::equal(view.radii + 1, view.radii + view.count, view.radii);
    return std::all_of(view.indices, view.indices + view.size(),
                       [&](auto record) { return view.radius(static_cast<std::uint32_t>(record)) == first; });
  };
  if (areAlike()) radius_ = first;
}

double Obstacle::mostUncertain() const noexcept
{
  return hierarchy_->storage().uncertainty.most;
}

bool Obstacle::isBeyond(const Eigen::Vector3d& place, double limit) const
{
  if (limit == kInfinity) return hierarchy_->empty();
  const Eigen::Vector3d point = pose.inverse() * place;
  if (!radius_) return GapWalk<PointProbe>(*hierarchy_, {point}, limit, true).run().isBeyond(limit);
  const double within = limit + *radius_ + hierarchy_->view().uncertainty;
  if (within < 0.0) return true;
  Work work;
  return !findAny(hierarchy_->storage(), {point.x(), point.y(), point.z()}, within, work);
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

Gap Obstacle::gap(const Patch& patch, const Kinematics::Pose& place, double limit, bool any) const
{
  const Kinematics::Pose back = pose.inverse();
  const double uncertain = patch.surface.storage().uncertainty.most;
  const PatchProbe probe(patch, back * place, back * patch.center);
  Gap found = GapWalk<PatchProbe>(*hierarchy_, probe, limit + uncertain, any).run();
  found.lower -= uncertain;
  found.upper += uncertain;
  return found;
}

} // namespace pcl_bsh::robots
