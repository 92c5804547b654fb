// SPDX-License-Identifier: BSD-3-Clause
// Something done in a process of its own, in which it may be killed.
#pragma once

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

namespace pcl_bsh::files {

/// @return whether it lived to the end; else it was killed. It must not throw
template <class Something>
bool endsInAFork(const Something& something)
{
  const pid_t id = fork();
  if (id == 0) {
    try {
      something();
    }
    catch (...) {
      _exit(1);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(id, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
  return WIFEXITED(status);
}

} // namespace pcl_bsh::files
