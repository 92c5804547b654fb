// SPDX-License-Identifier: BSD-3-Clause
// A study for programs (CSV, JSON), as text (Markdown) and as a picture (PNG).
#pragma once

#include "study.h"

#include <filesystem>

namespace pcl_bsh::accuracy {

/// Writes accuracy.csv, accuracy.json, accuracy.md and accuracy.png into a folder that exists.
/// @param heading what was compared, one line
/// @throws std::exception naming the file that cannot be written
void writeReports(const std::filesystem::path& folder, const std::string& heading, const Subject& subject,
                  const Study& study);

/// Settings to choose: the knee of the certified distance curve, and the best settings for 1 ms, 10 ms and exact.
std::string advice(const Subject& subject, const Study& study);

} // namespace pcl_bsh::accuracy
