// SPDX-License-Identifier: BSD-3-Clause
// A few records of many in memory of their own: questions about them cost what few cost.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/solid/enclosure.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

class PCL_BSH_EXPORT_INTERNAL QueriedPart {
public:
  /// Coordinates, radii and uncertainties are copied. @param thing need not outlive this
  /// @param records of its view, ascending: records that are not finite are not finite here either
  QueriedPart(const SphereHierarchy& thing, std::vector<std::uint32_t> records);
  QueriedPart(const QueriedPart&) = delete;
  QueriedPart& operator=(const QueriedPart&) = delete;

  const QueriedRecords& queried() const noexcept { return *queried_; }

  /// The thing's record that the part's record was made of.
  std::uint32_t original(std::uint32_t record) const { return records_[record]; }

  /// The places of a record of the part: of a point one, of a triangle its corners.
  std::vector<Point3> placesOf(std::uint32_t record) const;

private:
  std::vector<std::uint32_t> records_;
  std::vector<Point3> places_;
  std::vector<Triangle> corners_;
  std::vector<float> radii_, uncertainties_;
  TrianglesView triangles_;
  std::optional<const SphereHierarchy> hierarchy_;
  std::optional<const QueriedRecords> queried_;
};

} // namespace pcl_bsh
