// SPDX-License-Identifier: BSD-3-Clause
// Every program tells its version.
#include "program_run.h"

#include <pcl_bsh/version.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

namespace pcl_bsh {
namespace {

TEST(Version, IsToldByEveryProgram)
{
  const std::set<std::string> samples = {"pcl_bsh_filter_chain",  "pcl_bsh_search_chain",
                                         "pcl_bsh_own_stage",     "pcl_bsh_demo",
                                         "pcl_bsh_resting_stone", "pcl_bsh_watch"}; // not installed
  std::size_t programs = 0;
  for (const auto& file : std::filesystem::directory_iterator(PCL_BSH_PROGRAM_DIR)) {
    const std::string name = file.path().filename().string();
    if (name.rfind("pcl_bsh_", 0) != 0 || !file.is_regular_file() || samples.count(name) > 0) continue;
    const Outcome outcome = run(name.c_str(), "--version");
    EXPECT_EQ(outcome.exit_code, 0) << name << ": " << outcome.err;
    EXPECT_EQ(outcome.out, name + " " PCL_BSH_VERSION_TEXT "\n");
    EXPECT_EQ(outcome.err, "");
    ++programs;
  }
  EXPECT_GE(programs, 4U);
}

} // namespace
} // namespace pcl_bsh
