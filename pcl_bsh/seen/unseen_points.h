// SPDX-License-Identifier: BSD-3-Clause
// Which points of what is placed into scans lie where no scanner saw that the space about them is empty?
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/query/work.h>
#include <pcl_bsh/seen/seen_space.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// What markUnseen() reads.
struct UnseenRequest {
  double clearance = 0.0; ///< finite, >= 0: radius of the ball about a point, its radius and uncertainty on top
  unsigned threads = 1;   ///< 0: all of the machine's
  /// Called now and then, by the calling thread, with the fraction done in [0, 1], which never falls. False: stop,
  /// markUnseen() throws Cancelled.
  std::function<bool(double)> progress = {};
};

/// What markUnseen() found.
struct UnseenResult {
  std::size_t unseen = 0; ///< points that were free and are unseen
  Work work;              ///< node_pairs: spheres of the model, and of directions, that were tested
};

/// Makes Verdict::free of a point Verdict::unseen where no scanner saw the ball about it. Other verdicts stay. Of a
/// triangle all places must be seen, each by one scanner: it is halved until balls about its parts are, down to an
/// eighth of the clearance and its uncertainty, and to 14 times.
/// @param model at T_scans_model. @param verdicts one per record of its view, such as FlagsResult::b
/// @throws std::invalid_argument naming the value: a clearance, a pose, or a number of verdicts. Cancelled
UnseenResult markUnseen(const SeenSpace& seen, const Placed& model, const UnseenRequest& request,
                        std::vector<Verdict>& verdicts);

namespace brute_force {

/// The oracle: each ball against each beam and each cell of directions. Quadratic.
/// @param angle as SeenOptions has it, of all scans
UnseenResult markUnseen(const std::vector<ScanBeams>& scans, double angle, const Placed& model,
                        const UnseenRequest& request, std::vector<Verdict>& verdicts);

} // namespace brute_force
} // namespace pcl_bsh
PCL_BSH_EXPORT_END
