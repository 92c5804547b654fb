// SPDX-License-Identifier: BSD-3-Clause
// The warning of question/warnings/hollow.h about a site and a mesh.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/question.h>
#include <pcl_bsh/question/shape.h>
#include <pcl_bsh/question/warnings/warnings.h>
#include <pcl_bsh/site/site.h>

#include <optional>
#include <string>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// Where faces of the obstacle close, and it is no solid: a place of the site inside of it, unless something of the
/// site is near its surface. Of tiles that meet its box at some pose, up to four are read. To be called by all ranks.
/// @param nearest how near an answer says that anything is, as nearestOf() has it; none: it does not tell, and if there
///   is such a place, closestPair() is asked where the obstacle stands
/// @pre hierarchy() of the obstacle was called @throws as readTile() and closestPair() do
std::optional<Warning> warningOfHollow(const Site& site, const std::string& name, const Question& question,
                                       std::optional<double> nearest, Shape& obstacle);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
