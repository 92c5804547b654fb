// SPDX-License-Identifier: BSD-3-Clause
// Names of stages, and the files that they read and write.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_type.h>

#include <string>
#include <vector>

namespace pcl_bsh::pipeline {

/// All names and aliases of stages, for errors about an unknown one.
std::vector<std::string> typeNames();

/// Returns the reader or writer that files of this name stand for; null where no stage does.
const StageType* typeOfFile(const std::string& file, bool written);

/// The extensions that stages read or write, with blanks between.
std::string knownExtensions(bool written);

} // namespace pcl_bsh::pipeline
