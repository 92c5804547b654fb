// SPDX-License-Identifier: BSD-3-Clause
// What may be given up for time, as users write it.
#pragma once

#include <pcl_bsh/query/accuracy.h>

#include <string>

namespace pcl_bsh::cli {

/// @throws UsageError quoting the text when it is no accuracy
Accuracy parseAccuracy(const std::string& text);

/// What is asked beside flags.
struct AccuracyNeeds {
  bool clashes = false, swept = false, distances = false;
};

/// @throws UsageError for an accuracy that cannot answer these
void requireAnswers(const Accuracy& accuracy, const AccuracyNeeds& needs);

} // namespace pcl_bsh::cli
