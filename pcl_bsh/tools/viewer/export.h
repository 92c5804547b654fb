// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/tools/viewer/actors/cloud_actor.h>
#include <pcl_bsh/tools/viewer/content/view_content.h>

#include <filesystem>

namespace pcl_bsh::viewer {

/// Clouds with their arrays, spheres of a level, boxes and paths, as files. @throws std::runtime_error naming the file
void exportTo(const std::filesystem::path& path, const ViewContent& content, CloudActors clouds,
              const StepCollisions& collisions, std::size_t step, unsigned level);

} // namespace pcl_bsh::viewer
