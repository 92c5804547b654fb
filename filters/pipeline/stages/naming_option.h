// SPDX-License-Identifier: BSD-3-Clause
// Turns errors about the thing that an option names into errors about the option.
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/filters/pipeline/stage.h>
#include <pcl_bsh/io/text/format_error.h>

#include <stdexcept>
#include <string>

namespace pcl_bsh::pipeline {

/// Returns the result of `ask`. @throws OptionError for its InvalidInput, and for errors of files
template <class Ask>
auto namingOption(const std::string& option, const Ask& ask)
{
  try {
    return ask();
  }
  catch (const InvalidInput& error) {
    throw OptionError(option, error.advice());
  }
  catch (const io::FormatError& error) {
    throw OptionError(option, std::string(error.what()) + ": " + error.remedy());
  }
  catch (const std::runtime_error& error) {
    throw OptionError(option, error.what());
  }
}

} // namespace pcl_bsh::pipeline
