// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/scenes/robot_entry.h>

#include <pcl_bsh/io/scenes/scene_clouds.h>

#include <string>

namespace pcl_bsh::io {
namespace {

/// Refuses effects of motion and responses: they need straight motion within a step, and links move otherwise.
void requireNoMotion(const JsonReader& robot, const SceneFile& file)
{
  for (const Effect effect : {Effect::first_contact, Effect::swept, Effect::stop, Effect::slide, Effect::gravity})
    if (file.options.effects.has(effect))
      robot.fail(std::string("does not go with the effect '") + nameOf(effect) + "'",
                 "leave one out; pcl_bsh_arm --motions certifies the motions of a robot");
  if (file.bodies) robot.fail("does not go with the effect 'bodies'", "leave one out");
}

} // namespace

RobotEntry robotFrom(const JsonReader& object, const SceneFile& file)
{
  const JsonReader reader = object.at("robot");
  for (const char* key : {"fixed", "adjacent", "wave"})
    if (object.has(key)) object.at(key).fail("does not go with 'robot'", "leave one out");
  requireNoMotion(reader, file);
  const std::filesystem::path folder = file.path.parent_path();
  RobotEntry robot;
  robot.place = reader.place();
  robot.urdf = existingFile(reader.at("urdf"), folder);
  if (reader.has("srdf")) robot.srdf = existingFile(reader.at("srdf"), folder);
  if (reader.has("states")) robot.states = existingFile(reader.at("states"), folder);
  robot.interval = file.dt;
  read(reader, "interval", robot.interval);
  if (reader.has("packages"))
    for (const auto& [name, given] : reader.at("packages").members()) robot.packages[name] = folder / given.text();
  return robot;
}

} // namespace pcl_bsh::io
