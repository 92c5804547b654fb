// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "world.h"

namespace pcl_bsh::view {

/// Writes what --screenshot and --export ask for; needs no display. @throws std::runtime_error naming the file
void drawFiles(const World& world);

} // namespace pcl_bsh::view
