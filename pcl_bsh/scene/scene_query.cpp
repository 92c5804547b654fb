// SPDX-License-Identifier: BSD-3-Clause
// A scene's query: finds the pairs worth asking about, then computes each listed effect by itself, with its own cost.
#include <pcl_bsh/scene/effects/each_pair.h>

#include <algorithm>

namespace pcl_bsh {

/// Lists the motions that swept effects look at, and the objects of which they leave something out.
void Scene::State::listSweptMotions()
{
  std::vector<ObjectId> objects = moved;
  std::sort(objects.begin(), objects.end());
  for (const ObjectId object : objects) {
    const Body& body = bodies[object];
    const bool seen = body.last_version > 0;
    const UnsweptObject left_out{object, !seen && queried && !stepping, seen && body.reshaped, body.detoured};
    if (left_out.added || left_out.reshaped || left_out.detoured) result.unswept.push_back(left_out);
    const bool is_moved = body.isMoved();
    SweptObject(body).eachLeg([&](std::optional<std::uint32_t> part, const Leg& leg, const ObjectMotion& motion) {
      checkMotion(body, motion, options.tolerance / 16);
      if (is_moved) result.swept_motions.push_back({object, leg, part});
    });
  }
}

SceneResult Scene::State::query()
{
  const Effects& effects = options.effects;
  followPoints();
  followSolids();
  if (usesSweptMotion(effects)) listSweptMotions();
  result.time = time;
  const bool of_near = effects.any || effects.flags || effects.contacts;
  if (of_near || effects.distance || usesSweptMotion(effects)) prepareGrid();
  if (of_near) findNear();
  const auto find = [&](Effect effect, void (State::*findIts)(EffectCost&)) {
    if (!effects.has(effect)) return;
    share = (1.0 + static_cast<double>(effect)) / static_cast<double>(kEffects);
    const Timed timed(cost(effect).seconds);
    (this->*findIts)(cost(effect));
  };
  find(Effect::any, &State::findAny);
  find(Effect::flags, &State::findFlags);
  find(Effect::distance, &State::findDistances);
  find(Effect::contacts, &State::findContacts);
  find(Effect::first_contact, &State::findFirstContacts);
  find(Effect::swept, &State::findSwept);
  find(Effect::self, &State::findSelf);
  progress->finish();
  if (!of_near) grid.dropParted(); // no list holds them
  for (const ObjectId object : moved_before) bodies[object].last_motion = 0.0;
  for (const ObjectId object : moved) {
    Body& body = bodies[object];
    body.last_motion =
        options.remember && body.last_version > 0 ? motionBound(body.box, body.last_pose, body.object.pose) : 0.0;
    body.last_pose = body.object.pose;
    body.last_version = body.version;
    body.last_parts.clear();
    body.turned.setZero();
    body.listed = body.reshaped = body.detoured = false;
  }
  moved_before.swap(moved);
  moved.clear();
  queried = true;
  SceneResult finished = std::move(result);
  result = SceneResult();
  return finished;
}

} // namespace pcl_bsh
