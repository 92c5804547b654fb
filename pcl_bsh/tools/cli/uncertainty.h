// SPDX-License-Identifier: BSD-3-Clause
// How far points may truly be from where they were measured, as users write it.
#pragma once

#include <pcl_bsh/filters/uncertainty.h>

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace pcl_bsh::cli {

/// The values of --uncertainty, --obstacle-uncertainty and --sigmas.
struct UncertaintyOptions {
  std::string input = "0", obstacle = "0"; ///< as typed: lengths, or names of fields
  std::optional<double> sigmas;

  /// @param input_name what the program calls the cloud whose points are asked about
  void addTo(CLI::App& app, const std::string& input_name);

  bool isGiven() const { return input != "0" || obstacle != "0" || sigmas; }

  /// @throws UsageError for what is neither a length nor a name, or sigmas of none
  void read(Uncertainty& of_input, Uncertainty& of_obstacle) const;
};

} // namespace pcl_bsh::cli
