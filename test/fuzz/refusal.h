// SPDX-License-Identifier: BSD-3-Clause
// Rules of every refusal of a document.
#pragma once

#include "target.h"

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/format_error.h>

#include <exception>
#include <string_view>

namespace pcl_bsh::fuzz {

/// `place: what is wrong: what to do`, on one line.
inline void requireReason(const std::exception& error)
{
  const std::string_view line = error.what();
  require(line.size() > 10 && line.find(": ") != std::string_view::npos && line.find('\n') == std::string_view::npos,
          "a refusal without a reason of one line");
}

/// Runs `read`. It may refuse a file, a text or a value with a reason.
template <class Read>
void mayRefuse(const Read& read)
{
  try {
    read();
  }
  catch (const files::FileError& error) {
    requireReason(error);
  }
  catch (const InvalidInput& error) {
    requireReason(error);
  }
  catch (const io::FormatError& error) { // whose place its reader names
    require(*error.what() != '\0' && !error.remedy().empty(), "a refusal without a reason");
  }
}

} // namespace pcl_bsh::fuzz
