// SPDX-License-Identifier: BSD-3-Clause
// Where the points of a cloud go, in the order of the cloud, in few bytes.
#pragma once

#include <cstdint>

namespace pcl_bsh {

inline constexpr std::uint32_t kNoBin = 0x7fffffffu;

/// Points that follow each other in the cloud, all in the same bin.
struct Run {
  std::uint32_t bin; ///< kNoBin: not finite
  std::uint32_t points;
};

/// Stores runs as numbers: twice the bin's number for a single point, one more than that and the number of points for
/// others. Takes at most one number a point.
class RunWriter {
public:
  explicit RunWriter(std::uint32_t* next) : next_(next) {}

  void operator()(const Run& run)
  {
    *next_++ = run.bin << 1 | (run.points == 1 ? 0u : 1u);
    if (run.points != 1) *next_++ = run.points;
  }

private:
  std::uint32_t* next_;
};

class RunReader {
public:
  explicit RunReader(const std::uint32_t* next) : next_(next) {}

  Run operator()()
  {
    const std::uint32_t head = *next_++;
    return {head >> 1, (head & 1) == 0 ? 1u : *next_++};
  }

private:
  const std::uint32_t* next_;
};

} // namespace pcl_bsh
