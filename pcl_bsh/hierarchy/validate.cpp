// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/hierarchy/build/morton.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

constexpr std::size_t kMostLines = 100;

class Validator {
public:
  explicit Validator(const SphereHierarchy::Storage& storage) : s_(storage), seen_(storage.view.count, 0) {}

  HierarchyDefects run()
  {
    BuildWork unasked;
    std::size_t points = 0;
    for (std::uint32_t v = 0; v < s_.voxel_count; ++v) {
      const Voxel& voxel = s_.built(v, unasked);
      name_ = "voxel " + std::to_string(v);
      if (v > 0 && !(s_.voxels[v - 1].key < voxel.key)) defect("key out of order");
      if (voxel.begin != points) defect("its points do not begin where the last voxel's end");
      points += voxel.count;
      checkPoints(voxel);
      if (voxel.nodes.empty())
        defect("no nodes");
      else if (all_are_records_)
        checkNode(voxel.nodes, 0, 0, voxel.count, voxel.frame, v);
    }
    name_ = "cloud";
    if (points != s_.size) defect("voxels hold " + std::to_string(points) + " of " + counted(s_.size, "point"));
    if (s_.size > 0 && all_are_records_)
      checkNode(s_.top, 0, 0, static_cast<std::uint32_t>(s_.voxel_count), s_.frame, kAboveVoxels);
    checkNoneLost();
    return std::move(defects_);
  }

private:
  void defect(const std::string& what)
  {
    if (defects_.lines.size() < kMostLines) defects_.lines.push_back(name_ + ": " + what);
  }

  /// Stored coordinates are within the frame's bounds of the given ones, and given ones where find() expects them.
  void checkPoints(const Voxel& voxel)
  {
    const double cells =
        static_cast<double>(gatherBits(voxel.key) | gatherBits(voxel.key >> 1) | gatherBits(voxel.key >> 2));
    const double most_stray = s_.strayed + kCellRounding * (cells + 2.0);
    for (std::uint32_t i = 0; i < voxel.count; ++i) {
      const std::uint32_t record = voxel.records()[i];
      if (record >= s_.view.count) {
        defect("no such record: " + std::to_string(record));
        all_are_records_ = false;
        continue;
      }
      ++seen_[record];
      const Point3 p = s_.view.point(record);
      if (s_.view.triangles && !holdsTriangle(record))
        defect("triangle " + std::to_string(record) + " reaches out of its ball");
      if (!(s_.shiftOf(voxel.key, p, p) <= most_stray))
        defect("point " + std::to_string(record) + " farther outside its voxel's cell than is known");
      const float stored[3] = {voxel.x()[i], voxel.y()[i], voxel.z()[i]};
      for (std::size_t k = 0; k < 3; ++k) {
        const LocalFrame& f = voxel.frame;
        const double local = p[k] / f.unit - f.origin[k] / f.unit;
        if (std::abs(static_cast<double>(stored[k])) > f.reach[k])
          defect("point " + std::to_string(record) + " beyond the reach");
        if (std::abs(local - static_cast<double>(stored[k])) >
            f.slack(static_cast<int>(k)) * (1.0 + kReachGrowth) + std::abs(local) * kFewDoubleRoundings)
          defect("point " + std::to_string(record) + " stored too far from where it is");
        if (f.lossless && f.origin[k] + static_cast<double>(stored[k]) != p[k])
          defect("point " + std::to_string(record) + " not stored as given in a lossless frame");
      }
    }
  }

  bool holdsTriangle(std::uint32_t record) const
  {
    const ExactDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());
    const Triangle3 corners = s_.view.triangles->triangle(record);
    return std::all_of(corners.begin(), corners.end(), [&](const Point3& corner) {
      return distance.compare(s_.view.point(record), corner, s_.view.radius(record)) <= 0;
    });
  }

  void checkNode(const std::vector<Node>& nodes, std::uint32_t index, std::uint32_t begin, std::uint32_t end,
                 const LocalFrame& frame, std::uint32_t voxel)
  {
    const std::string here = "node " + std::to_string(index) + ": ";
    if (index >= nodes.size()) return defect(here + "no such node");
    const Node& node = nodes[index];
    if (node.count < 1 || node.count > kNodeChildren)
      return defect(here + "has " + std::to_string(node.count) + " children");
    if (node.begin[0] != begin || node.begin[node.count] != end)
      return defect(here + "its children do not span its range");
    for (std::uint32_t i = 0; i < node.count; ++i) {
      if (node.begin[i] >= node.begin[i + 1]) return defect(here + "child " + std::to_string(i) + " is empty");
      checkSphere(node, i, frame, voxel, here);
      if (voxel != kAboveVoxels)
        for (LazySlabs* slabs : {&s_.voxels[voxel].slabs, &s_.voxels[voxel].cross_slabs})
          if (slabs->isFitted()) checkSlab(node, index, i, s_.voxels[voxel], *slabs, here);
      if (node.isLeaf(i)) {
        if (voxel == kAboveVoxels ? node.points(i) != 1
                                  : node.isCoincident(i) && !isOnePlace(s_.voxels[voxel], node, i))
          defect(here + "leaf " + std::to_string(i) + " is too large");
      }
      else if (node.child[i] <= index) {
        defect(here + "child " + std::to_string(i) + " does not follow its parent");
      }
      else {
        checkNode(nodes, node.child[i], node.begin[i], node.begin[i + 1], frame, voxel);
      }
    }
  }

  bool isOnePlace(const Voxel& voxel, const Node& node, std::uint32_t i) const
  {
    const std::uint32_t first = voxel.records()[node.begin[i]];
    for (std::uint32_t k = node.begin[i]; k < node.begin[i + 1]; ++k) {
      const std::uint32_t record = voxel.records()[k];
      if (record < first || s_.view.point(record) != s_.view.point(first) ||
          s_.view.radius(record) != s_.view.radius(first) ||
          s_.view.ownUncertainty(record) != s_.view.ownUncertainty(first) ||
          (s_.view.triangles && s_.view.triangles->triangle(record) != s_.view.triangles->triangle(first)))
        return false;
    }
    return true;
  }

  /// Every point below child i is within its sphere, as given and in exact arithmetic.
  void checkSphere(const Node& node, std::uint32_t i, const LocalFrame& frame, std::uint32_t voxel,
                   const std::string& here)
  {
    std::uint32_t lowest = 0xffffffffu;
    const auto visit = [&](const Voxel& v, std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) {
        lowest = std::min(lowest, v.records()[k]);
        if (!contains(node, i, frame, v.records()[k]))
          defect(here + "sphere " + std::to_string(i) + " does not contain point " + std::to_string(v.records()[k]));
      }
    };
    if (voxel != kAboveVoxels)
      visit(s_.voxels[voxel], node.begin[i], node.begin[i + 1]);
    else
      for (std::uint32_t v = node.begin[i]; v < node.begin[i + 1]; ++v) visit(s_.voxels[v], 0, s_.voxels[v].count);
    if (lowest != node.lowest[i]) defect(here + "lowest record of child " + std::to_string(i) + " is wrong");
  }

  bool contains(const Node& node, std::uint32_t i, const LocalFrame& frame, std::uint32_t record) const
  {
    // The sphere's centre is origin + unit * (x, y, z): the pose adds the origin, exactly.
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
    origin.translation() = Eigen::Vector3d(frame.origin[0], frame.origin[1], frame.origin[2]);
    const Point3 c = {node.x[i] * frame.unit, node.y[i] * frame.unit, node.z[i] * frame.unit};
    return ExactDistance(Eigen::Isometry3d::Identity(), origin)
               .compare(s_.view.point(record), c, node.r[i] * frame.unit, -s_.view.radius(record)) <= 0;
  }

  /// Checks that every point below child i is between the planes of its slab, if it has one. Double is precise enough:
  /// a slab is 2^-20 of its sphere's radius thicker than its points.
  void checkSlab(const Node& node, std::uint32_t index, std::uint32_t i, const Voxel& voxel, LazySlabs& fitted,
                 const std::string& here)
  {
    BuildWork unasked;
    const Slabs& slabs = fitted.of(voxel, s_.view, unasked)[index];
    const LocalFrame& f = voxel.frame;
    const auto isWithin = [&](const Point3& p) {
      const auto local = [&](std::size_t axis) { return p[axis] / f.unit - f.origin[axis] / f.unit; };
      const double along = slabs.x[i] * (local(0) - node.x[i]) + slabs.y[i] * (local(1) - node.y[i]) +
                           slabs.z[i] * (local(2) - node.z[i]);
      return std::abs(along) <= static_cast<double>(slabs.h[i]);
    };
    for (std::uint32_t k = node.begin[i]; k < node.begin[i + 1]; ++k) {
      const std::uint32_t record = voxel.records()[k];
      bool within = true;
      if (!s_.view.triangles)
        within = isWithin(s_.view.point(record));
      else
        for (const Point3& corner : s_.view.triangles->triangle(record)) within = within && isWithin(corner);
      if (!within) defect(here + "slab " + std::to_string(i) + " does not contain point " + std::to_string(record));
    }
  }

  void checkNoneLost()
  {
    std::vector<std::uint32_t> expected(s_.view.count, 0);
    for (std::size_t i = 0; i < s_.view.size(); ++i) {
      const std::uint32_t record = s_.view.record(i);
      expected[record] += isFinite(s_.view.point(record));
    }
    for (std::size_t i = 0; i < expected.size(); ++i)
      if (seen_[i] != expected[i])
        defect("point " + std::to_string(i) + " is held " + counted(seen_[i], "time") + ", not " +
               std::to_string(expected[i]));
  }

  const SphereHierarchy::Storage& s_;
  std::vector<std::uint32_t> seen_;
  bool all_are_records_ = true; ///< else nodes are not checked, because this reads points by their records
  std::string name_;
  HierarchyDefects defects_;
};

} // namespace

HierarchyDefects SphereHierarchy::validate() const
{
  const DefaultFloatEnvironment environment;
  return Validator(*storage_).run();
}

} // namespace pcl_bsh
