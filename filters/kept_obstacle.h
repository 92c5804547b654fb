// SPDX-License-Identifier: BSD-3-Clause
// A filter's other cloud and its hierarchy, which lasts from one use to the next.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/search/cloud_view.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

class SphereHierarchy;

/// The cloud's points must not change from setCloud() on: every use compares a checksum of their coordinates. That
/// takes some 20 instructions a point, a tenth or less of what building takes.
class KeptObstacle {
public:
  /// @throws std::invalid_argument when the pointer is null, or as viewOf() does
  template <typename Cloud>
  void setCloud(const std::shared_ptr<Cloud>& cloud)
  {
    if (!cloud) throw std::invalid_argument("obstacle cloud is null: give an empty cloud if there is no obstacle");
    setView([cloud] { return viewOf(*cloud); });
  }

  /// Built on the first use. @param threads that build it
  /// @throws std::invalid_argument when there is no cloud, or it has changed
  const SphereHierarchy& hierarchy(unsigned threads);

  /// The points of the hierarchy. @pre hierarchy() was called
  const PointsView& view() const;

private:
  void setView(std::function<PointsView()> view);

  std::function<PointsView()> view_; ///< owns its cloud
  std::shared_ptr<const SphereHierarchy> hierarchy_;
  std::uint64_t checksum_ = 0; ///< of the coordinates that the hierarchy was built from
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
