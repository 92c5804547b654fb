// SPDX-License-Identifier: BSD-3-Clause
// Numbers that often follow each other, in few bytes: which bins the points of a cloud go to, in the order of the
// cloud; and which records a voxel has.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pcl_bsh {

inline constexpr std::uint32_t kNoBin = 0x7fffffffu;

/// Points that follow each other in the cloud.
struct Run {
  std::uint32_t number; ///< their bin, kNoBin if they are not finite; or their first record
  std::uint32_t points;

  /// How many numbers it is stored as.
  std::uint32_t words() const { return points == 1 ? 1 : 2; }
};

/// Stores runs as numbers: twice the run's number for a single point, one more than that and the number of points for
/// others. Takes at most one number a point.
class RunWriter {
public:
  explicit RunWriter(std::uint32_t* next) : next_(next) {}

  void operator()(const Run& run)
  {
    *next_++ = run.number << 1 | (run.points == 1 ? 0u : 1u);
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

/// Calls visit(run) for each run of consecutive numbers among recordOf(i), begin <= i < end.
template <class RecordOf, class Visit>
void eachRun(std::size_t begin, std::size_t end, const RecordOf& recordOf, Visit&& visit)
{
  while (begin < end) {
    const std::uint32_t first = recordOf(begin);
    std::uint32_t points = 1;
    while (begin + points < end && recordOf(begin + points) == first + points) ++points;
    visit(Run{first, points});
    begin += points;
  }
}

/// Calls visit(record) for the `count` records that are stored as runs.
template <class Visit>
void eachRecord(const std::uint32_t* runs, std::uint32_t count, Visit&& visit)
{
  RunReader read(runs);
  while (count > 0) {
    const Run run = read();
    for (std::uint32_t i = 0; i < run.points; ++i) visit(run.number + i);
    count -= run.points;
  }
}

} // namespace pcl_bsh
