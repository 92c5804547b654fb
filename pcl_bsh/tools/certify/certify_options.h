// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_certify.
#pragma once

#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/certify/certify.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::cli {

inline constexpr auto certify_program = "pcl_bsh_certify";

/// The fits by the names that users know them by.
inline const std::vector<std::pair<std::string, SphereFit>> fits = {
    {"box", SphereFit::box_center}, {"ritter", SphereFit::ritter}, {"minimal", SphereFit::minimal}};

struct CertifyProgramOptions {
  std::filesystem::path cloud;
  std::optional<std::filesystem::path> report;
  std::vector<std::pair<std::string, SphereFit>> wanted = fits;
  CertifyOptions certify;
  ReadChoice reading;
  CommandFiles files;
};

/// The options, checked; none when only help was asked for. @throws UsageError
std::optional<CertifyProgramOptions> parseCertifyOptions(int argc, char** argv);

} // namespace pcl_bsh::cli
