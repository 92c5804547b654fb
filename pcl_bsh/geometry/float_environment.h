// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cfenv>

namespace pcl_bsh {

/// While it lives, its thread computes in the default floating-point environment: round to nearest, denormals kept. The
/// caller's rounding mode, flush-to-zero and exception flags come back at the end. Our bounds and exact sums need that.
class DefaultFloatEnvironment {
public:
  DefaultFloatEnvironment() noexcept
  {
    std::fegetenv(&callers_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatEnvironment() { std::fesetenv(&callers_); }
  DefaultFloatEnvironment(const DefaultFloatEnvironment&) = delete;
  DefaultFloatEnvironment& operator=(const DefaultFloatEnvironment&) = delete;

private:
  std::fenv_t callers_;
};

} // namespace pcl_bsh
