// SPDX-License-Identifier: BSD-3-Clause
// Values of clashes that all lists share, from JSON and in words.
#pragma once

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/clashes/extent.h>
#include <pcl_bsh/io/json/json_reader.h>

#include <string>

namespace pcl_bsh::io {

/// nameOf() with spaces, for people.
std::string inWords(ClashStatus status);

// A point, a box with min and max, and a status, as reports have them. @throws JsonError
Point3 pointFrom(const JsonReader& reader);
Extent boxFrom(const JsonReader& box);
ClashStatus statusFrom(const JsonReader& status);

} // namespace pcl_bsh::io
