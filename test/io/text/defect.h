// SPDX-License-Identifier: BSD-3-Clause
// For the tests of files: folders, and what readers say of defects.
#pragma once

#include "support/temporary_folder.h"

#include <pcl_bsh/io/text/format_error.h>

#include <gtest/gtest.h>

#include <string>

namespace pcl_bsh::io {

using files::contentOf;
using files::TemporaryFolder;

/// The text of the FormatError that `parse` throws; fails the test when it throws none.
template <typename Parse>
std::string defectOf(Parse&& parse)
{
  try {
    parse();
  }
  catch (const FormatError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was found wrong";
  return {};
}

} // namespace pcl_bsh::io
