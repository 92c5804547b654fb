// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy of an input of a VTK filter, which lasts from one execution to the next. Not installed.
#pragma once

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <vtkDataArray.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace pcl_bsh::vtk {

/// Points as an array of records. Float and double arrays are seen in place, and kept alive; others are copied to
/// doubles, which `copied` tells.
PointsView viewOf(vtkPolyData& data, bool& copied);

/// Whether the data has lines, polygons or strips.
bool isSurface(vtkPolyData& data);

/// Built anew only when the points (and of a surface the cells, or the tolerance) are no longer what it was built from,
/// by a checksum of their numbers: this holds also where data was changed without a call of Modified().
class KeptHierarchy {
public:
  /// Of all points; cells do not count.
  const SphereHierarchy& ofPoints(vtkPolyData& data, unsigned threads);

  /// Of the balls which cover all cells, vertices and lines too. @throws as coverSurface() does
  const SphereHierarchy& ofSurface(vtkPolyData& data, double tolerance, unsigned threads,
                                   const std::function<bool(double)>& progress);

  /// The cell that a record of the hierarchy lies on, where it is that of a surface.
  vtkIdType cell(std::uint32_t record) const { return cell_of_triangle_[cover_->triangles[record]]; }

  const SurfaceCover* cover() const { return cover_.get(); } ///< null: the hierarchy is that of points

  std::size_t built() const noexcept { return built_; } ///< so far

private:
  /// Whether the hierarchy is that of these numbers; remembers them where not, and forgets the hierarchy.
  bool isOf(const PointsView& view, bool copied, std::uint64_t checksum, double tolerance);
  const SphereHierarchy& build(const PointsView& view, unsigned threads);

  std::unique_ptr<SphereHierarchy> hierarchy_; ///< of `points_`, or of the cover
  std::shared_ptr<const SurfaceCover> cover_;  ///< null: of points
  std::vector<vtkIdType> cell_of_triangle_;
  PointsView points_; ///< the owner keeps the memory, so that its address is not used for other points
  bool copied_ = false;
  std::uint64_t checksum_ = 0;
  double tolerance_ = -1.0; ///< of the cover; negative: of points
  std::size_t built_ = 0;
};

} // namespace pcl_bsh::vtk
