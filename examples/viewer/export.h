// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_actor.h"
#include "view_content.h"

#include <filesystem>

namespace pcl_bsh::view {

/// Clouds with their arrays, spheres of a level, boxes and paths, as files. @throws std::runtime_error naming the file
void exportTo(const std::filesystem::path& path, const ViewContent& content, CloudActors clouds,
              const StepCollisions& collisions, std::size_t step, unsigned level);

} // namespace pcl_bsh::view
