// SPDX-License-Identifier: BSD-3-Clause
// The files of a .vtm's blocks: which are ours to write, and which to remove. Not installed.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// A generation of blocks of NAME.vtm: NAME/NAME_<generation>_<number>.vtp, of which there was none before. Removed at
/// the end, or when the program is told to stop, unless they are to be kept.
class BlockFiles {
public:
  /// @throws FileError when NAME is no folder, or holds what is named otherwise
  explicit BlockFiles(const std::filesystem::path& vtm);
  ~BlockFiles();
  BlockFiles(const BlockFiles&) = delete;
  BlockFiles& operator=(const BlockFiles&) = delete;

  /// Makes NAME, unless it is there. @throws FileError
  void makeFolder();

  /// The file of the next block.
  std::filesystem::path next() const;

  /// Gives the next block its file.
  void commit(files::FileReplacement& file, const std::filesystem::path& name, const std::string& block);

  /// What NAME.vtm has to say.
  std::string list() const;

  /// That is said: the blocks stay. To be called under lockUnfinished().
  void keep();

  /// Removes the blocks that an earlier NAME.vtm listed.
  void removeEarlier() const;

private:
  std::filesystem::path folder_;
  std::optional<files::OutputFolder> made_folder_; ///< goes after the blocks in it
  std::string stem_;
  std::vector<std::filesystem::path> earlier_;
  std::size_t generation_ = 0;
  std::vector<std::pair<std::filesystem::path, std::string>> made_; ///< file and block
};

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
