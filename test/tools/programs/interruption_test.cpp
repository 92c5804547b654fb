// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C, and what a system says when it shuts down.
#include "jobs.h"
#include <pcl_bsh/tools/cli/interruption.h>

#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <gmock/gmock.h>

#include <sys/stat.h>

#include <algorithm>
#include <chrono>

namespace pcl_bsh {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;

/// The jobs, each held up by an input that does not come: a pipe without a writer.
class Interruption : public testing::TestWithParam<Job> {};

/// Waits until the process opens the pipe, from which it then waits for bytes.
void waitUntilHeldUp(const Process& program, const fs::path& pipe)
{
  while (!program.hasEnded()) {
    const int writer = open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC); // fails until there is a reader
    if (writer >= 0) return;                                                  // kept open: the pipe does not end
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ADD_FAILURE() << "the pipe is never read";
}

TEST_P(Interruption, LeavesNothingBehind)
{
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const files::TemporaryFolder folder;
    prepareJobs(folder);
    Job job = GetParam();
    for (std::string& argument : job.arguments) {
      if (argument == "scan.xyz") argument = "pipe.xyz";
    }
    if (job.program == "pcl_bsh_pipeline") job.arguments[0] = "pipe.json";
    if (job.program == "pcl_bsh_scene") {
      std::string scene = files::contentOf(folder / "scene.json");
      scene.replace(scene.find("scan.xyz"), 8, "pipe.xyz");
      folder.write("scene.json", scene);
    }
    const bool reads = job.program != "pcl_bsh_tunnel";
    const fs::path pipe = folder / (job.arguments[0] == "pipe.json" ? "pipe.json" : "pipe.xyz");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    if (!reads) job.arguments.back() = "0.3"; // busy for seconds
    const auto before = contentsOf(folder.path());

    Process program(job.program, job.arguments, folder.path(), [] { std::signal(SIGHUP, SIG_DFL); });
    if (reads) waitUntilHeldUp(program, pipe);
    while (!reads && !program.hasEnded() && !fs::exists(folder / "run"))
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    program.send(signal);
    EXPECT_EQ(program.end(), 128 + signal) << program.err();
    EXPECT_THAT(program.err(),
                EndsWith("\n" + job.program + ": stopped on request: nothing unfinished was left behind\n"));
    EXPECT_EQ(contentsOf(folder.path()), before);
  }
}

std::string nameOf(const testing::TestParamInfo<Job>& job)
{
  return job.param.program;
}

INSTANTIATE_TEST_SUITE_P(Programs, Interruption, testing::ValuesIn(allJobs()), nameOf);

} // namespace

TEST(StopsCleanlyWhenTold, WhileItWrites)
{
  for (const int signal : {SIGINT, SIGTERM}) {
    const files::TemporaryFolder folder;
    folder.write("old", "old");
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
      dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
      cli::stopCleanlyOnSignals("test");
      const files::OutputFolder made(folder / "new/folder");
      files::FileReplacement first(folder / "old"), second(folder / "new/folder/file");
      first.stream() << "new" << std::flush;
      second.stream() << std::string(100000, 'x') << std::flush;
      static_cast<void>(write(ready[1], "x", 1));
      while (true) pause();
    }
    char byte = 0;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    EXPECT_EQ(folder.files(), 3U) << "old, old.part0, new";
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 128 + signal) << status;
    EXPECT_EQ(contentsOf(folder.path()), (std::map<std::string, std::string>{{"old", "old"}}));
    close(ready[0]);
    close(ready[1]);
  }
}

} // namespace pcl_bsh
