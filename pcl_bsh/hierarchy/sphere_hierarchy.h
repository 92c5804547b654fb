// SPDX-License-Identifier: BSD-3-Clause
// One cloud's index: voxels, cells in each voxel, and one tree of bounding spheres over all of them. After Figueiredo,
// Pereira, Oliveira, Araujo: Collision Detection for Point Cloud Models with Bounding Spheres Hierarchies, IJVR 11(2),
// 2012. There each voxel has an octree, and each cell of it a tree of spheres of its own (CellSplit::octants). Here
// cells are halved along their longest axis, unless the options say otherwise. The spheres of cells and those within
// them are levels of one tree; ARCHITECTURE.md gives the reason.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// How the centre of an enclosing sphere is chosen. Changes times, never answers.
enum class SphereFit : std::uint8_t { box_center, ritter, minimal };

/// How the cells of a voxel are divided. Changes times, never answers; BENCHMARK.md has what either costs.
enum class CellSplit : std::uint8_t {
  longest_axis, ///< in halves, along their longest axis; any range of cells that holds few enough points is a leaf
  octants, ///< as in the paper: cubes in eight; a cube of at most 128 points has a tree of its own, of median splits
};

/// How a hierarchy is built. Changes times, never answers.
struct HierarchyOptions {
  /// Edge of a voxel, in the cloud's unit, >= 0; rounded to a power of two. 0: from the density of the points. It is
  /// doubled until there are at most 4096 voxels, or one for 16 points, so that memory and time stay proportional to
  /// the points; statistics() has the edge in use.
  double voxel_edge = 0.0;
  SphereFit fit = SphereFit::box_center;
  CellSplit cells = CellSplit::longest_axis;
  unsigned threads = 1; ///< for sorting points into voxels; 0: all of the machine's
};

/// Sizes of a hierarchy. Lengths in the cloud's unit; of the voxels built so far.
struct HierarchyStatistics {
  std::size_t points = 0;       ///< finite points indexed
  std::size_t voxels = 0;       ///< non-empty voxels
  std::size_t voxels_built = 0; ///< of these, visited by a query or buildAll()
  std::size_t nodes = 0;        ///< wide nodes
  std::size_t leaves = 0;
  std::size_t depth = 0;             ///< wide nodes on the longest path from a voxel's root to a leaf
  std::size_t bytes = 0;             ///< memory held, the caller's cloud not counted
  double voxel_edge = 0.0;           ///< in use
  double requested_voxel_edge = 0.0; ///< HierarchyOptions::voxel_edge; 0: from the density
  double mean_leaf_points = 0.0;
  double mean_leaf_radius = 0.0;
};

/// The defects that validate() found. No line: no defect.
struct HierarchyDefects {
  std::vector<std::string> lines; ///< the first hundred defects, one a line
  /// Whether all is as queries need it.
  bool none() const noexcept { return lines.empty(); }
};

/// Counts of a refit.
struct RefitReport {
  bool sorted_anew = false; ///< the whole hierarchy was made anew: points had scattered, or some came or went
  std::size_t voxels_refitted = 0;
  std::size_t voxels_dropped = 0;   ///< built ones that had grown loose: their next visit builds them anew
  std::size_t volumes_refitted = 0; ///< spheres fitted to the points: one for each voxel, those above the voxels, and
                                    ///< those in voxels that keep their tree
  double looseness = 1.0;           ///< mean growth of the voxels since points were sorted into them
};

/// The hierarchy of one cloud, in the cloud's own frame; poses belong to queries. Construction sorts the points into
/// voxels; a voxel's cells and spheres are built on its first visit, once, safely from several threads. Non-finite
/// points are left out. Holds about 20 bytes per point, and the view: the points must outlive the hierarchy, unless
/// PointsView::owner keeps them alive, and must not change but through refit() and HierarchyUpdate.
class SphereHierarchy {
public:
  /// @throws std::invalid_argument naming the offending value: a null or too large view, an index outside it, a stride
  ///   or offsets for which records or coordinates overlap. Also a radius that is negative or not finite, and a voxel
  ///   edge that is.
  explicit SphereHierarchy(const PointsView& points, const HierarchyOptions& options = {});
  ~SphereHierarchy();
  SphereHierarchy(SphereHierarchy&&) noexcept;
  SphereHierarchy& operator=(SphereHierarchy&&) noexcept;

  const PointsView& view() const noexcept;          ///< the caller's points
  const HierarchyOptions& options() const noexcept; ///< as given

  std::size_t size() const noexcept;                  ///< finite points indexed
  bool empty() const noexcept { return size() == 0; } ///< no finite point

  /// The distance of neighbouring float32 numbers at the largest coordinate. Rounding to float32 may have moved a point
  /// by half of it, per axis. 0 for float64 clouds and for empty ones.
  double coordinateSpacing() const noexcept;

  /// Builds every voxel now. @param threads 0: all of the machine's. The result is the same for any number.
  void buildAll(unsigned threads = 1) const;

  /// The points have moved: same records, other coordinates. Trees stay as they are where they can, and their spheres
  /// are fitted to the points anew; answers are those of a hierarchy built anew. Not while a query runs.
  /// @param now as many records as before, of the same scalar type and subset; becomes the view
  /// @param most_growth >= 1: a voxel's tree is dropped when the radii of its leaves have grown by more than this
  ///   factor on average since it was built. All points are sorted anew when the radii of the voxels have
  /// @throws std::invalid_argument when `now` does not fit, or the factor is not finite and >= 1; std::bad_alloc. The
  ///   hierarchy is then as it was, and refit() may be called again.
  RefitReport refit(const PointsView& now, double most_growth = 1.5);

  /// Checks in exact arithmetic what queries rely on: each point is in every sphere above it, each child in its
  /// parent's range, no point lost or held twice. Builds what is not built yet.
  HierarchyDefects validate() const;

  HierarchyStatistics statistics() const; ///< of what is built so far; visits every node

  class Storage; ///< voxels and nodes, for the queries (pcl_bsh/hierarchy/storage.h)
  const Storage& storage() const noexcept { return *storage_; }

private:
  friend class HierarchyUpdate;

  std::unique_ptr<Storage> storage_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
