// SPDX-License-Identifier: BSD-3-Clause
// Symbols that the libraries export: all that their public headers declare, and nothing else.
#pragma once

/// Around the declarations of a public header, below its includes: compiled hidden by default, these are exported.
#define PCL_BSH_EXPORT_BEGIN _Pragma("GCC visibility push(default)")
/// The end of these.
#define PCL_BSH_EXPORT_END _Pragma("GCC visibility pop")

/// For one declaration alone: explicit instantiations for types of others, whose headers are compiled hidden too.
#define PCL_BSH_EXPORT __attribute__((visibility("default")))

/// For what no public header declares, but another library or a test of this project calls. Not part of the interface.
#define PCL_BSH_EXPORT_INTERNAL __attribute__((visibility("default")))
