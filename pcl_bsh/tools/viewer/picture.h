// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/tools/viewer/content/view_content.h>

namespace pcl_bsh::viewer {

/// Writes what --screenshot and --export ask for; needs no display. @throws std::runtime_error naming the file
void drawFiles(const ViewContent& content);

} // namespace pcl_bsh::viewer
