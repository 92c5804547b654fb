// SPDX-License-Identifier: BSD-3-Clause
// Scans are surfaces: where spheres of two that face each other overlap, planes may still separate them.
#pragma once

#include <pcl_bsh/base/made_once.h>
#include <pcl_bsh/hierarchy/build_work.h>
#include <pcl_bsh/hierarchy/node.h>

namespace pcl_bsh {

struct PointsView;
struct Voxel;

/// Beside a node's spheres: every point below child i, stored or given, is within h[i] of the plane through the
/// sphere's centre with the normal (x, y, z)[i], |n . (p - centre)| <= h; of triangles, all of each. Leaves of points
/// have the normal of the node that they are in; the root's leaves have none: (0, 0, 0).
struct alignas(32) Slabs {
  float x[kNodeChildren], y[kNodeChildren], z[kNodeChildren], h[kNodeChildren];
};

/// The direction of a node's slab among those of its principal axes.
enum class SlabAxis : std::uint8_t {
  least, ///< along which its points vary least: across a surface
  second ///< along which they vary second: across a line, or a strip, in its surface
};

/// The slabs of a voxel, fitted when they are first asked for.
class LazySlabs {
public:
  explicit LazySlabs(SlabAxis axis) : axis_(axis) {}

  /// One per node of a built voxel whose points are no balls. Any number of threads may call this at once:
  /// threads that come before slabs are stored all fit the same ones, and those of one thread are kept.
  /// @param view of the cloud @param work the slabs that this call added to the voxel are added to it
  const Slabs* of(const Voxel& voxel, const PointsView& view, BuildWork& work)
  {
    const Slabs* known = slabs_.get();
    return known ? known : fit(voxel, view, work);
  }

  bool isFitted() const noexcept { return slabs_.get() != nullptr; }

  // Not while another thread asks.
  void reset() noexcept { slabs_.reset(); }
  void adopt(LazySlabs& other) noexcept { slabs_.adopt(other.slabs_); }

private:
  const Slabs* fit(const Voxel& voxel, const PointsView& view, BuildWork& work);

  const SlabAxis axis_;
  MadeOnce<Slabs[]> slabs_;
};

} // namespace pcl_bsh
