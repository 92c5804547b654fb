// SPDX-License-Identifier: BSD-3-Clause
// Which pairs are worth asking about: a voxel grid over the scene, then boxes.
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/scene/effects/each_pair.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

constexpr double kCoarse = 64; // voxels of an object's box beyond which its own voxels are looked at

/// Returns a voxel edge that suits most objects that are not fixed.
double edgeFor(const std::vector<Body>& bodies, double reach)
{
  std::vector<double> sizes;
  for (const bool fixed : {false, true}) {
    for (const Body& body : bodies)
      if (body.object.fixed == fixed && !body.box.empty()) sizes.push_back(2.0 * body.box.half().maxCoeff());
    if (!sizes.empty()) break;
  }
  if (sizes.empty()) return 1.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double edge = 1.5 * *middle + reach;
  return std::isfinite(edge) && edge > 0x1p-500 ? edge : 1.0;
}

} // namespace

void Scene::State::prepareGrid()
{
  const Timed timed(result.broad_phase.seconds);
  if (grid_stale) {
    reach = std::max(rules.largestClearance(), options.effects.distance.value_or(0.0)) * (1.0 + scene_rounding);
    grid.reset(!std::isfinite(reach)      ? std::numeric_limits<double>::infinity()
               : options.voxel_edge > 0.0 ? options.voxel_edge
                                          : edgeFor(bodies, reach),
               rules);
    for (Body& body : bodies) body.placed_version = 0;
    grid_stale = false;
    near_stale = true;
    near.clear();
    for (ObjectId i = 0; i < bodies.size(); ++i) place(i);
    return;
  }
  for (const ObjectId i : moved) place(i);
  for (const ObjectId i : moved_before) place(i); // their boxes in the grid held their motions
}

void Scene::State::place(ObjectId object)
{
  Body& body = bodies[object];
  const bool swept = usesSweptMotion(options.effects) && body.isMoved();
  if (body.placed_version == body.version && !body.placed_swept && !swept) return;
  body.placed_version = body.version;
  body.placed_swept = swept;
  ++result.broad_phase.moved;
  boxes_.assign(1, swept ? SweptObject(body).box() : body.world_box);
  boxes_.front().grow(0.5 * reach);
  // A record held by a solid may be far from all of the solid's voxels.
  const bool solid =
      std::any_of(body.object.parts.begin(), body.object.parts.end(), [](const ScenePart& part) { return part.solid; });
  if (!swept && !solid && grid.voxelsOf(boxes_.front()) > kCoarse) {
    boxes_.clear();
    for (std::size_t p = 0; p < body.world.size(); ++p) {
      const SphereHierarchy& hierarchy = *body.object.parts[p].hierarchy;
      const SphereHierarchy::Storage& storage = hierarchy.storage();
      for (std::size_t v = 0; v < storage.voxel_count; ++v) {
        Box3 box = pcl_bsh::moved(boxOf(storage.voxels[v].frame), body.world[p]); // grown beyond what rounding takes
        box.grow(outreach(hierarchy) + 0.5 * reach);
        boxes_.push_back(box);
      }
    }
  }
  grid.place(object, boxes_, result.broad_phase);
}

void Scene::State::compareBoxes(BroadPair& pair)
{
  const Body &a = bodies[pair.a], &b = bodies[pair.b];
  PairMemory& memory = pair.memory;
  if (!memory.of_near.follow(a.version, b.version)) return;
  ++result.broad_phase.box_tests;
  Box3 box = a.world_box;
  box.grow(pair.clearance * (1.0 + scene_rounding));
  const bool was_near = memory.near;
  memory.near = box.meets(b.world_box);
  if (memory.near && !was_near) newly_near_.push_back(&pair);
}

void Scene::State::findNear()
{
  const Timed timed(result.broad_phase.seconds);
  const auto before = [](const BroadPair* l, const BroadPair* r) { return pairKey(l->a, l->b) < pairKey(r->a, r->b); };
  newly_near_.clear();
  if (near_stale)
    for (BroadPair* pair : grid.pairs()) compareBoxes(*pair);
  else
    for (const ObjectId object : moved)
      for (BroadPair* pair : grid.pairsOf(object)) compareBoxes(*pair);
  near_stale = false;
  near.erase(std::remove_if(near.begin(), near.end(),
                            [](const BroadPair* pair) { return pair->shared == 0 || !pair->memory.near; }),
             near.end());
  const auto middle = static_cast<std::ptrdiff_t>(near.size());
  std::sort(newly_near_.begin(), newly_near_.end(), before);
  near.insert(near.end(), newly_near_.begin(), newly_near_.end());
  std::inplace_merge(near.begin(), near.begin() + middle, near.end(), before);
  grid.dropParted();
  result.broad_phase.pairs_sharing = grid.pairCount();
  result.broad_phase.candidates = near.size();
}

} // namespace pcl_bsh
