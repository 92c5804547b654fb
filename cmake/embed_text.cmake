# SPDX-License-Identifier: BSD-3-Clause
# Makes embedded/<file's name>.h, in which the file's text is a std::string_view of that name.
function(pcl_bsh_embed_text file name)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  file(READ "${file}" text)
  cmake_path(GET file FILENAME file_name)
  file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/embedded/${file_name}.h" @ONLY
       CONTENT [[// @file_name@
#pragma once

#include <string_view>

namespace pcl_bsh::io {

inline constexpr std::string_view @name@ = R"embedded(@text@)embedded";

} // namespace pcl_bsh::io
]])
endfunction()
