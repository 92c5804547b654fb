// SPDX-License-Identifier: BSD-3-Clause
// What a scene file makes the program compute and build, and why; printed without doing any of it.
#pragma once

#include <pcl_bsh/filters/scene_files/scene_file.h>

#include <iosfwd>

namespace pcl_bsh::cli {

/// Prints which effects are on and what is built for them.
void explain(const io::SceneFile& file, std::ostream& out);

} // namespace pcl_bsh::cli
