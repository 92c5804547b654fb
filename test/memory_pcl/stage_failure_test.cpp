// SPDX-License-Identifier: BSD-3-Clause
// How stages of pipelines give points to PCL's classes, which tell memory that has run out by a line on the console
// alone.
#include <pcl_bsh/filters/pipeline/stages/float_cloud.h>

#include "../filters/clouds.h"
#include "support/every_allocation.h"

#include <pcl/console/print.h>
#include <pcl/filters/filter_indices.h>
#include <pcl/point_types.h>

#include <memory>

namespace pcl_bsh::test {
namespace {

/// One of PCL's filters that keeps all points it numbers.
class KeepsAll : public pcl::FilterIndices<pcl::PointXYZ> {
  void applyFilter(pcl::Indices& indices) override { indices = *indices_; }
};

TEST(StageAllocationFailure, OfNumbersOfPoints)
{
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  pipeline::FloatCloud cloud;
  cloud.points = typedCloud<pcl::PointXYZ>(randomPoints(60, 3));
  EXPECT_GT(failEachAllocation([] { return std::make_unique<KeepsAll>(); },
                               [&](const auto& filter) {
                                 pipeline::setInput(*filter, cloud);
                                 pcl::Indices kept;
                                 filter->filter(kept);
                                 return kept;
                               }),
            0U);
  pcl::console::setVerbosityLevel(pcl::console::L_INFO);
}

} // namespace
} // namespace pcl_bsh::test
