// SPDX-License-Identifier: BSD-3-Clause
// Helpers of the files of a scene's effects: each asks its pairs side by side, and adds up their work.
#pragma once

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/scene/state.h>
#include <pcl_bsh/scene/swept/swept_object.h>

#include <limits>

namespace pcl_bsh {

constexpr double scene_rounding = 0x1p-40; ///< relative; far above that of a few operations in double

/// Calls decide(i) for each pair, in parallel, and adds up the costs that the pairs' memories note.
template <class Decide>
void Scene::State::eachPair(const std::vector<BroadPair*>& pairs, EffectCost& cost, const Decide& decide)
{
  progress->begin(share, pairs.size());
  parallelFor(pairs.size(), threadCount(options.threads), [&](std::size_t i) {
    if (progress->stopped()) return;
    pairs[i]->memory.work = Work();
    pairs[i]->memory.asked = 0;
    pairs[i]->memory.reused = false;
    decide(i);
    progress->step();
  });
  progress->throwIfStopped();
  for (const BroadPair* pair : pairs) {
    cost.pairs += pair->memory.asked;
    cost.reused += pair->memory.reused ? 1 : 0;
    cost.work += pair->memory.work;
  }
}

/// Calls ask(parts) for each two parts of a pair, until it returns false.
template <class Ask>
void Scene::State::eachPartPair(BroadPair& pair, const Ask& ask) const
{
  for (std::uint32_t i = 0; i < bodies[pair.a].world.size(); ++i)
    for (std::uint32_t j = 0; j < bodies[pair.b].world.size(); ++j) {
      ++pair.memory.asked;
      if (!ask(PartPair{pair.a, pair.b, i, j})) return;
    }
}

/// Calls ask(k, pair, parts) for each two parts of near pair k that is not known to be free.
template <class Ask>
void Scene::State::eachNearPair(EffectCost& cost, const Ask& ask)
{
  eachPair(near, cost, [&](std::size_t k) {
    BroadPair& pair = *near[k];
    pair.memory.reused = isKnownFree(pair);
    if (pair.memory.reused) return;
    eachPartPair(pair, [&](const PartPair& parts) {
      ask(k, pair, parts);
      return true;
    });
  });
}

/// Calls ask(k, pair, parts, a, b) for each two parts of pair k of the grid, if the motions of its objects come near
/// enough to meet.
template <class Ask>
void Scene::State::eachSweptPair(EffectCost& cost, const Ask& ask)
{
  const std::vector<BroadPair*>& pairs = grid.pairs();
  eachPair(pairs, cost, [&](std::size_t k) {
    BroadPair& pair = *pairs[k];
    const SweptObject a(bodies[pair.a]), b(bodies[pair.b]);
    Box3 box = a.box();
    box.grow((pair.clearance + options.tolerance) * (1.0 + scene_rounding));
    if (!box.meets(b.box())) return;
    eachPartPair(pair, [&](const PartPair& parts) {
      ask(k, pair, parts, a.part(parts.part_a), b.part(parts.part_b));
      return true;
    });
  });
}

} // namespace pcl_bsh
