// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_actor.h"

#include "points_actor.h"
#include "triangles_actor.h"

namespace pcl_bsh::viewer {

std::unique_ptr<CloudActor> makeCloudActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color,
                                           const Color& marked)
{
  if (viewed.hasTriangles()) return std::make_unique<TrianglesActor>(viewed, renderer, color, marked);
  return std::make_unique<PointsActor>(viewed, renderer, color, marked);
}

} // namespace pcl_bsh::viewer
