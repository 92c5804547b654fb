// SPDX-License-Identifier: BSD-3-Clause
// Scene files with robots. Programs that are linked to pcl_bsh_robots define PCL_BSH_ROBOTS.
#pragma once

#include <pcl_bsh/io/scenes/scene_file.h>

#ifdef PCL_BSH_ROBOTS
#include <pcl_bsh/io/robots/ros_packages.h>
#include <pcl_bsh/io/robots/scene_robots.h>
#endif

#include <filesystem>
#include <stdexcept>

namespace pcl_bsh::cli {

/// Reads a scene and its robots. Throws where it has a robot and this program was built without them.
inline io::SceneFile readScene(const std::filesystem::path& path)
{
  io::SceneFile file = io::readSceneFile(path);
#ifdef PCL_BSH_ROBOTS
  io::addRobots(file, io::packagePath());
#else
  for (const io::ObjectEntry& object : file.objects)
    if (object.robot)
      throw std::invalid_argument(path.string() + ": " + object.robot->place +
                                  ": this program was built without urdfdom: install liburdfdom-dev, "
                                  "libconsole-bridge-dev and libpugixml-dev and build it again, or leave 'robot' out");
#endif
  return file;
}

} // namespace pcl_bsh::cli
