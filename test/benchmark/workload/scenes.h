// SPDX-License-Identifier: BSD-3-Clause
// Scenes by name, for command lines.
#pragma once

#include "scan_pair.h"

#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::bench {

inline const std::vector<std::string> kMadeScenes = {"terrain", "sweep", "hall"};
inline const std::vector<std::string> kRealScenes = {"lidar", "lion", "autzen"};

/// `count` is for the made scenes, `folder` for the real ones. Nothing when a real scan is not there.
std::optional<ScanPair> scene(const std::string& name, std::size_t count, const std::string& folder);

} // namespace pcl_bsh::bench
