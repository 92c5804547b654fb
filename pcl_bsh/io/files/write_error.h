// SPDX-License-Identifier: BSD-3-Clause
// Messages about a file that cannot be written.
#pragma once

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/file_identity.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace pcl_bsh::files {

/// @param error errno, or 0 when it is not known
[[noreturn]] inline void failToWrite(const std::filesystem::path& path, int error)
{
  const std::string reason = error != 0 ? " (" + std::generic_category().message(error) + ")" : "";
  throw FileError(path == standard_stream ? "standard output" : path, "cannot be written" + reason,
                  "choose a folder with room that you may write to");
}

} // namespace pcl_bsh::files
