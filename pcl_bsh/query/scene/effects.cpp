// SPDX-License-Identifier: BSD-3-Clause
// What a query computes: the pairs worth asking about, then each listed effect by itself, with its own cost.
#include <pcl_bsh/query/scene/effect.h>

namespace pcl_bsh {

Path Scene::State::pathOf(ObjectId object) const
{
  const Body& body = bodies[object];
  return {body.last_version > 0 ? body.last_pose : body.object.pose, body.object.pose, body.box};
}

SceneResult Scene::State::query()
{
  const Effects& effects = options.effects;
  result.time = time;
  const bool of_near = effects.any || effects.flags || effects.contacts;
  if (of_near || effects.distance || looksBack(effects)) prepareGrid();
  if (of_near) findNear();
  if (effects.any) findAny();
  if (effects.flags) findFlags();
  if (effects.distance) findDistances();
  if (effects.contacts) findContacts();
  if (effects.first_contact) findFirstContacts();
  if (effects.swept) findSwept();
  if (effects.self) findSelf();
  if (!of_near) grid.dropParted(); // nobody keeps them
  for (const ObjectId object : moved_before) bodies[object].last_motion = 0.0;
  for (const ObjectId object : moved) {
    Body& body = bodies[object];
    body.last_motion =
        options.remember && body.last_version > 0 ? motionBound(body.box, body.last_pose, body.object.pose) : 0.0;
    body.last_pose = body.object.pose;
    body.last_version = body.version;
    body.listed = false;
  }
  moved_before.swap(moved);
  moved.clear();
  SceneResult finished = std::move(result);
  result = SceneResult();
  return finished;
}

} // namespace pcl_bsh
