// SPDX-License-Identifier: BSD-3-Clause
// A question's answers about each point, as a site of the same tiles with more fields.
//
//   site::ResultSite out(valley, "marked", {{"collision", pcl::PCLPointField::UINT8, 0.0}});
//   site::ask(question, valley, machine, {.receiver = [&](const auto& tile, const auto& cloud, const Answer& found) {
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

/// A field of one number. The points of all tiles have it, also of tiles that the question has not read.
struct ResultField {
  std::string name;
  std::uint8_t datatype = 0; ///< of pcl::PCLPointField
  double none = 0.0;         ///< the value of points without an answer
};

/// Returns the site's fields with answers to an earlier question, which was asked of its clouds before the site was
/// made. These are `collision`, `distance`, `first_pose` and `closest_pose`, of each source with a field `collision`.
/// ResultSite leaves them out, as they would pass for answers to this question.
/// @param fields that this question answers: they are not returned
std::vector<std::string> staleFields(const Site& site, const std::vector<ResultField>& fields);

/// Returns the bytes that a site of results takes on the disk, besides the files of an earlier run in its folder.
std::uint64_t spaceWanted(const Site& site, const std::filesystem::path& folder,
                          const std::vector<ResultField>& fields);

/// Lets a run use the answers that an earlier run of its question has kept.
struct Continuation {
  std::string question; ///< all that was asked; empty: nothing is kept for another run
  bool goes_on = false; ///< true: use the answers there, which must be to this question; false: remove them
};

/// Made and finished by all ranks of an MPI job together; each writes the tiles that it has. Until finish() has
/// returned, the folder is marked as not complete. With a question, each tile is in place as soon as it is written,
/// with its answer in a file beside it. So a run of that question can go on where finish() is not reached. Without a
/// question, or before any tile, a single process that fails removes the files that it made. A failed MPI job, or a
/// process that was killed, may leave a marked folder. The next ResultSite, or makeSite(), clears it.
class ResultSite {
public:
  /// @param folder a new or empty one, or one that was left not complete
  /// @param fields of the results. Fields of these names that the site has already are written anew, and are no longer
  ///   fields of its sources. The others stay as they are, except staleFields()
  /// @throws files::FileError for a folder that holds anything, or cannot be written, or whose disk has no room; for a
  ///   field of the site that has the name of one of these and another type; where it shall go on with answers to
  ///   another question
  ResultSite(const Site& site, const std::filesystem::path& folder, const std::vector<ResultField>& fields,
             const Continuation& continuation = {});
  ~ResultSite();
  ResultSite(const ResultSite&) = delete;
  ResultSite& operator=(const ResultSite&) = delete;

  /// Writes the points of a tile, once.
  /// @param tile one of the site's
  /// @param cloud its points
  /// @param columns for each field a value of its type per point; null: there is no answer
  void write(const Tile& tile, const pcl::PCLPointCloud2& cloud, const std::vector<const void*>& columns);

  /// Returns the answers to the continuation's question, for SiteMeans::answers. Null where nothing is kept.
  TileAnswers* answers();

  /// Returns how many answers of an earlier run this one has removed, where it was not to go on. On the first rank; 0
  /// on the others.
  std::uint64_t thrownAway() const;

  /// Copies the tiles that no rank has written, and makes the folder a site. To be called once.
  Site finish();

private:
  class Writer;
  std::unique_ptr<Writer> writer_;
};

/// Returns the number of tiles with answers in a folder that is no site yet: their question can go on.
std::uint64_t answersIn(const std::filesystem::path& folder);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
