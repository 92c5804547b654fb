// SPDX-License-Identifier: BSD-3-Clause
// The tables of a page about several obstacles.
#pragma once

#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/page_text.h>

namespace pcl_bsh::io {

/// A row for each obstacle, then one for each two that were compared with each other; false where there is one obstacle
/// without a name.
Data obstacleTable(const ClashLists& lists);

} // namespace pcl_bsh::io
