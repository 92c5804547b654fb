// SPDX-License-Identifier: BSD-3-Clause
// Checks of a scene: they throw for objects, rules and options that it refuses.
#pragma once

#include <pcl_bsh/scene/scene.h>

#include <string>
#include <unordered_map>

namespace pcl_bsh {

/// @throws InvalidInput, of the scene
[[noreturn]] void refuse(const std::string& what);

/// Whether it is finite and >= 0.
bool isLength(double value);

void check(const SceneOptions& options);
void check(const SceneObject& object, const std::unordered_map<std::string, ObjectId>& names);

} // namespace pcl_bsh
