// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/check_scene.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/query/request_check.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

void refuse(const std::string& what)
{
  throw InvalidInput(Input::scene, "Scene", what);
}

bool isLength(double value)
{
  return std::isfinite(value) && value >= 0.0;
}

void check(const SceneOptions& options)
{
  const Effects& effects = options.effects;
  if (!isLength(options.clearance)) refuse("clearance " + plainText(options.clearance) + " is not finite and >= 0");
  if (!(std::isfinite(options.tolerance) && options.tolerance > 0.0))
    refuse("tolerance " + plainText(options.tolerance) + " is not finite and > 0");
  if (!isLength(options.accuracy.value))
    refuse("accuracy " + options.accuracy.text() + " has a number that is not finite and >= 0");
  if (!isLength(options.voxel_edge)) refuse("voxel edge " + plainText(options.voxel_edge) + " is not finite and >= 0");
  if (effects.distance && !(*effects.distance >= 0.0))
    refuse("distances within " + plainText(*effects.distance) + " were asked for, which is not >= 0");
  if (effects.gravity) {
    if (!(std::isfinite(effects.gravity->step_height) && effects.gravity->step_height > 0.0))
      refuse("step height " + plainText(effects.gravity->step_height) + " is not finite and > 0");
    if (!(effects.gravity->down.allFinite() && effects.gravity->down.norm() > 0.0))
      refuse("gravity's direction is not finite or of length 0");
  }
  if (effects.deform && !(std::isfinite(*effects.deform) && *effects.deform >= 1.0))
    refuse("deform's threshold " + plainText(*effects.deform) + " is not finite and >= 1");
}

void check(const SceneObject& object, const std::unordered_map<std::string, ObjectId>& names)
{
  if (object.name.empty()) refuse("an object has no name");
  if (names.count(object.name) > 0) refuse("object '" + object.name + "': the name is taken");
  if (object.parts.empty()) refuse("object '" + object.name + "' has no parts");
  checkPose("pose of object '" + object.name + "'", object.pose);
  for (const ScenePart& part : object.parts) {
    if (!part.hierarchy) refuse("object '" + object.name + "', part '" + part.name + "' has no hierarchy");
    if (part.solid && !part.hierarchy->view().triangles)
      refuse("object '" + object.name + "', part '" + part.name + "' is solid, but has no faces");
    checkPose("pose of part '" + part.name + "' of object '" + object.name + "'", part.pose);
  }
  for (const auto& [a, b] : object.adjacent)
    if (a >= object.parts.size() || b >= object.parts.size())
      refuse("object '" + object.name + "': part " + plainText(std::max(a, b)) + " is adjacent, but there are " +
             plainText(object.parts.size()) + " parts");
  check(object.motion);
}

} // namespace pcl_bsh
