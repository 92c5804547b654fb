// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_site collide SITE OBSTACLE, where the obstacle is a site, too.
#pragma once

#include "clashes.h"
#include "options.h"
#include "output.h"
#include "report.h"

namespace pcl_bsh::cli {

/// The answer, the same on all ranks. @param told what users should know of the question. Writes the site of the
/// obstacle's flags, where it is asked for.
Json askOfSite(const site::Site& site, const Poses& poses, const SiteOptions& options, SiteOutput& out,
               SiteClashList& clashes, MeasuredRun& run, Step* step, std::vector<std::string>& told);

} // namespace pcl_bsh::cli
