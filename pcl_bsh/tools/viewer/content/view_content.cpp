// SPDX-License-Identifier: BSD-3-Clause
#include "view_content.h"

#include "clouds_content.h"
#include "scene_content.h"
#include "site_content.h"

namespace pcl_bsh::viewer {

std::unique_ptr<ViewContent> makeViewContent(const Options& options)
{
  if (options.scene) return makeSceneContent(options);
  if (options.site) return std::make_unique<SiteContent>(options);
  return std::make_unique<CloudsContent>(options);
}

} // namespace pcl_bsh::viewer
