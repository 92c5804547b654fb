// SPDX-License-Identifier: BSD-3-Clause
// How every program ends: with what it did, or with one line that says what is wrong and what to do.
#pragma once

#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>

namespace pcl_bsh::cli {

/// A command line that cannot be understood. what() reads `option: what is wrong: what to do`.
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Runs `body` and returns the exit code: what it returns; 1 when it fails; 2 for a UsageError.
template <typename Body>
int runProgram(const char* name, Body&& body)
{
  try {
    return body();
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
