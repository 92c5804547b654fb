// SPDX-License-Identifier: BSD-3-Clause
// An object of a scene that is a robot, from its document.
#pragma once

#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/scenes/scene_file.h>

namespace pcl_bsh::io {

/// @param object with the key 'robot'. @param file has its path, time step and effects already
/// @throws JsonError where keys of the object, or effects, do not go with a robot
RobotEntry robotFrom(const JsonReader& object, const SceneFile& file);

} // namespace pcl_bsh::io
