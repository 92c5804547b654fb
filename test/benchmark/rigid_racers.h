// SPDX-License-Identifier: BSD-3-Clause
// Everyone who can say whether two bodies touch under a pose, behind one face.
#pragma once

#include "workload/points.h"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::bench {

/// Poses of b in a's frame, and motions between them: from which pose to which, by their indices.
struct Roadmap {
  std::vector<RigidPose> poses;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> motions;
};

class RigidRacer {
public:
  virtual ~RigidRacer() = default;

  /// Indexes what the racer needs of both bodies, wholly; `d` will be asked for.
  virtual void build(const Points& a, const Points& b, double d) = 0;

  /// Does any pair lie within the d of build(), b posed in a's frame?
  virtual bool any(const RigidPose& pose) const = 0;

  virtual bool measuresDistance() const { return false; }

  /// Smallest distance; only when measuresDistance().
  virtual double distance(const RigidPose&) const { return 0.0; }

  /// Whether the motion between two poses can be asked about. Then on how many of the first `count` motions of a
  /// roadmap any pair comes within the d of build(), to a tolerance of a tenth of it. One call for each, or one for
  /// all.
  virtual bool takesMotions() const { return false; }
  virtual std::size_t anyOnEachMotion(const Roadmap&, std::size_t /*count*/) const { return 0; }
  virtual std::size_t anyOnMotions(const Roadmap&, std::size_t /*count*/, unsigned /*threads*/) const { return 0; }

  /// Mean cost of the answers since the last call, in words.
  virtual std::string remark() { return ""; }

  /// Takes milliseconds a pose.
  virtual bool slow() const { return false; }
};

/// pcl_bsh, fcl (where FCL was found), grid, nanoflann, pcl_kdtree; the last three pose the points of b one by one and
/// ask an index over a.
std::vector<std::string> availableRigidRacers();

/// @throws std::invalid_argument for a name that is not available.
std::unique_ptr<RigidRacer> makeRigidRacer(const std::string& name);

} // namespace pcl_bsh::bench
