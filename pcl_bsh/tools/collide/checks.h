// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options.h"

namespace pcl_bsh::cli {

/// Checks all that can be checked before the first cloud is loaded.
/// @throws std::invalid_argument, UsageError or files::FileError naming the option and the value
void check(const CollideOptions& options);

} // namespace pcl_bsh::cli
