// SPDX-License-Identifier: BSD-3-Clause
// Points of a cloud come, go and change: only the voxels they leave and enter are made anew.
//
//   HierarchyUpdate update(hierarchy, changed.data(), changed.size());  // the view still has the old coordinates
//   ... write the new coordinates; NaN where a point is gone; append records where some are new ...
//   UpdateReport done = update.commit(view);                            // the records may have moved in memory
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Counts of an update. Counts are free of noise.
struct UpdateReport {
  std::size_t voxels_touched = 0; ///< that a point left or entered, or that were made for other radii or uncertainties
  std::size_t voxels_added = 0;   ///< of these, new ones
  std::size_t voxels_removed = 0; ///< of these, ones left without a point
  std::size_t points_read = 0;    ///< points that the touched voxels hold afterwards
  std::size_t volumes_built = 0;  ///< spheres fitted at once: of the touched voxels, and above all voxels
  bool sorted_anew = false;       ///< the whole cloud was, since the change reached into most of it or beyond its grid
};

/// A change of some records of a hierarchy's view, in two steps: before and after the caller writes them. In between
/// the hierarchy must not be queried. Answers afterwards are those of a hierarchy built anew; touched voxels build
/// their octree and spheres when they are next visited.
class HierarchyUpdate {
public:
  /// @param records that will change, in any order; may be beyond the view's end, where new ones will be
  /// @throws std::invalid_argument for a negative record, or a hierarchy of a subset (use NaN to leave points out)
  HierarchyUpdate(SphereHierarchy& hierarchy, const std::int32_t* records, std::size_t count);

  /// @param now at least as many records as before, of the same scalar type; all that are new were announced; becomes
  ///   the view of the hierarchy. Its radii and uncertainties may be others, of all records
  /// @throws std::invalid_argument when `now` is not such a view; std::bad_alloc. The hierarchy is then as it was, and
  ///   commit() may be called again.
  UpdateReport commit(const PointsView& now);

private:
  std::uint64_t voxelOf(const Point3& point) const;
  UpdateReport sortAnew(const PointsView& now);

  SphereHierarchy& hierarchy_;
  std::vector<std::uint32_t> records_;           // ascending
  std::map<std::uint64_t, std::size_t> leaving_; // how many points leave each voxel
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
