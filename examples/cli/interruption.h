// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C, at any moment of a program that writes files.
#pragma once

#include <pcl_bsh/filters/io/replace_file.h>

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <iostream>
#include <string>
#include <thread>

namespace pcl_bsh::cli {

/// From now on SIGINT and SIGTERM end the program at once, with one line on stderr and exit code 128 + signal, as
/// shells have it. Files are as they were or complete; temporary ones are removed. To be called first, while there is
/// one thread: a thread of its own waits for the signals, all others never see them.
inline void stopCleanlyWhenTold(const std::string& program)
{
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([program, signals] {
    int signal = 0;
    sigwait(&signals, &signal);
    const auto lock = io::discardUnfinishedFiles();
    std::cerr << '\n' << program << ": stopped on request: nothing unfinished was left behind" << std::endl;
    _exit(128 + signal);
  }).detach();
}

} // namespace pcl_bsh::cli
