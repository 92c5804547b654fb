// SPDX-License-Identifier: BSD-3-Clause
// Which points collide at the present poses, and during the motion to them.
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/scene/effects/each_pair.h>

#include <algorithm>
#include <map>

namespace pcl_bsh {
namespace {

bool isNotFree(Verdict flag)
{
  return flag != Verdict::free;
}

/// The flags of one pair of parts.
struct PairFlags {
  PartPair parts;
  std::vector<Verdict> a, b;
};

/// Flags of each part that has a flagged point.
std::vector<FlaggedPart> mergedFlags(const std::vector<Body>& bodies, const std::vector<std::vector<PairFlags>>& found)
{
  std::map<std::pair<ObjectId, std::uint32_t>, FlaggedPart> parts;
  const auto merge = [&](ObjectId object, std::uint32_t part, const std::vector<Verdict>& flags) {
    if (std::none_of(flags.begin(), flags.end(), isNotFree)) return;
    FlaggedPart& target = parts[{object, part}];
    target.object = object;
    target.part = part;
    target.flags.resize(bodies[object].object.parts[part].hierarchy->view().count);
    for (std::size_t i = 0; i < flags.size(); ++i) target.flags[i] = graver(target.flags[i], flags[i]);
  };
  for (const auto& of_pair : found)
    for (const PairFlags& flags : of_pair) {
      merge(flags.parts.a, flags.parts.part_a, flags.a);
      merge(flags.parts.b, flags.parts.part_b, flags.b);
    }
  std::vector<FlaggedPart> list;
  for (auto& [names, part] : parts) {
    part.colliding = countOf(part.flags, Verdict::colliding);
    part.undecided = countOf(part.flags, Verdict::undecided);
    list.push_back(std::move(part));
  }
  return list;
}

/// Flags of the motion; points that may collide are undecided, unless they do for certain.
void flagSwept(const SweptPart& a, const SweptPart& b, double clearance, double tolerance, PairFlags& flags, Work& work)
{
  const bool uncertain = areUncertain({a.hierarchy}, {b.hierarchy});
  flagContacts(a, b, clearance, tolerance, uncertain ? MeantPlaces::possible : MeantPlaces::measured, flags.a, flags.b,
               work);
  if (!uncertain || std::none_of(flags.a.begin(), flags.a.end(), isNotFree)) return;
  std::vector<Verdict> certain_a(flags.a.size()), certain_b(flags.b.size());
  flagContacts(a, b, clearance, tolerance, MeantPlaces::certain, certain_a, certain_b, work);
  std::size_t colliding = 0, undecided = 0; // counted once all pairs are known
  withhold(flags.a, certain_a, colliding, undecided);
  withhold(flags.b, certain_b, colliding, undecided);
}

} // namespace

void Scene::State::findFlags(EffectCost& spent)
{
  std::vector<std::vector<PairFlags>> found(near.size());
  eachNearPair(spent, [&](std::size_t k, BroadPair& pair, const PartPair& parts) {
    FlagsResult flags = collisionFlags(placed(pair.a, parts.part_a), placed(pair.b, parts.part_b),
                                       {pair.clearance, Flagged::both, ofParts()});
    if (areSolid(parts)) solids.addTo(flags, standing(pair.a, parts.part_a), standing(pair.b, parts.part_b));
    pair.memory.work += flags.work;
    const std::size_t not_free = flags.colliding_a + flags.colliding_b + flags.undecided_a + flags.undecided_b;
    if (not_free > 0) found[k].push_back({parts, std::move(flags.a), std::move(flags.b)});
  });
  result.flags = mergedFlags(bodies, found);
}

/// Adds the points that a solid holds at an instant of the motion.
void Scene::State::addEnclosedAt(double s, const SweptPart& a, const SweptPart& b, const PartPair& parts,
                                 BroadPair& pair, std::vector<Verdict>& flags_a, std::vector<Verdict>& flags_b) const
{
  const StandingPart at_a{a.at(s), bodies[parts.a].object.parts[parts.part_a].solid};
  const StandingPart at_b{b.at(s), bodies[parts.b].object.parts[parts.part_b].solid};
  FlagsResult found;
  if (areUncertain(at_a.placed, at_b.placed)) {
    found = collisionFlags(at_a.placed, at_b.placed, {pair.clearance, Flagged::both});
  }
  else {
    found.a.resize(flags_a.size());
    found.b.resize(flags_b.size());
  }
  solids.addTo(found, at_a, at_b);
  pair.memory.work += found.work;
  for (std::size_t i = 0; i < flags_a.size(); ++i) flags_a[i] = graver(flags_a[i], found.a[i]);
  for (std::size_t i = 0; i < flags_b.size(); ++i) flags_b[i] = graver(flags_b[i], found.b[i]);
}

/// Adds the points held at the motion's beginning and end, and the bodies that something passes through on the way.
void Scene::State::addEnclosedOnTheWay(const SweptPart& a, const SweptPart& b, const PartPair& parts, BroadPair& pair,
                                       std::vector<Verdict>& flags_a, std::vector<Verdict>& flags_b) const
{
  const Verdict verdict = areUncertain({a.hierarchy}, {b.hierarchy}) ? Verdict::undecided : Verdict::colliding;
  const auto add_entered = [&](const SweptPart& solid, const SweptPart& other, std::vector<Verdict>& of_solid) {
    for (const std::uint32_t triangle : solids.entered(solid, other, options.tolerance, pair.memory.work))
      of_solid[triangle] = graver(of_solid[triangle], verdict);
  };
  const bool met = std::any_of(flags_a.begin(), flags_a.end(), isNotFree);
  for (const double s : {0.0, 1.0}) addEnclosedAt(s, a, b, parts, pair, flags_a, flags_b);
  if (!met) return;
  if (bodies[parts.a].object.parts[parts.part_a].solid) add_entered(a, b, flags_a);
  if (bodies[parts.b].object.parts[parts.part_b].solid) add_entered(b, a, flags_b);
}

void Scene::State::findSwept(EffectCost& spent)
{
  std::vector<std::vector<PairFlags>> found(grid.pairs().size());
  eachSweptPair(spent,
                [&](std::size_t k, BroadPair& pair, const PartPair& parts, const SweptPart& a, const SweptPart& b) {
                  PairFlags flags{parts, std::vector<Verdict>(a.hierarchy.view().count),
                                  std::vector<Verdict>(b.hierarchy.view().count)};
                  flagSwept(a, b, pair.clearance, options.tolerance, flags, pair.memory.work);
                  if (areSolid(parts)) addEnclosedOnTheWay(a, b, parts, pair, flags.a, flags.b);
                  if (std::any_of(flags.a.begin(), flags.a.end(), isNotFree)) found[k].push_back(std::move(flags));
                });
  result.swept = mergedFlags(bodies, found);
}

} // namespace pcl_bsh
