// SPDX-License-Identifier: BSD-3-Clause
// The uncertainties of single points, in the order of a voxel's tree. Where all points below a node are well known, or
// no point is, one test decides about the node.
#pragma once

#include <pcl_bsh/base/made_once.h>
#include <pcl_bsh/hierarchy/node.h>

#include <memory>
#include <vector>

namespace pcl_bsh {

struct PointsView;
struct Voxel;

/// Least and greatest uncertainty of the points below each child of a node, in the cloud's unit; 0 past the last child.
struct alignas(32) UncertaintyLanes {
  float least[kNodeChildren], most[kNodeChildren];
};

/// The uncertainties of a voxel's points and nodes.
struct OwnUncertainties {
  std::vector<UncertaintyLanes> nodes; ///< as Voxel::nodes
  std::unique_ptr<float[]> points;     ///< in the order of the block, then kMaxLeafPoints zeros that may be read
  float most = 0.0f;                   ///< of all
};

/// Made when first asked for, by queries about uncertain points alone.
class LazyUncertainties {
public:
  /// @param voxel built. @param view of its cloud, with `uncertainties`
  const OwnUncertainties* of(const Voxel& voxel, const PointsView& view)
  {
    const OwnUncertainties* known = made_.get();
    return known ? known : make(voxel, view);
  }

  /// Null where nobody asked yet.
  const OwnUncertainties* made() const noexcept { return made_.get(); }

  // Not while another thread asks.
  void reset() noexcept { made_.reset(); }
  void adopt(LazyUncertainties& other) noexcept { made_.adopt(other.made_); }

private:
  const OwnUncertainties* make(const Voxel& voxel, const PointsView& view);

  MadeOnce<OwnUncertainties> made_;
};

} // namespace pcl_bsh
