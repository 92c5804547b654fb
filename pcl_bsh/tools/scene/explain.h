// SPDX-License-Identifier: BSD-3-Clause
// Explains what a scene file makes the program compute and build, and why; does none of it.
#pragma once

#include <pcl_bsh/io/scenes/scene_file.h>

#include <nlohmann/json.hpp>

#include <iosfwd>

namespace pcl_bsh::cli {

/// Prints which effects are on and what is built for them.
void explain(const io::SceneFile& file, std::ostream& out);

/// The explanation for programs: `effects` that are on, with a text each; those `off`; what is `built`.
nlohmann::ordered_json explanationJson(const io::SceneFile& file);

} // namespace pcl_bsh::cli
