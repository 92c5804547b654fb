// SPDX-License-Identifier: BSD-3-Clause
// Values of joints as users write them.
#pragma once

#include <pcl_bsh/robot/robot.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::io {

using robots::JointValues;

/// `name=value,...`; may be empty.
/// @throws io::FormatError naming a word of another form
JointValues parseJointValues(const std::string& text);

/// A table: the names of joints in its first line, then a line for each frame. Semicolons, commas, tabs or blanks
/// separate the values. Comments begin with # at the beginning of a line or behind a blank.
/// @throws files::FileError naming the line
std::vector<JointValues> readJointStates(const std::filesystem::path& path);

} // namespace pcl_bsh::io
