// SPDX-License-Identifier: BSD-3-Clause
// Everyone who can say which points of A have a point of B within d, behind one face.
#pragma once

#include "workload/points.h"

#include <memory>
#include <string>
#include <vector>

namespace pcl_bsh::bench {

struct FlagsRun {
  double build_seconds = 0.0;
  double query_seconds = 0.0;
  std::vector<std::uint8_t> flags; ///< one per point of A
  std::string remark;              ///< work done, or how the racer was tuned
  double build_faults = 0.0;       ///< minor page faults of the build

  double totalSeconds() const { return build_seconds + query_seconds; }
};

class FlagsRacer {
public:
  virtual ~FlagsRacer() = default;

  /// Once per pair of clouds, not timed: bring them into the library's point type.
  virtual void adopt(const Points& a, const Points& b) = 0;

  /// Once per distance, not timed.
  virtual void tune(double) {}

  /// The result of tune(), for useTuning() of such a racer in another process; empty without tuning.
  virtual std::vector<double> tuning() const { return {}; }
  virtual void useTuning(const std::vector<double>&) {}

  /// From the bare clouds to the flags.
  virtual FlagsRun run(double d, unsigned threads) = 0;

  /// From the bare clouds to whether any point of A has a point of B within d: `flags` has one.
  virtual FlagsRun runAny(double d) = 0;
};

/// `name` is one of kFlagsRacers.
///   pcl_bsh       one shot: what the build leaves undone is built by the query where it goes
///   pcl_bsh_warm  all built ahead, so that its query is the query alone
///   grid          uniform grid with every trick a good afternoon finds; plain_grid: the one everybody writes first
///   fitted_grid   the same as grid with an edge of d, where that makes at most 4 cells a point, else the least that
///                 does: nothing is tried beforehand
///   nanoflann, pcl_kdtree, pcl_octree
/// The peers index B only and ask it point by point; with several threads only their queries are shared out.
/// @throws std::invalid_argument for another name.
std::unique_ptr<FlagsRacer> makeFlagsRacer(const std::string& name);

inline const std::vector<std::string> kFlagsRacers = {"pcl_bsh",     "pcl_bsh_warm", "grid",       "plain_grid",
                                                      "fitted_grid", "nanoflann",    "pcl_kdtree", "pcl_octree"};

} // namespace pcl_bsh::bench
