// SPDX-License-Identifier: BSD-3-Clause
// A whole file as bytes, mapped, not copied.
#pragma once

#include <boost/interprocess/mapped_region.hpp>

#include <filesystem>
#include <string_view>

namespace pcl_bsh::io {

class FileBytes {
public:
  /// @throws CloudFileError when `path` is not a readable file with something in it
  explicit FileBytes(const std::filesystem::path& path);

  std::string_view view() const noexcept
  {
    return {static_cast<const char*>(region_.get_address()), region_.get_size()};
  }

private:
  boost::interprocess::mapped_region region_;
};

} // namespace pcl_bsh::io
