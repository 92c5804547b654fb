// SPDX-License-Identifier: BSD-3-Clause
// One timed step of a program, which tells what it is doing when it takes more than a second.
#pragma once

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>

namespace pcl_bsh::cli {

/// On stderr, as PCL's tools do: "> Loading hall.pcd [done, 1512 ms : 5000000 points]". Nothing for a short step.
class Step {
public:
  explicit Step(const std::string& what)
  : line_("> " + what + " "),
    teller_([this](const std::stop_token& stop) { tell(stop); })
  {
  }

  /// A step that fails leaves its line to the error message.
  ~Step() { end("\n"); }

  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  /// How much of the step is done, from 0 to 1, where that is known; from any thread. How long the rest
  /// will take is told from it.
  void share(double done) { share_ = done; }

  /// @return seconds that the step took
  double done(const std::string& result)
  {
    const double seconds = elapsed();
    end("[done, " + std::to_string(static_cast<long>(seconds * 1000)) + " ms : " + result + "]\n");
    return seconds;
  }

private:
  double elapsed() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  void tell(const std::stop_token& stop)
  {
    const bool live = isatty(STDERR_FILENO) != 0;
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any stopped;
    while (true) {
      stopped.wait_for(lock, stop, std::chrono::seconds(1), [] { return false; });
      if (stop.stop_requested()) return;
      if (live || !told_) std::cerr << (told_ ? "\r" : "") << line_ << std::flush;
      told_ = true;
      if (live) std::cerr << "[" << static_cast<long>(elapsed()) << " s" << outlook() << "] \033[K" << std::flush;
    }
  }

  /// Nothing before the first hundredth is done: it would be a guess.
  std::string outlook() const
  {
    const double fraction = share_;
    if (fraction < 0.01) return "";
    const double left = elapsed() * (1 - fraction) / fraction;
    return ", " + std::to_string(static_cast<long>(100 * fraction)) + " %, about " +
           std::to_string(static_cast<long>(left) + 1) + " s left";
  }

  void end(const std::string& last)
  {
    if (!teller_.joinable()) return;
    teller_.request_stop();
    teller_.join();
    if (told_) std::cerr << last << std::flush;
  }

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::string line_;
  bool told_ = false; ///< of the teller until it is joined
  std::atomic<double> share_ = -1.0;
  std::jthread teller_;
};

} // namespace pcl_bsh::cli
