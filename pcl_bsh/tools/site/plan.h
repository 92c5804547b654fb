// SPDX-License-Identifier: BSD-3-Clause
// Predicts how long a question takes on other numbers of ranks, by the cost of its tiles.
#pragma once

#include <pcl_bsh/site/ask_site.h>

#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// A question that was answered, in seconds of the clock on the wall.
struct MeasuredRun {
  double seconds = 0.0; ///< all of it except copying
  double copying = 0.0; ///< copying of tiles that were not asked, to the site of results
  int ranks = 1;        ///< that it was answered on
  std::vector<site::TileCost> tiles;
};

struct RunPlan {
  unsigned ranks = 1;
  double seconds = 0.0;
  /// The part that more ranks cannot shorten, or the reason why ranks stand idle: "what all ranks do", "the longest
  /// tile", "too few tiles", "uneven tiles". It is "work" where more ranks would help.
  std::string limit;
  double on_all = 0.0;  ///< seconds of each rank to read the obstacle, build its hierarchy and choose tiles
  double copying = 0.0; ///< of each rank
  double busiest = 0.0; ///< seconds of the rank with the most work
  double even = 0.0;    ///< seconds of each rank if the work were dealt evenly
  double reading = 0.0; ///< of all tiles together: the least time of a disk that serves one rank at a time
};

/// Predicts a run. A rank gets its next tile when it has done one, as TileVisitor deals them. Ranks compute and read as
/// fast as those of the measured run.
RunPlan planRun(const MeasuredRun& run, unsigned ranks);

} // namespace pcl_bsh::cli
