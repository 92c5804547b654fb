// SPDX-License-Identifier: BSD-3-Clause
#include "world.h"

#include "clouds_world.h"
#include "scene_run.h"

namespace pcl_bsh::view {

std::unique_ptr<World> makeWorld(const Options& options)
{
  if (options.scene) return makeSceneRun(options);
  return std::make_unique<CloudsWorld>(options);
}

} // namespace pcl_bsh::view
