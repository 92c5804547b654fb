// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stage_cloud.h>
#include <pcl_bsh/search/selected_records.h>

#include <atomic>

namespace pcl_bsh::pipeline {

std::shared_ptr<StageCloud> ownCloud(StageCloudPtr&& cloud)
{
  const StageCloudPtr held = std::move(cloud);
  if (held.use_count() > 1) return std::make_shared<StageCloud>(*held);
  std::atomic_thread_fence(std::memory_order_acquire); // the reads of another thread came before its release
  return std::const_pointer_cast<StageCloud>(held);
}

std::shared_ptr<StageCloud> emptyLike(const StageCloud& cloud)
{
  auto empty = std::make_shared<StageCloud>(
      StageCloud{withoutRecords(cloud.cloud), cloud.viewpoint, cloud.las_header, cloud.scanners});
  empty->coordinate_system = cloud.coordinate_system;
  empty->system_definition = cloud.system_definition;
  return empty;
}

} // namespace pcl_bsh::pipeline
