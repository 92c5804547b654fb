// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stage_cloud.h>

#include <atomic>

namespace pcl_bsh::pipeline {

std::shared_ptr<StageCloud> ownCloud(StageCloudPtr&& cloud)
{
  const StageCloudPtr held = std::move(cloud);
  if (held.use_count() > 1) return std::make_shared<StageCloud>(*held);
  std::atomic_thread_fence(std::memory_order_acquire); // what another thread read, it read before it let go
  return std::const_pointer_cast<StageCloud>(held);
}

std::shared_ptr<StageCloud> emptyLike(const StageCloud& cloud)
{
  auto empty = std::make_shared<StageCloud>();
  empty->viewpoint = cloud.viewpoint;
  empty->cloud.header = cloud.cloud.header;
  empty->cloud.fields = cloud.cloud.fields;
  empty->cloud.is_bigendian = cloud.cloud.is_bigendian;
  empty->cloud.is_dense = cloud.cloud.is_dense;
  empty->cloud.point_step = cloud.cloud.point_step;
  empty->cloud.height = 1;
  return empty;
}

} // namespace pcl_bsh::pipeline
