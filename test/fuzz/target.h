// SPDX-License-Identifier: BSD-3-Clause
// The interface of every fuzz target: one function over any bytes. libFuzzer calls it, and so does replay.cpp without
// clang.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace pcl_bsh::fuzz {

/// The project did what it must never do: a wrong answer, or a refusal without a reason.
class Finding : public std::logic_error {
public:
  using std::logic_error::logic_error;
};

inline void require(bool holds, const char* what)
{
  if (!holds) throw Finding(what);
}

} // namespace pcl_bsh::fuzz

/// libFuzzer's name for it. @return 0; whatever it throws is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
