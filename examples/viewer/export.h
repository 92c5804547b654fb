// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_actor.h"
#include "world.h"

#include <filesystem>
#include <vector>

namespace pcl_bsh::view {

/// Clouds with their arrays, spheres of a level, boxes and ways, as files. @throws std::runtime_error naming the file
void exportTo(const std::filesystem::path& path, const World& world, std::vector<CloudActor>& clouds,
              const Findings& findings, std::size_t step, unsigned level);

} // namespace pcl_bsh::view
