// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "view_content.h"

namespace pcl_bsh::viewer {

/// A scene file's objects, seen at any of its steps. @throws io::JsonError, files::FileError naming the file,
/// cli::UsageError for a step that the scene does not have
std::unique_ptr<ViewContent> makeSceneContent(const Options& options);

} // namespace pcl_bsh::viewer
