// SPDX-License-Identifier: BSD-3-Clause
// Parts that the benchmark programs share: two options, the error line, the exit code.
#pragma once

#include "harness.h"

#include <CLI/CLI.hpp>

#include <exception>
#include <iostream>

namespace pcl_bsh::bench {

struct ProgramOptions {
  std::string clock = "wall";
  std::string csv;
  unsigned repeat = 3;
};

/// Parses, calls `run` (bool(Table&): were all answers right?), prints the table and writes the CSV. The exit code: 0;
/// 1 after an error or a wrong answer; 2 after a wrong option.
template <typename Run>
int runProgram(CLI::App& app, int argc, char** argv, ProgramOptions& options, Table table, const Run& run)
{
  app.add_option("--repeat", options.repeat, "repetitions; medians are printed")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--clock", options.clock,
                 "wall: what a user waits; cpu: processor time of all threads, for busy machines")
      ->check(CLI::IsMember({"wall", "cpu"}))
      ->capture_default_str();
  app.add_option("--csv", options.csv, "also write the table here");
  try {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    requireVectorUnits();
    useFreshMemory();
    Stopwatch::use(options.clock);
    const bool right = run(table);
    table.print();
    if (!options.csv.empty()) table.writeCsv(options.csv);
    if (!right) std::cerr << app.get_name() << ": racers disagree beyond rounding: see the column 'wrong'\n";
    return right ? 0 : 1;
  }
  catch (const std::exception& error) {
    std::cerr << app.get_name() << ": " << error.what() << '\n';
    return 1;
  }
}

} // namespace pcl_bsh::bench
