// SPDX-License-Identifier: BSD-3-Clause
// pcl_bsh_site collide: a question about a site, answered on all ranks, and told by the first.
#pragma once

#include "site_options.h"

namespace pcl_bsh::cli {

/// @return the exit code. Where one of several ranks fails, its line is told and all are ended
int collideSite(const SiteOptions& options);

} // namespace pcl_bsh::cli
