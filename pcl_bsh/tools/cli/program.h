// SPDX-License-Identifier: BSD-3-Clause
// How every program ends: with what it did, or with one line that says what is wrong and what to do.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// A command line that cannot be understood. what() reads `option: what is wrong: what to do`.
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Writes each warning as a line on stderr.
void warn(const char* name, const std::vector<std::string>& warnings);

/// Prints remarks on a file, which do not name it.
void warnOfFile(const char* name, const std::filesystem::path& file, const std::vector<std::string>& remarks);

/// Runs `body` as a whole program, which stops cleanly when told to, and returns the exit code: what it returns; 1 when
/// it fails; 2 for a UsageError.
int runProgram(const char* name, const std::function<int()>& body);

/// Runs a program that parses its command line first.
/// @param parse gives its options; none when only help was asked for
template <class Parse, class Run>
int runProgram(const char* name, const Parse& parse, const Run& run, int argc, char** argv)
{
  return runProgram(name, [&] {
    const auto options = parse(argc, argv);
    return options ? run(*options) : 0;
  });
}

} // namespace pcl_bsh::cli
