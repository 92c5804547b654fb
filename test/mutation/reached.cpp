// SPDX-License-Identifier: BSD-3-Clause
// Linked into tests of mutated sources: writes down, for each test, its processor time in milliseconds and the mutants
// that it reached, a line each, to the file that PCL_BSH_REACHED names.
#include "mutant.h"

#include <gtest/gtest.h>

#include <cstring>
#include <ctime>
#include <fstream>

namespace {

class Reached : public testing::EmptyTestEventListener {
public:
  explicit Reached(const char* file) : out_(file, std::ios::app) {}

  /// Mutants reached before the first test count for each: all tests depend on them.
  void OnTestProgramStart(const testing::UnitTest&) override
  {
    std::memcpy(always_, pcl_bsh_reached_mutants, sizeof always_);
  }

  void OnTestStart(const testing::TestInfo&) override
  {
    std::memset(pcl_bsh_reached_mutants, 0, sizeof pcl_bsh_reached_mutants);
    begin_ = std::clock();
  }

  void OnTestEnd(const testing::TestInfo& test) override
  {
    const double seconds = static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC;
    out_ << test.test_suite_name() << '.' << test.name() << ' ' << static_cast<long>(1000 * seconds) << ' '
         << (test.result()->Failed() ? "failed" : "passed");
    for (int number = 1; number < kMostMutants; ++number)
      if (pcl_bsh_reached_mutants[number] || always_[number]) out_ << ' ' << number;
    out_ << std::endl;
  }

private:
  std::ofstream out_;
  unsigned char always_[kMostMutants] = {};
  std::clock_t begin_ = 0;
};

[[maybe_unused]] const bool kAdded = [] {
  if (const char* const file = std::getenv("PCL_BSH_REACHED"))
    testing::UnitTest::GetInstance()->listeners().Append(new Reached(file));
  return true;
}();

} // namespace
