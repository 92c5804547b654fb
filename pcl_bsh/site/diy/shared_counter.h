// SPDX-License-Identifier: BSD-3-Clause
// Numbers that are dealt to the ranks of an MPI job, to each when it asks: those that are slow get fewer.
#pragma once

#include <mpi.h>

#include <cstdint>

namespace pcl_bsh::site {

class SharedCounter {
public:
  /// To be called by all ranks, as the destructor.
  SharedCounter();
  ~SharedCounter();
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;

  /// Each number once, from 0, to whichever rank asks.
  std::uint64_t next() { return taken(1); }

  /// Lets no rank have any of so many numbers that is not dealt yet.
  void end(std::uint64_t numbers) { taken(numbers); }

private:
  std::uint64_t taken(std::uint64_t count);

  bool is_alone_;
  std::uint64_t* counter_ = nullptr; ///< on the first rank
  MPI_Win window_ = MPI_WIN_NULL;
  std::uint64_t own_counter_ = 0; ///< where there is one rank
};

} // namespace pcl_bsh::site
