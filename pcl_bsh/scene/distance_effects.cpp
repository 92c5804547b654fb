// SPDX-License-Identifier: BSD-3-Clause
// How near pairs are: smallest distances, contacts, first contacts.
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/scene/effect.h>

#include <algorithm>

namespace pcl_bsh {

void Scene::State::findDistances()
{
  EffectCost& spent = cost(Effect::distance);
  const Timed timed(spent.seconds);
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
  if (memory.distance_a == a.version && memory.distance_b == b.version) {
    memory.reused = true;
    return;
  }
  memory.distance_a = a.version;
  memory.distance_b = b.version;
  memory.within = false;
  Interval& interval = memory.distance.interval;
  interval = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Box3 box = a.world_box;
  box.grow(within * (1.0 + scene_rounding));
  if (a.box.empty() || b.box.empty() || !box.meets(b.world_box)) return;
  bool first = true;
  for (std::uint32_t i = 0; i < a.world.size(); ++i)
    for (std::uint32_t j = 0; j < b.world.size(); ++j) {
      const DistanceResult found = closestPair(placed(pair.a, i), placed(pair.b, j), {options.accuracy});
      memory.work += found.work;
      ++memory.asked;
      interval.lower = std::min(interval.lower, found.interval.lower);
      interval.upper = std::min(interval.upper, found.interval.upper);
      if (!found.pair || (!first && !(found.distance < memory.distance.distance))) continue;
      memory.distance = {{pair.a, pair.b, i, j}, found.distance, interval, *found.pair};
      first = false;
    }
  const bool certain = options.accuracy.isExact() || !options.accuracy.isProven();
  memory.within = !first && (certain ? memory.distance.distance : interval.lower) <= within;
}

void Scene::State::findContacts()
{
  EffectCost& spent = cost(Effect::contacts);
  const Timed timed(spent.seconds);
  std::vector<std::vector<ContactPair>> found(near.size());
  eachPair(near, spent, [&](std::size_t k) {
    const BroadPair& pair = *near[k];
    PairMemory& memory = near[k]->memory;
    if (isKnownFree(pair)) {
      memory.reused = true;
      return;
    }
    for (std::uint32_t i = 0; i < bodies[pair.a].world.size(); ++i)
      for (std::uint32_t j = 0; j < bodies[pair.b].world.size(); ++j) {
        ContactsResult contacts =
            nearestContacts(placed(pair.a, i), placed(pair.b, j), {pair.clearance, *options.effects.contacts});
        memory.work += contacts.work;
        ++memory.asked;
        if (contacts.contacts.empty() && contacts.complete) continue;
        found[k].push_back({{pair.a, pair.b, i, j}, std::move(contacts.contacts), contacts.complete});
      }
  });
  for (auto& of_pair : found)
    for (ContactPair& contacts : of_pair) result.contacts.push_back(std::move(contacts));
}

void Scene::State::findFirstContacts()
{
  EffectCost& spent = cost(Effect::first_contact);
  const Timed timed(spent.seconds);
  using Contacts = std::vector<std::optional<PartFirstContact>>;
  Contacts possible(grid.pairs().size()), certain(grid.pairs().size());
  eachSweptPair(
      spent, [&](std::size_t k, BroadPair& pair, const PartPair& parts, const SweptPart& a, const SweptPart& b) {
        const auto find = [&](Places places) {
          return firstContactOf(a, b, pair.clearance, options.tolerance, places, pair.memory.work);
        };
        const auto keepEarlier = [&](std::optional<PartFirstContact>& first, const std::optional<PairContact>& met) {
          if (met && (!first || met->s < first->fraction)) first = PartFirstContact{parts, met->s, met->pair};
        };
        const bool uncertain = areUncertain({a.hierarchy}, {b.hierarchy});
        const std::optional<PairContact> met = find(uncertain ? Places::possible : Places::measured);
        const std::optional<PairContact> surely = met && uncertain ? find(Places::certain) : met;
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
