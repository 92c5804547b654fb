// SPDX-License-Identifier: BSD-3-Clause
// The study at a glance: time across, error down, for the smallest distance and for flags.
#pragma once

#include "study.h"

#include <pcl_bsh/vtk/chart.h>

namespace pcl_bsh::accuracy {

/// The certified settings of a query that no other beats in both time and error, by ascending time; exact() is the
/// last. Settings that proved everything at these poses without promising it are left out, and so are those slower than
/// exact().
/// @param negligible errors up to here count as 0
std::vector<const Measurement*> frontier(const Study& study, const std::string& query, double negligible);

/// One chart for the distance, one for the flags. Ours are drawn at the error that cannot be exceeded, others at the
/// one that was measured.
std::vector<vtk::Chart> chartsOf(const Subject& subject, const Study& study);

} // namespace pcl_bsh::accuracy
