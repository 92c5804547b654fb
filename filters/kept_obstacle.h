// SPDX-License-Identifier: BSD-3-Clause
// A filter's other cloud and its hierarchy, which lasts from one use to the next.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <pcl/PolygonMesh.h>
#include <pcl/common/io.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

class SphereHierarchy;

/// The fields of a cloud's records.
template <typename PointT>
std::vector<pcl::PCLPointField> fieldsOfRecords(const pcl::PointCloud<PointT>&)
{
  return pcl::getFields<PointT>();
}
inline std::vector<pcl::PCLPointField> fieldsOfRecords(const pcl::PCLPointCloud2& cloud)
{
  return cloud.fields;
}

/// Covers a mesh of PCL, whose polygons may have any number of corners.
/// @throws std::invalid_argument when the pointer is null, or as viewOf(), addTriangles() and coverSurface() do
/// @param polygons_apart for a mesh that is asked about: each ball holds parts of one polygon, and what the cover calls
///   its triangles are the mesh's polygons
std::shared_ptr<const SurfaceCover> coverOf(const pcl::PolygonMesh::ConstPtr& mesh, double tolerance,
                                            bool polygons_apart = false);

/// The cloud's points must not change from setCloud() on, whatever else is set: every use compares a checksum of their
/// coordinates and uncertainties. That takes some 20 instructions a point, a tenth or less of what building takes.
class KeptObstacle {
public:
  /// @throws std::invalid_argument when the pointer is null, or as viewOf() does
  template <typename Cloud>
  void setCloud(const std::shared_ptr<Cloud>& cloud)
  {
    if (!cloud) throw std::invalid_argument("obstacle cloud is null: give an empty cloud if there is no obstacle");
    setView([cloud] { return viewOf(*cloud); }, [cloud] { return fieldsOfRecords(*cloud); });
  }

  /// A surface, as balls that cover it. @throws std::invalid_argument when the pointer is null
  void setSurface(const std::shared_ptr<const SurfaceCover>& cover);

  /// Null where the obstacle is a cloud.
  const std::shared_ptr<const SurfaceCover>& surface() const { return surface_; }

  /// Default: none. The hierarchy is built anew, for it holds its points' uncertainties, of the same points.
  /// @throws std::invalid_argument for numbers that are not finite and >= 0
  void setUncertainty(const Uncertainty& uncertainty);
  const Uncertainty& uncertainty() const { return uncertainty_; }

  /// Built on the first use. @param threads that build it
  /// @throws std::invalid_argument when there is no cloud, it has changed, or its uncertainties are not what
  ///   withUncertainty() asks for
  const SphereHierarchy& hierarchy(unsigned threads);

  /// The points of the hierarchy. @pre hierarchy() was called
  const PointsView& view() const;

  /// How wide the holes beside each record are taken to be: patchSpacings(), measured once for a cloud and a gap.
  /// @param widest_gap >= 0; 0: usualGap() @param threads that measure @pre hierarchy() was called
  const std::vector<float>& spacings(double widest_gap, unsigned threads);

private:
  using Fields = std::function<std::vector<pcl::PCLPointField>()>;

  /// A cloud's memory, and a checksum of its points.
  struct Seen {
    const void* data;
    std::size_t count;
    std::uint64_t points;
    bool operator!=(const Seen& other) const
    {
      return data != other.data || count != other.count || points != other.points;
    }
  };

  void setView(std::function<PointsView()> view, Fields fields);

  std::function<PointsView()> view_; ///< owns its cloud
  std::shared_ptr<const SurfaceCover> surface_;
  Fields fields_; ///< likewise
  Uncertainty uncertainty_;
  std::shared_ptr<const SphereHierarchy> hierarchy_;
  std::uint64_t uncertainties_ = 0;                    ///< checksum of the field that the hierarchy was built with
  std::optional<Seen> first_seen_;                     ///< what the cloud was at its first use
  std::shared_ptr<const std::vector<float>> spacings_; ///< of the cloud, once they are asked for
  double spaced_gap_ = 0.0;                            ///< for which they are
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
