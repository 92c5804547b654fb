// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_site.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace pcl_bsh::cli {

inline constexpr auto site_program = "pcl_bsh_site";

enum class SiteCommand : std::uint8_t { make, info, validate, write };

struct SiteOptions {
  SiteCommand command = SiteCommand::info;
  std::vector<std::filesystem::path> clouds; ///< to make a site of
  std::filesystem::path site;
  std::filesystem::path out; ///< of `write`: a .pcd file, or a folder for the sources
  std::uint64_t memory = std::uint64_t{2} << 30;
  std::uint64_t tile_points = 4'000'000;
};

/// The options, checked; none when only help was asked for. @throws UsageError
std::optional<SiteOptions> parseSiteOptions(int argc, char** argv);

} // namespace pcl_bsh::cli
