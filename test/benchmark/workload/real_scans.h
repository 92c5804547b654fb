// SPDX-License-Identifier: BSD-3-Clause
// Pairs made of real scans, where a folder with them is at hand.
#pragma once

#include "scan_pair.h"

#include <optional>
#include <string>

namespace pcl_bsh::bench {

/// "lidar": two sweeps of a spinning lidar, the second brought into the first one's frame. "lion": a
/// scanned stone lion against itself, pushed aside by seven spacings. "autzen": airborne lidar, every other
/// point against the rest, moved by 30 feet. Nothing when `folder` holds no such files. @throws
/// std::runtime_error naming a file that is there but cannot be read; std::invalid_argument for another
/// scene name.
std::optional<ScanPair> realPair(const std::string& scene, const std::string& folder);

} // namespace pcl_bsh::bench
