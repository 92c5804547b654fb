// SPDX-License-Identifier: BSD-3-Clause
// A program of the project as a process that a test can limit, hold up and end.
#pragma once

#include "support/temporary_folder.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {

class Process {
public:
  /// @param prepare called in the new process before the program begins; in it, only what the system offers
  Process(const std::string& program, const std::vector<std::string>& arguments, const std::filesystem::path& place,
          const std::function<void()>& prepare = nullptr)
  {
    int told[2];
    if (pipe2(told, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    const std::string path = std::string(PCL_BSH_PROGRAM_DIR) + "/" + program;
    std::vector<char*> argv = {const_cast<char*>(path.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    id_ = fork();
    if (id_ == 0) {
      const int nowhere = open("/dev/null", O_RDWR);
      dup2(nowhere, STDIN_FILENO);
      dup2(nowhere, STDOUT_FILENO);
      dup2(told[1], STDERR_FILENO);
      if (chdir(place.c_str()) != 0) _exit(126);
      if (prepare) prepare();
      execv(path.c_str(), argv.data());
      _exit(127);
    }
    close(told[1]);
    told_ = told[0];
  }
  ~Process()
  {
    if (id_ > 0) {
      ::kill(id_, SIGKILL);
      waitpid(id_, nullptr, 0);
    }
    close(told_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const { ::kill(id_, signal); }

  bool hasEnded() const
  {
    siginfo_t status = {};
    return waitid(P_PID, static_cast<id_t>(id_), &status, WEXITED | WNOHANG | WNOWAIT) == 0 && status.si_pid == id_;
  }

  /// Waits for the end. @return the exit code, or minus the signal that ended it
  int end()
  {
    char bytes[4096];
    for (ssize_t count; (count = read(told_, bytes, sizeof bytes)) > 0;)
      err_.append(bytes, static_cast<std::size_t>(count));
    int status = 0;
    waitpid(std::exchange(id_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  /// After end(): what it said on stderr.
  const std::string& err() const { return err_; }

private:
  pid_t id_ = 0;
  int told_ = -1;
  std::string err_;
};

} // namespace pcl_bsh
