// SPDX-License-Identifier: BSD-3-Clause
// What users should know of a question about a site, as every program tells it.
#pragma once

#include "options.h"

#include <pcl_bsh/question/named_cloud.h>
#include <pcl_bsh/site/site.h>

#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// What site.json says of it; no tile is read.
NamedCloud namedSite(const site::Site& site);

/// What is to be told of a question.
/// @param obstacle as measuredCloud() or namedSite() has it. @param poses of it
std::vector<std::string> warningsOf(const site::Site& site, const NamedCloud& obstacle,
                                    const std::vector<Eigen::Isometry3d>& poses, const SiteOptions& options);

} // namespace pcl_bsh::cli
