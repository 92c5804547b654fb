// SPDX-License-Identifier: BSD-3-Clause
#include "interruption.h"

#include <pcl_bsh/files/unfinished.h>

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <iostream>
#include <thread>

namespace pcl_bsh::cli {

void stopCleanlyOnSignals(const std::string& program)
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

void openStandardStreams()
{
  for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number) {
    if (fcntl(number, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDWR)); // gets the lowest number that is free
  }
}

} // namespace pcl_bsh::cli
