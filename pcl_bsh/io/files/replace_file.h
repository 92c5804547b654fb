// SPDX-License-Identifier: BSD-3-Clause
// Output that appears complete or not at all. Nothing else in the project writes files.
#pragma once

#include <pcl_bsh/io/files/descriptor_buffer.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>

namespace pcl_bsh::files {

/// A file that is being written beside the one it is to replace, as NAME.part0. Until commit(), and when commit()
/// throws, `path` is as it was. Without commit(), no file is left behind; only a program that is killed leaves the
/// .part0.
///
/// Links are followed, also where they lead to no file yet. Devices, pipes and `standard_stream` are written to
/// directly.
class FileReplacement {
public:
  /// @throws FileError as requireWritable() does
  explicit FileReplacement(const std::filesystem::path& path);
  ~FileReplacement();
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;

  std::ostream& stream() { return stream_; }

  /// The file that is being written, for a writer that wants a name instead of the stream.
  const std::filesystem::path& name() const noexcept { return name_; }

  /// Brings the file to the disk, with the permissions and, where the system allows, the owner of the file that it
  /// replaces; renames it to `path`; brings the folder to the disk. To be called once.
  /// @param with called at the moment of the renaming, under lockUnfinished(), if not null
  /// @throws FileError
  void commit(const std::function<void()>& with = nullptr);

private:
  FileReplacement();
  void makeTemporary();
  void takeOver();

  std::filesystem::path path_;        ///< as the caller names it
  std::filesystem::path destination_; ///< without links
  std::filesystem::path name_;
  bool direct_ = false;
  bool temporary_ = false; ///< there is a temporary file
  int descriptor_ = -1;
  std::optional<DescriptorBuffer> buffer_;
  std::ostream stream_;
};

/// Lets `write` fill a FileReplacement, and commits it.
/// @throws FileError, and whatever `write` throws
void replaceFile(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// @throws FileError when a file cannot be made at `path`, because of its folder or of what stands there; a file which
///   is protected from writing is not replaced
void requireWritable(const std::filesystem::path& path);

} // namespace pcl_bsh::files
