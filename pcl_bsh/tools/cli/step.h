// SPDX-License-Identifier: BSD-3-Clause
// One timed step of a program, which reports its progress when it takes more than a second.
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

namespace pcl_bsh::cli {

/// On stderr, as PCL's tools do: "> Loading hall.pcd [done, 1512 ms : 5000000 points]". Nothing for a short step.
class Step {
public:
  explicit Step(const std::string& what);

  /// A step that fails ends its line, so that the error message has its own.
  ~Step();

  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  /// How much of the step is done, from 0 to 1, where that is known; from any thread. The time left is estimated from
  /// it. @return true, as a query's progress goes on
  bool share(double done)
  {
    share_ = done;
    return true;
  }

  /// Ends the step. @return seconds that it took
  double done(const std::string& result);

private:
  double elapsed() const;
  void report(const std::stop_token& stop);
  std::string timeLeft() const;
  void end(const std::string& last);

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::string line_;
  bool reported_ = false; ///< written by the reporter until it is joined
  std::atomic<double> share_ = -1.0;
  std::jthread reporter_;
};

} // namespace pcl_bsh::cli
