// SPDX-License-Identifier: BSD-3-Clause
// Helpers of all benchmarks: a stopwatch, medians, a memory peak, and tables that also become CSV.
#pragma once

#include <cstddef>
#include <ctime>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace pcl_bsh::bench {

class Stopwatch {
public:
  /// For the whole program. wall: what a user waits. cpu: what the process's threads spent on processors; on an idle
  /// machine the same for one thread, and the only comparable figure on a busy one.
  static void use(const std::string& clock) { clock_ = clock == "cpu" ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC; }

  static std::string name() { return clock_ == CLOCK_MONOTONIC ? "wall" : "cpu"; }

  double seconds() const { return now() - start_; }

private:
  static double now()
  {
    timespec time;
    clock_gettime(clock_, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  inline static clockid_t clock_ = CLOCK_MONOTONIC;
  double start_ = now();
};

/// The value at `fraction` of the sorted values (0.5: the median; the mean of the middle two when their number is
/// even). @throws std::invalid_argument when there are none.
double quantile(std::vector<double> values, double fraction);
inline double median(std::vector<double> values)
{
  return quantile(std::move(values), 0.5);
}

/// Calls task(begin, end) on `threads` equal parts of [0, count) at once.
template <typename Task>
void inParts(std::size_t count, unsigned threads, const Task& task)
{
  std::vector<std::thread> others;
  for (unsigned part = 1; part < threads; ++part)
    others.emplace_back([&, part] { task(count * part / threads, count * (part + 1) / threads); });
  task(0, count / threads);
  for (auto& thread : others) thread.join();
}

/// Highest resident memory of the process between construction and bytes(), above what it was at construction.
/// Linux only: /proc. Counts pages really touched, whoever allocated them.
class MemoryPeak {
public:
  MemoryPeak();
  std::size_t bytes() const;

private:
  std::size_t before_;
};

/// Minor page faults of the process so far: pages touched for the first time, of whatever size.
double minorFaults();

/// Rows of text under headings that carry their units; printed aligned, or written as CSV with the machine, the
/// compiler, the commit and the clock in front of each row.
class Table {
public:
  explicit Table(std::vector<std::string> headings) : headings_(std::move(headings)) {}

  /// One cell per heading. @throws std::invalid_argument for another number.
  void add(std::vector<std::string> row);

  void print() const;

  /// Replaces `file`. @throws std::runtime_error naming it when it cannot be written.
  void writeCsv(const std::string& file) const;

private:
  std::vector<std::string> headings_;
  std::vector<std::vector<std::string>> rows_;
};

/// `value` with so many significant digits, without an exponent where that is readable.
std::string text(double value, int digits = 3);

/// From now on large blocks come fresh from the kernel and go back to it at once, as in a program that runs once.
/// Otherwise memory that one racer frees would spare the next one its page faults.
void useFreshMemory();

/// The peers are compiled for AVX2 on x86-64. @throws std::runtime_error on a processor without.
void requireVectorUnits();

/// Says on stderr what is being measured, and how far it has come.
void progress(const std::string& line);

} // namespace pcl_bsh::bench
