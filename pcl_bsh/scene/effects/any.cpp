// SPDX-License-Identifier: BSD-3-Clause
// Which pairs collide, in the scene and within an object; remembered from step to step.
#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/scene/effects/each_pair.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

constexpr unsigned kPatience = 8; // queries after which a wider one that failed is tried again
constexpr double kAhead = 4.0;    // steps of the present speed that a wider query looks ahead

/// Whether a pair of points found earlier still collides for certain.
bool collides(const Placed& a, const Placed& b, PointPair pair, double clearance, Work& work)
{
  ++work.exact_decisions;
  const PointsView &of_a = a.hierarchy().view(), &of_b = b.hierarchy().view();
  const PairReach reach(of_a, of_b, clearance, certainPlaces(a, b));
  return reach.holds(RecordDistance(of_a, a.pose, of_b, b.pose), pair);
}

} // namespace

void Scene::State::findAny(EffectCost& spent)
{
  eachPair(near, spent, [this](std::size_t i) { decideAny(*near[i]); });
  for (const BroadPair* pair : near) {
    if (pair->memory.colliding) result.any.push_back(pair->memory.witness);
    if (pair->memory.undecided) result.undecided.push_back(*pair->memory.undecided);
  }
}

void Scene::State::decideAny(BroadPair& pair) const
{
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  PairMemory& memory = pair.memory;
  const bool remember = options.remember && options.accuracy.isExact(); // else memory would change answers
  memory.reused = !memory.of_any.follow(a.version, b.version) || (remember && remembersAny(pair));
  if (memory.reused) return;

  /// Whether any parts collide at the clearance; if so, notes the witness; if not, parts that may.
  const auto ask = [&](double clearance) {
    memory.undecided.reset();
    bool free = true;
    eachPartPair(pair, [&](const PartPair& parts) {
      const AnyResult found =
          anyCollision(placed(pair.a, parts.part_a), placed(pair.b, parts.part_b), {clearance, ofParts()});
      memory.work += found.work;
      const std::optional<PointPair> witness =
          found.pair || !areSolid(parts) ? found.pair
                                         : enclosedPair(standing(pair.a, parts.part_a), standing(pair.b, parts.part_b),
                                                        found.verdict, clearance, memory.work);
      if (found.verdict == Verdict::undecided && !memory.undecided) memory.undecided = parts;
      if (!witness) return true;
      memory.undecided.reset();
      memory.witness = {parts, *witness};
      return free = false;
    });
    return !free;
  };
  memory.has_witness = false;
  memory.apart = 0.0;
  const double ahead = remember ? kAhead * (a.last_motion + b.last_motion) : 0.0;
  if (ahead > 0.0 && std::isfinite(pair.clearance + ahead) && memory.patience == 0) {
    // A pair that is free at a wider clearance is not asked again until it has moved that far.
    memory.colliding = ask(pair.clearance + ahead);
    if (!memory.colliding && !memory.undecided) {
      memory.apart = pair.clearance + ahead;
      memory.apart_a = a.object.pose;
      memory.apart_b = b.object.pose;
      return;
    }
    memory.patience = kPatience;
    memory.has_witness =
        memory.colliding && collides(placed(pair.a, memory.witness.part_a), placed(pair.b, memory.witness.part_b),
                                     memory.witness.pair, pair.clearance, memory.work);
    if (memory.has_witness) return;
  }
  else if (memory.patience > 0) {
    --memory.patience;
  }
  memory.colliding = memory.has_witness = ask(pair.clearance);
}

std::optional<PointPair> Scene::State::enclosedPair(const StandingPart& a, const StandingPart& b, Verdict surfaces,
                                                    double clearance, Work& work) const
{
  const bool uncertain = surfaces == Verdict::undecided && areUncertain(a.placed, b.placed);
  return solids.find(a, b, uncertain ? std::optional(clearance) : std::nullopt, work);
}

/// Whether an earlier step still answers: by the distance at which it found the pair free, or by its witness.
bool Scene::State::remembersAny(BroadPair& pair) const
{
  PairMemory& memory = pair.memory;
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  if (memory.apart > pair.clearance) {
    const double way =
        motionBound(a.box, memory.apart_a, a.object.pose) + motionBound(b.box, memory.apart_b, b.object.pose);
    if (memory.apart * (1.0 - scene_rounding) - way > pair.clearance) {
      memory.colliding = false;
      return true;
    }
  }
  if (!memory.has_witness) return false;
  memory.colliding = collides(placed(pair.a, memory.witness.part_a), placed(pair.b, memory.witness.part_b),
                              memory.witness.pair, pair.clearance, memory.work);
  return memory.colliding;
}

/// Whether the effect `any` has just found that the pair is free.
bool Scene::State::isKnownFree(const BroadPair& pair) const
{
  return options.effects.any && !pair.memory.colliding && !pair.memory.undecided;
}

void Scene::State::findSelf(EffectCost& spent)
{
  progress->begin(share, bodies.size());
  for (ObjectId object = 0; object < bodies.size(); ++object) {
    const SceneObject& whole = bodies[object].object;
    for (std::uint32_t i = 0; i < whole.parts.size(); ++i)
      for (std::uint32_t j = i + 1; j < whole.parts.size(); ++j) {
        if (std::find(whole.adjacent.begin(), whole.adjacent.end(), std::make_pair(i, j)) != whole.adjacent.end())
          continue;
        // In the object's own frame, where only the parts' poses count.
        const AnyResult found =
            anyCollision({*whole.parts[i].hierarchy, whole.parts[i].pose},
                         {*whole.parts[j].hierarchy, whole.parts[j].pose}, {options.clearance, ofParts()});
        spent.work += found.work;
        ++spent.pairs;
        std::optional<PointPair> witness = found.pair;
        if (!witness && (whole.parts[i].solid || whole.parts[j].solid)) {
          const auto in_object = [&](std::uint32_t part) {
            return StandingPart{{*whole.parts[part].hierarchy, whole.parts[part].pose}, whole.parts[part].solid};
          };
          witness = enclosedPair(in_object(i), in_object(j), found.verdict, options.clearance, spent.work);
        }
        if (witness)
          result.self.push_back({object, i, j, *witness});
        else if (found.verdict == Verdict::undecided)
          result.undecided.push_back({object, object, i, j});
      }
    progress->step();
    progress->throwIfStopped();
  }
}

} // namespace pcl_bsh
