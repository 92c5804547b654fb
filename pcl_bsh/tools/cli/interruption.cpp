// SPDX-License-Identifier: BSD-3-Clause
#include "interruption.h"

#include <pcl_bsh/io/files/unfinished.h>

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <iostream>
#include <mutex>
#include <thread>

namespace pcl_bsh::cli {

namespace {

std::mutex what_stays_mutex;
std::string what_stays = "nothing unfinished was left behind";

} // namespace

void setWhatStays(const std::string& what)
{
  const std::lock_guard lock(what_stays_mutex);
  what_stays = what;
}

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
    const std::lock_guard text_lock(what_stays_mutex);
    std::cerr << '\n' << program << ": stopped on request: " << what_stays << std::endl;
    _exit(128 + signal);
  }).detach();
}

void openStandardStreams()
{
  for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number) {
    // Writing to a standard output that was closed must fail.
    const int flags = number == STDOUT_FILENO ? O_RDONLY : O_RDWR;
    if (fcntl(number, F_GETFD) < 0) static_cast<void>(open("/dev/null", flags));
  }
}

} // namespace pcl_bsh::cli
