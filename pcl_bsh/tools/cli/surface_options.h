// SPDX-License-Identifier: BSD-3-Clause
// How command lines say what is made of files with faces.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>

namespace pcl_bsh::cli {

/// --surface-tolerance and --vertices-only, of which one is given.
/// @param tolerance finite and > 0, or none
void addSurfaceOptions(CLI::App& app, std::optional<double>& tolerance, bool& vertices_only);

} // namespace pcl_bsh::cli
