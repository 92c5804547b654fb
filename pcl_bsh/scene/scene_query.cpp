// SPDX-License-Identifier: BSD-3-Clause
// What a query computes: the pairs worth asking about, then each listed effect by itself, with its own cost.
#include <pcl_bsh/scene/effect.h>

#include <algorithm>

namespace pcl_bsh {

Leg Scene::State::legOf(ObjectId object) const
{
  const Body& body = bodies[object];
  const Eigen::Isometry3d& to = body.object.pose;
  if (body.last_version == 0) return {to, to, body.center(), Eigen::Vector3d::Zero()};
  return {body.last_pose, to, body.center(), turnNearestTo(body.turned, body.last_pose.linear(), to.linear())};
}

ObjectMotion Scene::State::motionOf(ObjectId object) const
{
  return {legOf(object), bodies[object].box};
}

SceneResult Scene::State::query()
{
  const Effects& effects = options.effects;
  followPoints();
  if (usesSweptMotion(effects)) {
    std::vector<SweptMotion> swept_motions;
    for (const ObjectId object : moved) {
      const Leg leg = legOf(object);
      checkMotion(bodies[object], leg.from, leg.to, leg.turn, options.tolerance / 16);
      if (bodies[object].last_version > 0) swept_motions.push_back({object, leg});
    }
    const auto before = [](const SweptMotion& l, const SweptMotion& r) { return l.object < r.object; };
    std::sort(swept_motions.begin(), swept_motions.end(), before);
    result.swept_motions = std::move(swept_motions);
  }
  result.time = time;
  const bool of_near = effects.any || effects.flags || effects.contacts;
  if (of_near || effects.distance || usesSweptMotion(effects)) prepareGrid();
  if (of_near) findNear();
  if (effects.any) findAny();
  if (effects.flags) findFlags();
  if (effects.distance) findDistances();
  if (effects.contacts) findContacts();
  if (effects.first_contact) findFirstContacts();
  if (effects.swept) findSwept();
  if (effects.self) findSelf();
  if (!of_near) grid.dropParted(); // no list holds them
  for (const ObjectId object : moved_before) bodies[object].last_motion = 0.0;
  for (const ObjectId object : moved) {
    Body& body = bodies[object];
    body.last_motion =
        options.remember && body.last_version > 0 ? motionBound(body.box, body.last_pose, body.object.pose) : 0.0;
    body.last_pose = body.object.pose;
    body.last_version = body.version;
    body.turned.setZero();
    body.listed = false;
  }
  moved_before.swap(moved);
  moved.clear();
  SceneResult finished = std::move(result);
  result = SceneResult();
  return finished;
}

} // namespace pcl_bsh
