// SPDX-License-Identifier: BSD-3-Clause
#include "program.h"

#include "interruption.h"

#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

namespace pcl_bsh::cli {
namespace {

/// Throws where standard output could not be written: a full disk must not pass for success.
void requireOutputWritten()
{
  std::cout.flush();
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
  if (failed)
    throw std::runtime_error("standard output: cannot be written: choose a disk with room, or a reader that stays");
}

} // namespace

void warn(const char* name, const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings) std::cerr << name << ": warning: " << warning << '\n';
}

void warnOfFile(const char* name, const std::filesystem::path& file, const std::vector<std::string>& remarks)
{
  for (const std::string& remark : remarks) warn(name, {file.string() + ": " + remark});
}

int runProgram(const char* name, const std::function<int()>& body)
{
  openStandardStreams();
  stopCleanlyOnSignals(name);
  try {
    const int code = body();
    requireOutputWritten();
    return code;
  }
  catch (const UsageError& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return 2;
  }
  catch (const std::bad_alloc&) {
    std::cerr << name << ": memory: there is too little of it: give smaller clouds or a larger machine\n";
  }
  catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
  }
  return 1;
}

} // namespace pcl_bsh::cli
