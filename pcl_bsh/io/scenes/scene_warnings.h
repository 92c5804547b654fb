// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/io/scenes/scene_file.h>
#include <pcl_bsh/question/named_cloud.h>

#include <map>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// What users should know of a scene whatever its results are, a line each: of its clouds, of the two of them whose
/// points lie farthest apart, and of objects that are nowhere near the others.
/// @param clouds by their names in the file: all that objects have
std::vector<std::string> warningsOf(const SceneFile& file, const std::map<std::string, NamedCloud>& clouds);

} // namespace pcl_bsh::io
