// SPDX-License-Identifier: BSD-3-Clause
#include "shared_counter.h"

#include <pcl_bsh/site/ask_site.h>

namespace pcl_bsh::site {

SharedCounter::SharedCounter() : is_alone_(ranks() == 1)
{
  if (is_alone_) return;
  // Memory that MPI allocates is shared within a machine, so that the first rank need not stop to answer. DIY's window
  // is of memory of its own: there the others wait until the first rank has done its tile.
  const bool has_counter = rankHere() == 0;
  MPI_Win_allocate(has_counter ? sizeof(std::uint64_t) : 0, sizeof(std::uint64_t), MPI_INFO_NULL, MPI_COMM_WORLD,
                   &counter_, &window_);
  if (has_counter) *counter_ = 0;
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Win_lock_all(MPI_MODE_NOCHECK, window_);
}

SharedCounter::~SharedCounter()
{
  if (is_alone_) return;
  MPI_Win_unlock_all(window_);
  MPI_Win_free(&window_);
}

std::uint64_t SharedCounter::taken(std::uint64_t count)
{
  std::uint64_t before = own_counter_;
  own_counter_ += count;
  if (is_alone_) return before;
  MPI_Fetch_and_op(&count, &before, MPI_UINT64_T, 0, 0, MPI_SUM, window_);
  MPI_Win_flush(0, window_);
  return before;
}

} // namespace pcl_bsh::site
