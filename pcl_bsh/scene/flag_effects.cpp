// SPDX-License-Identifier: BSD-3-Clause
// Which points collide at the present poses, and during the motion to them.
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/scene/effect.h>

#include <algorithm>
#include <map>

namespace pcl_bsh {
namespace {

bool isNotFree(std::uint8_t flag)
{
  return flag != flagOf(Verdict::free);
}

/// Flags of parts, made when the first of their points is flagged.
class FlagTable {
public:
  explicit FlagTable(const std::vector<Body>& bodies) : bodies_(bodies) {}

  void merge(ObjectId object, std::uint32_t part, const std::vector<std::uint8_t>& flags)
  {
    if (std::none_of(flags.begin(), flags.end(), isNotFree)) return;
    FlaggedPart& target = parts_[std::uint64_t{object} << 32 | part];
    if (target.flags.empty()) {
      target.object = object;
      target.part = part;
      target.flags.assign(bodies_[object].object.parts[part].hierarchy->view().count, 0);
    }
    for (std::size_t i = 0; i < flags.size(); ++i)
      if (isNotFree(flags[i]) && target.flags[i] != flagOf(Verdict::colliding)) target.flags[i] = flags[i];
  }

  std::vector<FlaggedPart> take()
  {
    std::vector<FlaggedPart> list;
    for (auto& entry : parts_) {
      FlaggedPart& part = entry.second;
      const auto count = [&part](Verdict verdict) {
        return static_cast<std::size_t>(std::count(part.flags.begin(), part.flags.end(), flagOf(verdict)));
      };
      part.colliding = count(Verdict::colliding);
      part.undecided = count(Verdict::undecided);
      list.push_back(std::move(part));
    }
    return list;
  }

private:
  const std::vector<Body>& bodies_;
  std::map<std::uint64_t, FlaggedPart> parts_;
};

/// The flags of one pair of parts.
struct PairFlags {
  PartPair parts;
  std::vector<std::uint8_t> a, b;
};

std::vector<FlaggedPart> mergedFlags(const std::vector<Body>& bodies, const std::vector<std::vector<PairFlags>>& found)
{
  FlagTable table(bodies);
  for (const auto& of_pair : found)
    for (const PairFlags& flags : of_pair) {
      table.merge(flags.parts.a, flags.parts.part_a, flags.a);
      table.merge(flags.parts.b, flags.parts.part_b, flags.b);
    }
  return table.take();
}

/// Of the motion; what may collide is undecided, unless it does for certain.
void flagSwept(const SweptPart& a, const SweptPart& b, double clearance, double tolerance, PairFlags& flags, Work& work)
{
  const bool uncertain = areUncertain({a.hierarchy}, {b.hierarchy});
  flagContacts(a, b, clearance, tolerance, uncertain ? Places::possible : Places::measured, flags.a, flags.b, work);
  if (!uncertain || std::none_of(flags.a.begin(), flags.a.end(), isNotFree)) return;
  std::vector<std::uint8_t> certain_a(flags.a.size()), certain_b(flags.b.size());
  flagContacts(a, b, clearance, tolerance, Places::certain, certain_a, certain_b, work);
  std::size_t colliding = 0, undecided = 0; // counted once all pairs are known
  withhold(flags.a, certain_a, colliding, undecided);
  withhold(flags.b, certain_b, colliding, undecided);
}

} // namespace

void Scene::State::findFlags()
{
  EffectCost& spent = cost(Effect::flags);
  const Timed timed(spent.seconds);
  std::vector<std::vector<PairFlags>> found(near.size());
  eachPair(near, spent, [&](std::size_t k) {
    const BroadPair& pair = *near[k];
    PairMemory& memory = near[k]->memory;
    if (isKnownFree(pair)) {
      memory.reused = true;
      return;
    }
    FlagsRequest request;
    request.clearance = pair.clearance;
    request.flagged = Side::both;
    request.accuracy = options.accuracy;
    for (std::uint32_t i = 0; i < bodies[pair.a].world.size(); ++i)
      for (std::uint32_t j = 0; j < bodies[pair.b].world.size(); ++j) {
        FlagsResult flags = collisionFlags(placed(pair.a, i), placed(pair.b, j), request);
        memory.work += flags.work;
        ++memory.asked;
        const std::size_t not_free = flags.colliding_a + flags.colliding_b + flags.undecided_a + flags.undecided_b;
        if (not_free > 0) found[k].push_back({{pair.a, pair.b, i, j}, std::move(flags.a), std::move(flags.b)});
      }
  });
  result.flags = mergedFlags(bodies, found);
}

void Scene::State::findSwept()
{
  EffectCost& spent = cost(Effect::swept);
  const Timed timed(spent.seconds);
  std::vector<std::vector<PairFlags>> found(grid.pairs().size());
  eachSweptPair(spent,
                [&](std::size_t k, BroadPair& pair, const PartPair& parts, const SweptPart& a, const SweptPart& b) {
                  PairFlags flags{parts, std::vector<std::uint8_t>(a.hierarchy.view().count, 0),
                                  std::vector<std::uint8_t>(b.hierarchy.view().count, 0)};
                  flagSwept(a, b, pair.clearance, options.tolerance, flags, pair.memory.work);
                  if (std::any_of(flags.a.begin(), flags.a.end(), isNotFree)) found[k].push_back(std::move(flags));
                });
  result.swept = mergedFlags(bodies, found);
}

} // namespace pcl_bsh
