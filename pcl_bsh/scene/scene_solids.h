// SPDX-License-Identifier: BSD-3-Clause
// Records that solid parts of a scene hold: added to the records that its effects find near surfaces.
#pragma once

#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/scene/swept/sweep.h>
#include <pcl_bsh/solid/enclosure.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

namespace pcl_bsh {

/// A part where it stands.
struct StandingPart {
  Placed placed;
  bool solid;
};

/// The solids among a scene's hierarchies, and the records of all hierarchies that solids are asked about. Nothing is
/// kept of a scene without solids. Queries of one state may run side by side.
class SceneSolids {
public:
  bool none() const noexcept { return !any_; }

  /// Makes the Solid and the bodies of a hierarchy, unless they are made. @throws InvalidInput as Solid does
  void addSolid(const std::shared_ptr<SphereHierarchy>& hierarchy);

  /// Makes what queries need of a hierarchy, anew where points have changed since. Called for each part before queries,
  /// once a scene has a solid. @param solid whether the part is one. @throws InvalidInput
  void follow(const std::shared_ptr<SphereHierarchy>& hierarchy, bool solid);

  /// Returns a record of a and a record of b, where the surfaces are known not to touch. One of them is enclosed, and
  /// the other is a triangle of a body that holds it. Nothing where no record is enclosed.
  /// @param within for parts whose places are uncertain, the clearance: only records count that are enclosed wherever
  ///   they truly are; nothing: records that are enclosed as measured
  std::optional<PointPair> find(const StandingPart& a, const StandingPart& b, std::optional<double> within,
                                Work& work) const;

  /// Adds what solids hold to the verdicts of both surfaces, at a pose. @param found flags of both sides
  void addTo(FlagsResult& found, const StandingPart& a, const StandingPart& b) const;

  /// Turns the smallest distance into the depth of the deepest enclosed record, less than 0, where there is one.
  void turn(DistanceResult& found, const StandingPart& a, const StandingPart& b) const;

  /// Returns the triangles, ascending, of each body of a solid that may hold a place of the other part at an instant of
  /// their motion. Bodies in which that place stays throughout are left out: they hold it at the beginning. A listed
  /// body that does not hold the place comes within the tolerance of it.
  std::vector<std::uint32_t> entered(const SweptPart& solid, const SweptPart& other, double tolerance,
                                     Work& work) const;

private:
  struct Known {
    std::shared_ptr<SphereHierarchy> hierarchy; ///< kept, so that no other one gets its place
    std::uint64_t revision = 0;                 ///< of its points
    std::unique_ptr<const Solid> solid;
    std::unique_ptr<const SolidBodies> bodies;
    std::unique_ptr<const QueriedRecords> queried;
  };

  Known& known(const std::shared_ptr<SphereHierarchy>& hierarchy);
  const SolidBodies& bodiesOf(const StandingPart& part) const { return *known_.at(&part.placed.hierarchy()).bodies; }
  const QueriedRecords& queriedOf(const StandingPart& part) const
  {
    return *known_.at(&part.placed.hierarchy()).queried;
  }

  bool any_ = false;
  std::unordered_map<const SphereHierarchy*, Known> known_;
};

} // namespace pcl_bsh
