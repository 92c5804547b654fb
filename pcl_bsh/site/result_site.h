// SPDX-License-Identifier: BSD-3-Clause
// What a question has found of each point, as a site of the same tiles with more fields.
//
//   site::ResultSite out(valley, "marked", {{"collision", pcl::PCLPointField::UINT8, 0.0}});
//   site::ask(question, valley, machine, {.sink = [&](const auto& tile, const auto& cloud, const Answer& found) {
//     out.write(tile, cloud, {found.collisions.flags.data()});
//   }});
//   site::Site marked = out.finish();
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/site/ask_site.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// A field of one number, which the points of tiles that no question has read have, too.
struct ResultField {
  std::string name;
  std::uint8_t datatype = 0; ///< of pcl::PCLPointField
  double none = 0.0;         ///< the value of points of which nothing was found
};

/// The site's fields of an earlier question that its clouds had been asked before it was made: `collision`, `distance`,
/// `first_pose` and `closest_pose` of a source with a field `collision`, but for those that this question answers.
/// Beside this question's answers they would pass for its own: ResultSite leaves them out.
/// @param fields that this question answers
std::vector<std::string> staleFields(const Site& site, const std::vector<ResultField>& fields);

/// What a site of results takes on the disk, in bytes, beside what an earlier run has left in its folder.
std::uint64_t spaceWanted(const Site& site, const std::filesystem::path& folder,
                          const std::vector<ResultField>& fields);

/// Lets a run of the same question use what an earlier one has found that was killed.
struct Continuation {
  std::string question; ///< all that was asked; empty: nothing is kept for another run
  bool goes_on = false; ///< whether to use what there is, which must be of the same question; else it is cleared
};

/// Made and finished by all ranks of an MPI job together; each writes the tiles that it has. Until finish() has
/// returned the folder is marked as not complete. With a question, each tile is in place as soon as it is written, and
/// what was found of it is beside it, so that the same question can go on where finish() is not reached. Without, or
/// before any tile, one process removes what it made; of an MPI job, or of a process that was killed, a marked folder
/// may be left, which the next ResultSite, or makeSite(), clears.
class ResultSite {
public:
  /// @param folder a new or empty one, or one that was left not complete
  /// @param fields of the results. Those that the site has already are written anew, and are no longer fields of its
  ///   sources; but for staleFields() the others stay as they are
  /// @throws files::FileError for a folder that holds anything, or cannot be written, or whose disk has no room; for a
  ///   field of the site that has the name of one of these and another type; where it shall go on with what another
  ///   question has found
  ResultSite(const Site& site, const std::filesystem::path& folder, const std::vector<ResultField>& fields,
             const Continuation& continuation = {});
  ~ResultSite();
  ResultSite(const ResultSite&) = delete;
  ResultSite& operator=(const ResultSite&) = delete;

  /// Writes the points of a tile, once.
  /// @param tile one of the site's
  /// @param cloud its points
  /// @param columns for each field a value of its type per point; null: nothing was found
  void write(const Tile& tile, const pcl::PCLPointCloud2& cloud, const std::vector<const void*>& columns);

  /// What the continuation's question has found, for SiteMeans::answers. Null where nothing is kept.
  TileAnswers* answers();

  /// Of how many tiles an earlier run had found something that this one has removed, for it was not to go on. On the
  /// first rank; 0 on the others.
  std::uint64_t thrownAway() const;

  /// Copies the tiles that no rank has written, and makes the folder a site. To be called once.
  Site finish();

private:
  class Writer;
  std::unique_ptr<Writer> writer_;
};

/// Of how many tiles a folder that is no site yet holds answers of a question that can go on.
std::uint64_t answersIn(const std::filesystem::path& folder);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
