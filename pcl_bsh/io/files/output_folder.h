// SPDX-License-Identifier: BSD-3-Clause
// A folder for results, which exists only if results do.
#pragma once

#include <filesystem>
#include <vector>

namespace pcl_bsh::files {

/// Makes a folder and those above it that are missing; at the end removes those it made which are empty.
class OutputFolder {
public:
  /// @throws FileError when it cannot be made
  explicit OutputFolder(const std::filesystem::path& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_; ///< the outermost first
};

} // namespace pcl_bsh::files
