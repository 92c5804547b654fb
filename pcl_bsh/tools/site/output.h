// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_site collide --out: the answer about each point, as a site.
#pragma once

#include "site_options.h"

#include <pcl_bsh/io/reports/compared_obstacles.h>
#include <pcl_bsh/site/ask_site.h>
#include <pcl_bsh/site/result_site.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The obstacles in memory that a site is compared with: the only one, which has no name, or several with names.
struct ObstacleFiles {
  /// @throws files::FileError, also where points of the only one shall be written and cannot; std::invalid_argument for
  ///   an uncertainty that it cannot have
  explicit ObstacleFiles(const SiteOptions& options);

  bool haveNames() const { return !all.front().name.empty(); }
  const io::Obstacle& only() const { return all.front().loaded; } ///< @pre they have no names

  /// The surface of the only one; null where it is points.
  const io::Obstacle* surface() const { return only().isSurface() ? &only() : nullptr; }

  /// Sets the question about each obstacle; to be called again once the path is read.
  void setQuestion(const Question& question);

  /// Writes points or triangles of the only one with these flags, if they are asked for and this is the first rank.
  void write(const std::vector<Verdict>& flags, const SiteOptions& options) const;

  std::vector<io::ComparedObstacle> all;
  std::vector<PlacedShape> shapes; ///< as they are asked about
};

/// The end of the message of a run with --out that ends before it has answered.
inline constexpr auto what_stays = "what was found stays, and the same command with --resume goes on";

/// The field of flags at one pose.
site::ResultField collisionField();

/// Returns a line for each thing that a site of results drops without being asked: answers of a run that was ended, and
/// fields of earlier questions.
/// @param option that names its folder
std::vector<std::string> droppedBy(const site::ResultSite& out, const std::string& option,
                                   const std::filesystem::path& folder, const site::Site& site,
                                   const std::vector<site::ResultField>& fields);

/// The site of results, where it is asked for; else its receiver is null.
class SiteOutput {
public:
  /// @param obstacles null where the obstacle is a site, too
  /// @param cluster_distance of the lists of clashes; 0 where none is wanted
  /// @throws files::FileError for a folder that cannot be one
  SiteOutput(const site::Site& site, const ObstacleFiles* obstacles, double cluster_distance,
             const SiteOptions& options);

  /// Warnings for users before the question is answered, a line each.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Returns the answers of an earlier run, to which this run adds its own; null: nothing is kept.
  site::TileAnswers* answers() { return out_ ? out_->answers() : nullptr; }

  site::TileReceiver receiver();

  /// After the question. To be called by all ranks.
  void finish();

private:
  const SiteOptions& options_;
  std::optional<site::ResultSite> out_;
  std::vector<std::string> warnings_;
};

} // namespace pcl_bsh::cli
