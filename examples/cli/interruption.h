// SPDX-License-Identifier: BSD-3-Clause
// What may reach a program from outside at any moment.
#pragma once

#include <pcl_bsh/files/unfinished.h>

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <iostream>
#include <string>
#include <thread>

namespace pcl_bsh::cli {

/// From now on SIGINT, SIGTERM and, where it is not ignored, SIGHUP end the program at once, with one line on stderr
/// and exit code 128 + signal, as shells have it. Files are as they were or complete; temporary ones are removed. A
/// pipe whose reader has gone and a limit on the size of files are errors of writing, and end nothing. To be called
/// first, while there is one thread: a thread of its own waits for the signals, all others never see them.
inline void stopCleanlyWhenTold(const std::string& program)
{
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  struct sigaction hang_up = {};
  sigaction(SIGHUP, nullptr, &hang_up);
  if (hang_up.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP); // nohup ignores it
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([program, signals] {
    int signal = 0;
    sigwait(&signals, &signal);
    const auto lock = files::discardUnfinished();
    std::cerr << '\n' << program << ": stopped on request: nothing unfinished was left behind" << std::endl;
    _exit(128 + signal);
  }).detach();
}

/// A caller may have closed one of the three: what is opened next would take its number, and what is said its content.
inline void openStandardStreams()
{
  for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number) {
    if (fcntl(number, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDWR)); // gets the lowest number that is free
  }
}

} // namespace pcl_bsh::cli
