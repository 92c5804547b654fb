// SPDX-License-Identifier: BSD-3-Clause
// Certificates as a table for people and as JSON for programs.
#pragma once

#include <pcl_bsh/certify/certify.h>

#include <nlohmann/json.hpp>

#include <iosfwd>
#include <string>

namespace pcl_bsh::cli {

/// "cloud 2", "voxel" or "node 3".
std::string nameOf(const SphereLevel& level);

nlohmann::ordered_json toJson(const Certificate& certificate);

void printTableHead(std::ostream& out);

/// A row for each level, and one for all.
void printRows(std::ostream& out, const std::string& fit, const Certificate& certificate);

} // namespace pcl_bsh::cli
