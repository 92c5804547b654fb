// SPDX-License-Identifier: BSD-3-Clause
#include "step.h"

#include <unistd.h>

#include <condition_variable>
#include <iostream>
#include <mutex>

namespace pcl_bsh::cli {

Step::Step(const std::string& what)
: line_("> " + what + " "),
  reporter_([this](const std::stop_token& stop) { report(stop); })
{
}

Step::~Step()
{
  end("\n");
}

double Step::done(const std::string& result)
{
  const double seconds = elapsed();
  end("[done, " + std::to_string(static_cast<long>(seconds * 1000)) + " ms : " + result + "]\n");
  return seconds;
}

double Step::elapsed() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Step::report(const std::stop_token& stop)
{
  const bool live = isatty(STDERR_FILENO) != 0;
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any stopped;
  while (true) {
    stopped.wait_for(lock, stop, std::chrono::seconds(1), [] { return false; });
    if (stop.stop_requested()) return;
    if (live || !reported_) std::cerr << (reported_ ? "\r" : "") << line_ << std::flush;
    reported_ = true;
    if (live) std::cerr << "[" << static_cast<long>(elapsed()) << " s" << timeLeft() << "] \033[K" << std::flush;
  }
}

/// Nothing before the first hundredth is done: it would be a guess.
std::string Step::timeLeft() const
{
  const double fraction = share_;
  if (fraction < 0.01) return "";
  const double left = elapsed() * (1 - fraction) / fraction;
  return ", " + std::to_string(static_cast<long>(100 * fraction)) + " %, about " +
         std::to_string(static_cast<long>(left) + 1) + " s left";
}

void Step::end(const std::string& last)
{
  if (!reporter_.joinable()) return;
  reporter_.request_stop();
  reporter_.join();
  if (reported_) std::cerr << last << std::flush;
}

} // namespace pcl_bsh::cli
