// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_site collide --out: what was found of each point, as a site.
#pragma once

#include "options.h"

#include <pcl_bsh/site/collide_site.h>
#include <pcl_bsh/site/result_site.h>

#include <optional>

namespace pcl_bsh::cli {

/// The site of results, where one is asked for; else its sinks are null.
class SiteOutput {
public:
  /// @throws files::FileError for a folder that cannot be one
  SiteOutput(const sites::Site& site, const SiteOptions& options);

  sites::FlagsSink flags();
  sites::DistancesSink distances();
  sites::PassageSink passage();

  /// After the question. To be called by all ranks.
  void finish();

private:
  bool moves_;
  std::optional<sites::ResultSite> out_;
};

} // namespace pcl_bsh::cli
