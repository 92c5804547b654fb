// SPDX-License-Identifier: BSD-3-Clause
// The version of pcl_bsh, which CMake reads from here.
#pragma once

/// Before 1.0, a new minor version may change interfaces and layouts: libraries are named after both numbers, as are
/// the versions of their symbols, so that two of them can be in one process.
#define PCL_BSH_VERSION_MAJOR 0
#define PCL_BSH_VERSION_MINOR 2
#define PCL_BSH_VERSION_PATCH 0

/// One number to compare with: 100 is 0.1.0.
#define PCL_BSH_VERSION (10000 * PCL_BSH_VERSION_MAJOR + 100 * PCL_BSH_VERSION_MINOR + PCL_BSH_VERSION_PATCH)

/// "0.1.0".
#define PCL_BSH_VERSION_TEXT PCL_BSH_VERSION_JOINED(PCL_BSH_VERSION_MAJOR, PCL_BSH_VERSION_MINOR, PCL_BSH_VERSION_PATCH)
#define PCL_BSH_VERSION_JOINED(major, minor, patch) PCL_BSH_VERSION_QUOTED(major.minor.patch)
#define PCL_BSH_VERSION_QUOTED(text) #text
