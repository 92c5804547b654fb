// SPDX-License-Identifier: BSD-3-Clause
// Parts that attacks on error bounds share: their starts, the instruction sets, and the report of their results.
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include "random.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace pcl_bsh::test {

inline void report(const std::string& what, double fraction)
{
  testing::Test::RecordProperty(what, std::to_string(fraction));
  std::printf("  %s: %.4f of the bound\n", what.c_str(), fraction);
  EXPECT_LE(fraction, 1.0) << what;
}

inline float floatOf(double x)
{
  return roundToFloat(std::clamp(x, -0x1p60, 0x1p60));
}

template <class Test>
void onEveryTarget(const Test& body)
{
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    body(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// 1 and a little, as where rounding costs most; or any number.
inline double suspect(Random& random, int least)
{
  const double x = random.chance(0.7) ? 1.0 + std::ldexp(random.uniform(-1, 1), -random.integer(1, 30))
                                      : std::ldexp(random.uniform(0.5, 1), -random.integer(0, least));
  return random.chance(0.5) ? x : -x;
}

} // namespace pcl_bsh::test
