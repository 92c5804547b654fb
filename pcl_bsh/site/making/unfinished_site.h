// SPDX-License-Identifier: BSD-3-Clause
// A site that is being made: its folder holds no site.json until all else is on the disk.
#pragma once

#include <pcl_bsh/io/files/new_file.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace pcl_bsh::site {

/// Whether a program was killed while it made a site in a folder.
bool isUnfinished(const std::filesystem::path& folder);

/// Returns how many bytes the folder's disk must have free for a site of so many bytes. The files of an earlier run
/// there do not count: they are taken over, or removed first.
std::uint64_t spaceWanted(const std::filesystem::path& folder, std::uint64_t bytes);

/// Makes the folder, if need be, and the files in it, which are removed again unless finish() or save() is called. The
/// files of an earlier run that was killed are removed first, where its mark is there. No other file is ever removed.
class UnfinishedSite {
public:
  enum class Use {
    alone,       ///< nothing is left of it where finish() is not reached
    shared,      ///< other processes write into the folder, too: its mark stays until finish()
    continuable, ///< goes on with what was saved
    resumed,     ///< as `shared`, and tiles of an earlier run stay until discardTiles()
  };

  /// @param bytes that the site will take on the disk; files of an earlier run there are part of it, or make room
  /// @throws files::FileError when there is a site already or anything else, when another program makes a site there,
  ///   when something was saved and the use is another one, when the folder cannot be made, or the disk has no room
  UnfinishedSite(const std::filesystem::path& folder, Use use, std::uint64_t bytes);
  ~UnfinishedSite();
  UnfinishedSite(const UnfinishedSite&) = delete;
  UnfinishedSite& operator=(const UnfinishedSite&) = delete;

  const std::filesystem::path& folder() const noexcept { return folder_.path(); }

  /// Makes a file. @param name relative to the folder
  files::NewFile& add(const std::filesystem::path& name);

  /// Whether an earlier run has saved something, and where that stands.
  bool wasSaved() const noexcept { return was_saved_; }
  std::filesystem::path stateFile() const;
  std::filesystem::path planFile() const;

  /// Removes the tiles' files that were begun after save(): the first `tiles` files stay.
  void discardTilesFrom(std::size_t tiles);

  /// Removes the files of tiles whose numbers are not among these.
  void discardTiles(const std::set<std::size_t>& stay);

  /// Leaves nothing where finish() is not reached, although the folder is shared.
  void forget();

  /// Removes a file that was begun, if there is one. @param name relative to the folder
  void discard(const std::filesystem::path& name);

  /// Opens a file that was there when save() was called, and cuts it to so many bytes. @param name relative to the
  /// folder
  files::NewFile& goOn(const std::filesystem::path& name, std::uint64_t bytes);

  /// Write the plan and the state. After save(), the files stay where finish() is not reached.
  void savePlan(const std::string& bytes);
  void save(const std::string& state);

  /// Brings all files to the disk, then site.json, and keeps them.
  void finish(const Site& site);

private:
  void mark();
  void clear();
  void keepMark();

  /// The file of the mark, open and locked while the site is made. It is closed also where the constructor throws. So a
  /// caller that tries again is not refused as another program that makes a site there.
  struct Mark {
    int file = -1;
    Mark() = default;
    ~Mark();
    Mark(const Mark&) = delete;
    Mark& operator=(const Mark&) = delete;
  };

  files::OutputFolder folder_;
  Mark mark_;
  bool stays_ = false, was_saved_ = false, finished_ = false;
  std::unique_ptr<files::NewFile> mark_file_;
  std::unique_ptr<files::OutputFolder> tiles_;
  std::vector<std::unique_ptr<files::NewFile>> files_;
};

} // namespace pcl_bsh::site
