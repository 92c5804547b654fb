// SPDX-License-Identifier: BSD-3-Clause
// How near pairs are: smallest distances, contacts, first contacts.
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/scene/effects/each_pair.h>

#include <algorithm>

namespace pcl_bsh {

void Scene::State::findDistances(EffectCost& spent)
{
  const std::vector<BroadPair*>& pairs = grid.pairs();
  const double within = *options.effects.distance;
  eachPair(pairs, spent, [&](std::size_t i) { decideDistance(*pairs[i], within); });
  for (const BroadPair* pair : pairs)
    if (pair->memory.within) result.distance.push_back(pair->memory.distance);
}

void Scene::State::decideDistance(BroadPair& pair, double within) const
{
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  PairMemory& memory = pair.memory;
  memory.reused = !memory.of_distance.follow(a.version, b.version);
  if (memory.reused) return;
  memory.within = false;
  Interval& interval = memory.distance.interval;
  interval = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Box3 box = a.world_box;
  box.grow(within * (1.0 + scene_rounding));
  if (a.box.empty() || b.box.empty() || !box.meets(b.world_box)) return;
  bool first = true;
  eachPartPair(pair, [&](const PartPair& parts) {
    DistanceResult found = closestPair(placed(pair.a, parts.part_a), placed(pair.b, parts.part_b), ofParts());
    if (areSolid(parts)) solids.turn(found, standing(pair.a, parts.part_a), standing(pair.b, parts.part_b));
    memory.work += found.work;
    interval.lower = std::min(interval.lower, found.interval.lower);
    interval.upper = std::min(interval.upper, found.interval.upper);
    if (!found.pair || (!first && !(found.distance < memory.distance.distance))) return true;
    memory.distance = {parts, found.distance, interval, *found.pair};
    first = false;
    return true;
  });
  const bool certain = options.accuracy.isExact();
  memory.within = !first && (certain ? memory.distance.distance : interval.lower) <= within;
}

void Scene::State::findContacts(EffectCost& spent)
{
  std::vector<std::vector<ContactPair>> found(near.size());
  eachNearPair(spent, [&](std::size_t k, BroadPair& pair, const PartPair& parts) {
    ContactsResult contacts = nearestContacts(placed(pair.a, parts.part_a), placed(pair.b, parts.part_b),
                                              {pair.clearance, *options.effects.contacts});
    pair.memory.work += contacts.work;
    if (contacts.contacts.empty() && contacts.complete) return;
    found[k].push_back({parts, std::move(contacts.contacts), contacts.complete});
  });
  for (auto& of_pair : found)
    for (ContactPair& contacts : of_pair) result.contacts.push_back(std::move(contacts));
}

void Scene::State::findFirstContacts(EffectCost& spent)
{
  using Contacts = std::vector<std::optional<PartFirstContact>>;
  Contacts possible(grid.pairs().size()), certain(grid.pairs().size());
  eachSweptPair(
      spent, [&](std::size_t k, BroadPair& pair, const PartPair& parts, const SweptPart& a, const SweptPart& b) {
        const auto find = [&](MeantPlaces places) {
          return firstContactOf(a, b, pair.clearance, options.tolerance, places, pair.memory.work);
        };
        const auto keepEarlier = [&](std::optional<PartFirstContact>& first, const std::optional<PairContact>& met) {
          if (met && (!first || met->s < first->fraction)) first = PartFirstContact{parts, met->s, met->pair};
        };
        const bool uncertain = areUncertain({a.hierarchy}, {b.hierarchy});
        std::optional<PairContact> met = find(uncertain ? MeantPlaces::possible : MeantPlaces::measured);
        std::optional<PairContact> surely = met && uncertain ? find(MeantPlaces::certain) : met;
        if (areSolid(parts) && !(surely && surely->s == 0.0)) { // a motion that begins inside meets at once
          const StandingPart at_a{a.at(0), bodies[parts.a].object.parts[parts.part_a].solid};
          const StandingPart at_b{b.at(0), bodies[parts.b].object.parts[parts.part_b].solid};
          const bool touching = met && met->s == 0.0; // then the surfaces may collide
          if (const auto enclosed = enclosedPair(at_a, at_b, touching ? Verdict::undecided : Verdict::free,
                                                 pair.clearance, pair.memory.work)) {
            surely = PairContact{0.0, *enclosed};
            if (!touching) met = surely;
          }
        }
        keepEarlier(possible[k], met);
        keepEarlier(possible[k], surely); // of the two searches, either may halt earlier, within the tolerance
        keepEarlier(certain[k], surely);
      });
  for (const auto& contact : possible)
    if (contact) result.first_contact.push_back(*contact);
  for (const auto& contact : certain)
    if (contact) result.certain_contact.push_back(*contact);
}

} // namespace pcl_bsh
