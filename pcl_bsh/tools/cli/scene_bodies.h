// SPDX-License-Identifier: BSD-3-Clause
// The bodies of a scene file. Programs that are linked to pcl_bsh::physics define PCL_BSH_PHYSICS.
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/scenes/scene_file.h>
#include <pcl_bsh/physics/scene_bodies.h>

#include <memory>
#include <stdexcept>

namespace pcl_bsh::cli {

/// Throws where a scene lists the effect bodies and this program cannot move any: before its clouds are read.
inline void requireBodies([[maybe_unused]] const io::SceneFile& file)
{
#ifndef PCL_BSH_PHYSICS
  if (file.bodies)
    throw std::invalid_argument(file.path.string() +
                                ": effects.bodies: this program was built without Bullet: install libbullet-dev and "
                                "build it again, or leave 'bodies' out");
#endif
}

/// The bodies of a scene; null where the scene does not list that effect.
inline std::unique_ptr<SceneBodies> bodiesOf(const io::SceneFile& file, [[maybe_unused]] Scene& scene)
{
  requireBodies(file);
  if (!file.bodies) return nullptr;
#ifdef PCL_BSH_PHYSICS
  std::vector<SceneBody> how;
  for (const io::ObjectEntry& object : file.objects) how.push_back(object.body);
  try {
    return makeSceneBodies(scene, *file.bodies, how);
  }
  catch (const InvalidInput& error) {
    throw std::invalid_argument(file.path.string() + ": " + error.what());
  }
#else
  return nullptr;
#endif
}

/// Moves the scene and its bodies on by `dt` seconds, and returns the effects. @param bodies may be null
inline BodiesStep stepOf(Scene& scene, SceneBodies* bodies, double dt)
{
  if (bodies) return bodies->step(dt);
  BodiesStep done;
  done.scene = scene.step(dt);
  return done;
}

} // namespace pcl_bsh::cli
