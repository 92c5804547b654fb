// SPDX-License-Identifier: BSD-3-Clause
// Robots of scene files: objects whose parts are links.
#pragma once

#include <pcl_bsh/io/scenes/scene_file.h>

#include <string>

namespace pcl_bsh::io {

/// Reads the robots of a scene's objects and makes a part of each link that has shapes, with a cloud of its own. Boxes,
/// cylinders and spheres are solid; the meshes of a link that has both are a part of their own. Boxes and meshes are
/// taken as they are. A round shape becomes a polyhedron that encloses it, and is nowhere more than
/// SceneOptions::tolerance outside it. Links move by straight lines in joint space from state to state, and rest before
/// the first and after the last.
/// @param package_path where `package://` leads, as readRobot() takes it
/// @throws JsonError, files::FileError and std::invalid_argument naming the file that is wrong: as readRobot() does,
///   for states that do not fit the robot or are out of its joints' limits, and for a robot without shapes
void addRobots(SceneFile& file, const std::string& package_path = {});

} // namespace pcl_bsh::io
