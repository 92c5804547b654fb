// SPDX-License-Identifier: BSD-3-Clause
// A site: its overview, and its tiles one by one. Which of them are drawn is up to TileChoice.
#pragma once

#include "field_content.h"

#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <memory>

namespace pcl_bsh::viewer {

class SiteContent final : public FieldContent {
public:
  /// @throws std::runtime_error as site::readSite() does, and for an overview that is missing, damaged or empty
  /// @throws cli::UsageError when the overview has more points than the budget
  explicit SiteContent(const Options& options);

  std::string name() const override { return viewed_clouds_[0].name; }
  std::string heading(const StepCollisions& collisions, std::size_t step) const override;
  std::string partsName(std::size_t count) const override { return nounOf(count, "point") + " of the overview"; }
  const SiteContent* site() const override { return this; }

  const site::Site& tiles() const { return site_; }
  std::uint64_t tilePoints() const { return tile_points_; } ///< that may be drawn beside the overview

  /// Reads a tile; nothing is asked of it. @param alike how it is coloured; must outlive what is returned
  /// @throws files::FileError when its file is not what the site says of it
  std::unique_ptr<ViewContent> readTile(std::size_t tile, const SharedColors& alike) const;

private:
  site::Site site_;
  std::uint64_t tile_points_ = 0;
};

} // namespace pcl_bsh::viewer
