// SPDX-License-Identifier: BSD-3-Clause
#include "accuracy.h"

#include "program.h"

#include <pcl_bsh/base/invalid_input.h>

namespace pcl_bsh::cli {

Accuracy parseAccuracy(const std::string& text)
{
  try {
    return Accuracy::parse(text);
  }
  catch (const InvalidInput& error) {
    throw UsageError("--accuracy: " + error.advice());
  }
}

void requireAnswers(const Accuracy& accuracy, const AccuracyNeeds& needs)
{
  const auto refuse = [&](const char* wrong) { throw UsageError("--accuracy: " + accuracy.text() + ": " + wrong); };
  if (accuracy.stopsEarly() && needs.clashes) refuse("clashes need distances: give exact or tolerance=LENGTH");
  if (!accuracy.isExact() && needs.swept) refuse("swept motion has a tolerance of its own: give exact");
  if (accuracy.stopsEarly() && needs.distances)
    refuse("leaves points without a distance: give exact or tolerance=LENGTH");
}

} // namespace pcl_bsh::cli
