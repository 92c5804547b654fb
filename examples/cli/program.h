// SPDX-License-Identifier: BSD-3-Clause
// How every program ends: with what it did, or with one line that says what is wrong and what to do.
#pragma once

#include "interruption.h"

#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// A command line that cannot be understood. what() reads `option: what is wrong: what to do`.
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A line each on stderr.
inline void warn(const char* name, const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings) std::cerr << name << ": warning: " << warning << '\n';
}

/// What was said may be what the user wants: a full disk must not pass for success.
inline void requireAllSaid()
{
  std::cout.flush();
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
  if (failed)
    throw std::runtime_error("standard output: cannot be written: choose a disk with room, or a reader that stays");
}

/// Runs `body` as a whole program, which stops cleanly when told to, and returns the exit code: what it returns; 1 when
/// it fails; 2 for a UsageError.
template <typename Body>
int runProgram(const char* name, Body&& body)
{
  openStandardStreams();
  stopCleanlyWhenTold(name);
  try {
    const int code = body();
    requireAllSaid();
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
