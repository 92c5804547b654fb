// SPDX-License-Identifier: BSD-3-Clause
// Where a ROS package lies, by the environment variable ROS_PACKAGE_PATH.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

/// The folder of a package in or below one of these folders, the first that has it. A package is a folder with a
/// package.xml that names it, or with a manifest.xml and its name. Nothing is looked for in a package, in a hidden
/// folder, or below a file CATKIN_IGNORE or rospack_nosubdirs. Where no package has the name, a folder of that name in
/// one of the folders, or one of these themselves, stands for it. Folders that cannot be read are left out.
/// @param folders with colons between them, as ROS_PACKAGE_PATH has them
std::optional<std::filesystem::path> packageIn(std::string_view folders, const std::string& name);

/// ROS_PACKAGE_PATH as the environment has it; empty where it has none.
std::string packagePath();

} // namespace pcl_bsh::io
