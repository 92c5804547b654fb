// SPDX-License-Identifier: BSD-3-Clause
#include "explain.h"

#include <pcl_bsh/base/counted.h>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string>

namespace pcl_bsh::cli {
namespace {

/// Explains an effect, and what it needs.
const char* explanationOf(Effect effect)
{
  switch (effect) {
  case Effect::any:
    return "which pairs collide; grid over the scene, then spheres down to the first witness: builds only the "
           "voxels that it visits";
  case Effect::flags:
    return "which points collide; as any, then every voxel of a colliding pair that the other comes near";
  case Effect::distance:
    return "smallest distances; grid, then spheres around the nearest pairs";
  case Effect::contacts:
    return "the nearest colliding pairs of points with their normals; of colliding pairs only";
  case Effect::first_contact:
    return "when a pair first touches within a step; the grid holds the volumes swept in the step";
  case Effect::swept:
    return "which points touch anything between the poses of a step; the grid holds the volumes swept in the step";
  case Effect::self:
    return "parts of one object against each other; no grid";
  case Effect::stop:
    return "objects halt at their first contact; collects the points within reach of each moving object";
  case Effect::slide:
    return "objects slide along what they touch; collects the points within reach of each moving object";
  case Effect::gravity:
    return "objects follow the ground; collects points below each moving object, and above and ahead where it is "
           "blocked";
  case Effect::deform:
    return "points of objects move; their spheres are refitted in each step, and rebuilt when they grow loose";
  }
  return "";
}

constexpr auto bodies_explained =
    "objects with a 'body' fall, slide and rest, and what has a motion pushes them; a collider of each cloud, and in "
    "each solution the contacts of all pairs of which one is a body";

std::string clashesExplained(const io::SceneFile& file)
{
  const io::SceneClashes& clashes = *file.clashes;
  return "where objects come too near to '" + file.objects[clashes.of].name +
         "' at any step; poses are kept, and asked about together after the last step" +
         (clashes.between ? ", also of two other objects" : "") +
         (clashes.question.seen ? "; a tree of the scan's beams, and what they did not see of the objects" : "");
}

/// Whether nothing is computed.
bool isIdle(const io::SceneFile& file)
{
  return file.options.effects.none() && !file.bodies && !file.clashes;
}

std::size_t fixedObjects(const io::SceneFile& file)
{
  return static_cast<std::size_t>(std::count_if(file.objects.begin(), file.objects.end(),
                                                [](const io::ObjectEntry& object) { return object.fixed; }));
}

} // namespace

void explain(const io::SceneFile& file, std::ostream& out)
{
  const Effects& effects = file.options.effects;
  out << file.path.string() << ": " << counted(file.objects.size(), "object") << ", "
      << counted(file.clouds.size(), "cloud") << ", " << counted(file.steps, "step") << " of " << file.dt
      << " s\n\nEffects that are on:\n";
  for (std::size_t e = 0; e < kEffects; ++e) {
    const auto effect = static_cast<Effect>(e);
    if (effects.has(effect)) out << "  " << nameOf(effect) << ": " << explanationOf(effect) << '\n';
  }
  if (file.bodies) out << "  bodies: " << bodies_explained << '\n';
  if (file.clashes) out << "  clashes: " << clashesExplained(file) << '\n';
  if (!file.options.accuracy.isExact())
    out << "  accuracy of any, flags, distance" << (file.clashes ? ", clashes" : "")
        << " and self: " << file.options.accuracy.text() << '\n';
  for (const io::CloudSource& cloud : file.clouds)
    if (!cloud.uncertainty.isZero())
      out << "  points of cloud '" << cloud.name << "' may be elsewhere: each verdict about them takes two searches\n";
  if (isIdle(file)) out << "  none: objects move, nothing is tested and no voxel is built\n";
  out << "\nEffects that are off (no code runs for them, nothing is allocated or built):\n ";
  for (std::size_t e = 0; e < kEffects; ++e)
    if (!effects.has(static_cast<Effect>(e))) out << ' ' << nameOf(static_cast<Effect>(e));
  if (!file.bodies) out << " bodies";
  if (!file.clashes) out << " clashes";

  const bool pairs = effects.ofPairs();
  out << "\n\nWhat is built:\n  voxels of every cloud: points are sorted into them when the cloud is read\n";
  out << "  octree and spheres of a voxel: when an effect first visits it" << (isIdle(file) ? ", so never\n" : "\n");
  out << "  grid over the scene: " << (pairs ? "yes, " : "no, no effect asks for pairs of objects\n");
  if (pairs)
    out << "only objects that share one of its voxels are tested\n  pairs of the " << fixedObjects(file)
        << " fixed objects: not tested, unless a rule says so; " << file.rules.size() << " rules\n";
}

nlohmann::ordered_json explanationJson(const io::SceneFile& file)
{
  using Json = nlohmann::ordered_json;
  const Effects& effects = file.options.effects;
  Json json = {{"clouds", file.clouds.size()},
               {"uncertain_clouds", Json::array()},
               {"steps", file.steps},
               {"dt", file.dt},
               {"accuracy", file.options.accuracy.text()},
               {"effects", Json::object()},
               {"off", Json::array()}};
  for (const io::CloudSource& cloud : file.clouds)
    if (!cloud.uncertainty.isZero()) json["uncertain_clouds"].push_back(cloud.name);
  for (std::size_t e = 0; e < kEffects; ++e) {
    const auto effect = static_cast<Effect>(e);
    if (effects.has(effect))
      json["effects"][nameOf(effect)] = explanationOf(effect);
    else
      json["off"].push_back(nameOf(effect));
  }
  if (file.bodies)
    json["effects"]["bodies"] = bodies_explained;
  else
    json["off"].push_back("bodies");
  if (file.clashes)
    json["effects"]["clashes"] = clashesExplained(file);
  else
    json["off"].push_back("clashes");
  json["built"] = {{"voxels", true}, {"spheres", !isIdle(file)}, {"grid", effects.ofPairs()}};
  json["fixed_objects"] = fixedObjects(file);
  json["rules"] = file.rules.size();
  return json;
}

} // namespace pcl_bsh::cli
