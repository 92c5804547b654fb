// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/scene_solids.h>

#include <pcl_bsh/depths/depths.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/reach.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/solid/labels.h>

#include <algorithm>
#include <utility>

namespace pcl_bsh {

SceneSolids::Known& SceneSolids::known(const std::shared_ptr<SphereHierarchy>& hierarchy)
{
  Known& found = known_[hierarchy.get()];
  found.hierarchy = hierarchy;
  const std::uint64_t now = hierarchy->storage().revision;
  if (std::exchange(found.revision, now) != now) {
    found.bodies.reset();
    found.solid.reset();
    found.queried.reset();
  }
  return found;
}

void SceneSolids::addSolid(const std::shared_ptr<SphereHierarchy>& hierarchy)
{
  Known& found = known(hierarchy);
  if (found.bodies) return;
  found.solid = std::make_unique<const Solid>(*hierarchy->view().triangles);
  found.bodies = std::make_unique<const SolidBodies>(*found.solid);
  any_ = true;
}

void SceneSolids::follow(const std::shared_ptr<SphereHierarchy>& hierarchy, bool solid)
{
  if (solid) addSolid(hierarchy);
  Known& found = known(hierarchy);
  if (!found.queried) found.queried = std::make_unique<const QueriedRecords>(*hierarchy);
}

std::optional<PointPair> SceneSolids::find(const StandingPart& a, const StandingPart& b, std::optional<double> within,
                                           Work& work) const
{
  const auto enclosed_by = [&](const StandingPart& solid, const StandingPart& other) -> std::optional<PointPair> {
    if (!solid.solid) return std::nullopt;
    const SolidBodies& bodies = bodiesOf(solid);
    const QueriedRecords& queried = queriedOf(other);
    const Eigen::Isometry3d &of_solid = solid.placed.pose, &of_other = other.placed.pose;
    if (!within) return findEnclosed(bodies, of_solid, queried, of_other, &work);
    const FlagsResult surface = collisionFlags(other.placed, solid.placed, {*within, Flagged::a});
    work += surface.work;
    const auto enclosed = enclosedBy({bodies.whole(), of_solid}, queried, of_other, 1, &work);
    const auto certain = certainlyEnclosed(enclosed, surface.a);
    if (certain.empty()) return std::nullopt;
    return PointPair{certain.front(), holderOf(bodies, of_solid, queried, of_other, certain.front(), &work)};
  };
  if (const auto pair = enclosed_by(b, a)) return pair;
  if (const auto pair = enclosed_by(a, b)) return PointPair{pair->b, pair->a};
  return std::nullopt;
}

void SceneSolids::addTo(FlagsResult& found, const StandingPart& a, const StandingPart& b) const
{
  const bool uncertain = areUncertain(a.placed, b.placed);
  const std::vector<Verdict> of_a = found.a, of_b = found.b; // of the surfaces, for each of two solids
  const auto add = [&](const StandingPart& solid, const StandingPart& other, std::vector<Verdict>& of_other,
                       std::vector<Verdict>& of_solid, std::vector<Verdict> surface_of_other,
                       std::vector<Verdict> surface_of_solid) {
    if (!solid.solid) return;
    const SolidBodies& bodies = bodiesOf(solid);
    const QueriedRecords& queried = queriedOf(other);
    const auto enclosed = enclosedBy({bodies.whole(), solid.placed.pose}, queried, other.placed.pose, 1, &found.work);
    addEnclosed(bodies, solid.placed.pose, queried, other.placed.pose, enclosed, uncertain, surface_of_other,
                surface_of_solid, &found.work);
    for (std::size_t i = 0; i < of_other.size(); ++i) of_other[i] = graver(of_other[i], surface_of_other[i]);
    for (std::size_t i = 0; i < of_solid.size(); ++i) of_solid[i] = graver(of_solid[i], surface_of_solid[i]);
  };
  add(a, b, found.b, found.a, of_b, of_a);
  add(b, a, found.a, found.b, of_a, of_b);
  found.colliding_a = countOf(found.a, Verdict::colliding);
  found.colliding_b = countOf(found.b, Verdict::colliding);
  found.undecided_a = countOf(found.a, Verdict::undecided);
  found.undecided_b = countOf(found.b, Verdict::undecided);
}

void SceneSolids::turn(DistanceResult& found, const StandingPart& a, const StandingPart& b) const
{
  const auto turn_by = [&](const StandingPart& solid, const StandingPart& other, bool solid_is_b) {
    if (!solid.solid) return;
    deepen(found, {bodiesOf(solid).whole(), solid.placed.hierarchy(), solid.placed.pose}, solid_is_b, queriedOf(other),
           other.placed.pose);
  };
  turn_by(b, a, true);
  turn_by(a, b, false);
}

/// A place that comes into a body, or leaves it, meets its surface. A place that comes out of a hollow meets the
/// surface of the hollow alone, and from then on the bodies round the hollow hold it. Their own surfaces already wind
/// round it at the beginning.
std::vector<std::uint32_t> SceneSolids::entered(const SweptPart& solid, const SweptPart& other, double tolerance,
                                                Work& work) const
{
  const SphereHierarchy* places = &known_.at(&other.hierarchy).queried->places();
  std::optional<const SphereHierarchy> middles; // of balls: a ball is enclosed where its middle is
  PointsView view = places->view();
  if (std::exchange(view.radii, nullptr)) places = &middles.emplace(view);
  const Reach reach(0.0, solid.hierarchy.storage().uncertainty, other.hierarchy.storage().uncertainty,
                    MeantPlaces::possible);
  std::vector<Verdict> of_places(view.count), of_solid(solid.hierarchy.view().count);
  flagContacts({*places, other.pose, other.motion}, solid, reach.most, tolerance, MeantPlaces::measured, of_places,
               of_solid, work);
  std::vector<std::int32_t> met;
  for (std::size_t i = 0; i < of_places.size(); ++i)
    if (of_places[i] != Verdict::free) met.push_back(static_cast<std::int32_t>(i));
  std::vector<std::uint32_t> triangles;
  if (met.empty()) return triangles;
  view.restrictTo(met.data(), met.size());
  const SphereHierarchy passing(view);
  const SolidBodies& bodies = *known_.at(&solid.hierarchy).bodies;
  for (const SolidBodies::Body& body : bodies.all()) {
    const bool is_met = std::any_of(body.triangles.begin(), body.triangles.end(),
                                    [&](std::uint32_t triangle) { return of_solid[triangle] != Verdict::free; });
    const Eigen::Isometry3d pose = solid.at(0.0).pose;
    if (is_met || anyWithin({passing, other.at(0.0).pose}, {bodies.solidOf(body), pose}, &work))
      triangles.insert(triangles.end(), body.triangles.begin(), body.triangles.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

} // namespace pcl_bsh
