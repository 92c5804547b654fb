// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cfenv>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace pcl_bsh {

/// While it lives, its thread computes in the default floating-point environment: round to nearest, denormals kept. The
/// caller's rounding mode, flush-to-zero and exception flags come back at the end. Our bounds and exact sums need that.
#if defined(__x86_64__)
/// Here one register holds all of that, and it nearly always holds the default already. A query of a few hundred
/// nanoseconds must not pay for saving the whole environment.
class DefaultFloatEnvironment {
public:
  DefaultFloatEnvironment() noexcept : callers_(_mm_getcsr())
  {
    if ((callers_ & ~kFlags) != kDefault) _mm_setcsr(kDefault);
  }
  ~DefaultFloatEnvironment()
  {
    if (_mm_getcsr() != callers_) _mm_setcsr(callers_);
  }
  DefaultFloatEnvironment(const DefaultFloatEnvironment&) = delete;
  DefaultFloatEnvironment& operator=(const DefaultFloatEnvironment&) = delete;

private:
  static constexpr unsigned kFlags = 0x3f;     // of exceptions that have occurred
  static constexpr unsigned kDefault = 0x1f80; // all exceptions masked, nothing else set

  unsigned callers_;
};
#else
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
#endif

} // namespace pcl_bsh
