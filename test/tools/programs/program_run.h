// SPDX-License-Identifier: BSD-3-Clause
// Runs a program of the project and keeps all that it says.
#pragma once

#include "io/clouds/samples.h"

#include <sys/wait.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace pcl_bsh {

struct ProgramOutcome {
  int exit_code = -1;
  std::string out;
  std::string err;

  /// Standard error without lines of progress: whether there are any depends on the machine.
  std::string told() const
  {
    std::istringstream lines(err);
    std::string all;
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with("> ")) all += line + '\n';
    return all;
  }
};
using Outcome = ProgramOutcome; // a scene's move has an Outcome, too

/// Commands of the shell. @param place the folder to run in; empty: this one
inline Outcome runCommands(const std::string& commands, const std::filesystem::path& place = {})
{
  const io::TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const std::string err = (folder / "err").string();
  const std::string command =
      (place.empty() ? "" : "cd " + place.string() + " && ") + "{ " + commands + "\n} >" + out + " 2>" + err;
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, io::contentOf(out), io::contentOf(err)};
}

/// In the shell, so quote what it would change.
inline Outcome run(const std::string& program, const std::string& arguments, const std::filesystem::path& place = {})
{
  return runCommands(PCL_BSH_PROGRAM_DIR "/" + program + " " + arguments, place);
}

} // namespace pcl_bsh
