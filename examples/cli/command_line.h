// SPDX-License-Identifier: BSD-3-Clause
// How every program reads its command line.
#pragma once

#include "program.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <string>

namespace pcl_bsh::cli {

/// Runs `parse`; false where it asked for help, which is printed then. Throws UsageError.
template <typename Parse>
bool understood(CLI::App& app, const std::string& program, Parse&& parse)
{
  try {
    parse();
    return true;
  }
  catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return false;
  }
  catch (const CLI::ParseError& error) {
    throw UsageError("command line: " + std::string(error.what()) + ": see " + program + " --help");
  }
}

/// The same for all of main()'s arguments.
inline bool understood(CLI::App& app, const std::string& program, int argc, const char* const* argv)
{
  return understood(app, program, [&] { app.parse(argc, argv); });
}

} // namespace pcl_bsh::cli
