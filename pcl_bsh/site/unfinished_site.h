// SPDX-License-Identifier: BSD-3-Clause
// A site that is being made: its folder holds no site.json until all else is on the disk.
#pragma once

#include <pcl_bsh/files/new_file.h>
#include <pcl_bsh/files/output_folder.h>
#include <pcl_bsh/site/site.h>

#include <filesystem>
#include <memory>
#include <vector>

namespace pcl_bsh::sites {

/// Whether a folder holds what a program has left that was killed while it made a site.
bool isUnfinished(const std::filesystem::path& folder);

/// Makes the folder, if need be, and the files in it, which are removed again unless finish() is called. What an
/// earlier run has left that was killed is removed first, which is told by its mark; nothing else ever is.
class UnfinishedSite {
public:
  /// @throws files::FileError when there is a site already or anything else, when another program makes a site there,
  ///   or when the folder cannot be made
  explicit UnfinishedSite(const std::filesystem::path& folder);
  ~UnfinishedSite();
  UnfinishedSite(const UnfinishedSite&) = delete;
  UnfinishedSite& operator=(const UnfinishedSite&) = delete;

  const std::filesystem::path& folder() const noexcept { return folder_.path(); }

  /// Makes a file. @param name relative to the folder
  files::NewFile& add(const std::filesystem::path& name);

  /// Brings all files to the disk, then site.json, and keeps them.
  void finish(const Site& site);

private:
  void mark();

  files::OutputFolder folder_;
  int mark_ = -1; ///< open and locked while the site is made
  std::unique_ptr<files::NewFile> mark_file_;
  std::unique_ptr<files::OutputFolder> tiles_;
  std::vector<std::unique_ptr<files::NewFile>> files_;
};

} // namespace pcl_bsh::sites
