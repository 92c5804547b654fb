// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <ctime>

namespace pcl_bsh::accuracy {

/// Seconds since it was made. A query on one thread is measured in this thread's processor time, which other programs
/// on the machine do not lengthen.
class Stopwatch {
public:
  explicit Stopwatch(unsigned threads) : one_thread_(threads == 1), start_(now()) {}

  double seconds() const { return now() - start_; }

private:
  double now() const
  {
    if (!one_thread_) return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    std::timespec time = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  bool one_thread_;
  double start_;
};

} // namespace pcl_bsh::accuracy
