// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/spacing.h>

#include <pcl_bsh/geometry/float_environment.h>
#include <pcl_bsh/geometry/sphere_radius.h>
#include <pcl_bsh/traversal/space.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr std::size_t kGroups = 32, kGroupPoints = 32;

class NearestOther {
public:
  explicit NearestOther(const SphereHierarchy& cloud) : placed_{cloud}, spaces_(placed_) {}

  const Voxel& voxel(std::size_t number) { return spaces_.voxel(static_cast<std::uint32_t>(number), work_); }

  /// From a place to the nearest point elsewhere, as they are given; infinity when there is none. Depth first, nearest
  /// children first.
  double from(const Point3& place)
  {
    double nearest = std::numeric_limits<double>::infinity();
    stack_.assign(1, {0.0, kAboveVoxels, 0});
    while (!stack_.empty()) {
      const Branch branch = stack_.back();
      stack_.pop_back();
      if (branch.bound < nearest) visit(branch, place, nearest);
    }
    return nearest;
  }

private:
  struct Branch {
    double bound;
    std::uint32_t space, node;
  };

  static double distance(const Point3& p, const Point3& q) { return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]); }

  /// The distance of two places in a frame errs by less than kFewDoubleRoundings of the farther one's coordinates; a
  /// sphere holds the given points, a stored point is within the slack of the given one.
  void visit(const Branch& branch, const Point3& place, double& nearest)
  {
    const LocalFrame& frame = spaces_.frame(branch.space);
    const Node& node = spaces_.node(branch.space, branch.node);
    const double inverse = 1.0 / frame.unit;
    Point3 local;
    double farthest = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      local[axis] = place[axis] * inverse - frame.origin[axis] * inverse;
      farthest += std::abs(local[axis]) + frame.reach[axis];
    }
    const double slack = kFewDoubleRoundings * farthest;
    const std::size_t from = stack_.size();
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const double between =
          distance({node.x[i], node.y[i], node.z[i]}, local) - static_cast<double>(node.r[i]) - slack;
      const double bound = between * frame.unit;
      if (bound >= nearest) continue;
      if (!node.isLeaf(i)) {
        stack_.push_back({bound, branch.space, node.child[i]});
      }
      else if (branch.space == kAboveVoxels) {
        voxel(node.begin[i]);
        stack_.push_back({bound, node.begin[i], 0});
      }
      else {
        measure(spaces_.storage.voxels[branch.space], node, i, local, slack, place, nearest);
      }
    }
    std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(from), stack_.end(),
              [](const Branch& a, const Branch& b) { return a.bound > b.bound; });
  }

  void measure(const Voxel& voxel, const Node& node, std::uint32_t child, const Point3& local, double slack,
               const Point3& place, double& nearest) const
  {
    const double apart = slack + storedSlack(voxel.frame);
    const std::uint32_t end = node.begin[child] + node.comparedPoints(child);
    for (std::uint32_t k = node.begin[child]; k < end; ++k) {
      const Point3 stored = {voxel.x()[k], voxel.y()[k], voxel.z()[k]};
      if ((distance(stored, local) - apart) * voxel.frame.unit >= nearest) continue;
      const double d = distance(voxel.point(spaces_.storage.view, k), place);
      if (d > 0.0) nearest = std::min(nearest, d);
    }
  }

  const Placed placed_; ///< the spaces refer to its pose
  Spaces spaces_;
  Work work_;
  std::vector<Branch> stack_;
};

} // namespace

Spacing spacingOf(const SphereHierarchy& cloud)
{
  const DefaultFloatEnvironment environment;
  const SphereHierarchy::Storage& storage = cloud.storage();
  const std::size_t wanted = kGroups * kGroupPoints;
  const std::size_t groups = storage.size <= wanted ? storage.voxel_count : kGroups;
  NearestOther search(cloud);
  Spacing spacing;
  std::vector<double> gaps;
  for (std::size_t group = 0; group < groups; ++group) {
    std::size_t number = group, first = 0, count = storage.voxels[group].count;
    if (storage.size > wanted) {
      const std::size_t rank = (2 * group + 1) * storage.size / (2 * kGroups);
      const Voxel* const past =
          std::upper_bound(storage.voxels.get(), storage.voxels.get() + storage.voxel_count, rank,
                           [](std::size_t place, const Voxel& voxel) { return place < voxel.begin; });
      number = static_cast<std::size_t>(past - storage.voxels.get()) - 1;
      const std::size_t here = storage.voxels[number].count;
      count = std::min(kGroupPoints, here);
      first = std::min(rank - storage.voxels[number].begin, here - count);
    }
    const Voxel& voxel = search.voxel(number);
    for (std::size_t k = first; k < first + count; ++k) {
      ++spacing.samples;
      const double gap = search.from(voxel.point(storage.view, static_cast<std::uint32_t>(k)));
      if (std::isfinite(gap)) gaps.push_back(gap);
    }
  }
  if (gaps.empty()) return spacing;
  std::sort(gaps.begin(), gaps.end());
  spacing.median = gaps[gaps.size() / 2];
  spacing.wide = gaps[gaps.size() * 9 / 10];
  return spacing;
}

} // namespace pcl_bsh
