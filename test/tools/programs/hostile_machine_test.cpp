// SPDX-License-Identifier: BSD-3-Clause
// Disks that are full, folders that are not ours, a program that is killed: the old file or the new one, and nothing
// else touched.
#include "jobs.h"

#include <gmock/gmock.h>

#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <thread>

namespace pcl_bsh {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;
using Contents = std::map<std::string, std::string>;

class HostileMachine : public testing::TestWithParam<Job> {
protected:
  HostileMachine() { prepareJobs(folder); }

  /// Exit code 1, one line, and the folder as it was.
  void expectRefused(const std::function<void()>& prepare, const std::string& message)
  {
    const Contents before = contentsOf(folder.path());
    Process program(job.program, job.arguments, folder.path(), prepare);
    EXPECT_EQ(program.end(), 1) << program.err();
    std::string last = program.err(); // what comes before are warnings
    if (!last.empty()) last.pop_back();
    last = last.substr(last.rfind('\n') + 1);
    EXPECT_THAT(last, StartsWith(job.program + ": "));
    EXPECT_THAT(last, HasSubstr(message));
    for (const auto& [name, content] : contentsOf(folder.path())) {
      const auto was = before.find(name);
      EXPECT_TRUE(was != before.end()) << name << " is new";
      if (was == before.end()) continue;
      EXPECT_TRUE(was->second == content) << name;
    }
  }

  const Job& job = GetParam();
  files::TemporaryFolder folder;
};

void becomeNobody()
{
  if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(125);
}

TEST_P(HostileMachine, AFullDisk)
{
  for (const std::string& output : job.outputs)
    if (output.back() != '/') folder.write(output, "old");
  expectRefused(
      [] {
        const rlimit room = {64, 64};
        setrlimit(RLIMIT_FSIZE, &room);
      },
      "cannot be written");
}

TEST_P(HostileMachine, AFolderOfSomeoneElse)
{
  ASSERT_EQ(chmod(folder.path().c_str(), 0555), 0);
  expectRefused(becomeNobody, "Permission denied");
  ASSERT_EQ(chmod(folder.path().c_str(), 0755), 0);
}

TEST_P(HostileMachine, AFileProtectedFromWriting)
{
  ASSERT_EQ(chmod(folder.path().c_str(), 0777), 0);
  const std::string output = *job.outputs.begin();
  if (output.back() == '/') return; // writes into a folder of its own
  ASSERT_EQ(chmod(folder.write(output, "old").c_str(), 0444), 0);
  expectRefused(becomeNobody, output + ": cannot be written (Permission denied)");
}

TEST_P(HostileMachine, KilledAtAnyMoment)
{
  if (job.program == "pcl_bsh_accuracy") return; // measures for long before it writes, as the others do
  const auto isOutput = [&](const std::string& name) {
    return std::any_of(job.outputs.begin(), job.outputs.end(), [&](const std::string& output) {
      return output.back() == '/' ? name.rfind(output, 0) == 0 : name == output;
    });
  };
  // How long it takes, and what it writes; times in what it writes differ from run to run.
  const auto begin = std::chrono::steady_clock::now();
  Process whole(job.program, job.arguments, folder.path());
  whole.end();
  const auto takes = std::chrono::steady_clock::now() - begin;
  const Contents complete = contentsOf(folder.path());
  for (const auto& [name, content] : complete)
    if (isOutput(name)) fs::remove_all(folder / name);
  const Contents inputs = contentsOf(folder.path());

  constexpr int moments = 6;
  for (int moment = 1; moment <= moments; ++moment) {
    for (const std::string& output : job.outputs)
      if (output.back() != '/') folder.write(output, "old");
    Process program(job.program, job.arguments, folder.path());
    std::this_thread::sleep_for(takes / moments * moment);
    program.send(SIGKILL);
    program.end();
    for (const auto& [name, content] : contentsOf(folder.path())) {
      if (inputs.count(name) != 0) {
        EXPECT_TRUE(content == inputs.at(name)) << name;
      }
      else if (name.find(".part") == std::string::npos) {
        EXPECT_TRUE(isOutput(name)) << name;
        const bool is_new = complete.count(name) != 0 && content.size() + 200 > complete.at(name).size();
        const bool is_generation = job.program == "pcl_bsh_view"; // blocks get new names as long as old ones stand
        EXPECT_TRUE(content == "old" || is_new || is_generation) << name << ": " << content.size() << " bytes";
      }
    }
    for (const auto& [name, content] : inputs) EXPECT_TRUE(fs::exists(folder / name)) << name;
    for (const std::string& output : job.outputs) {
      EXPECT_TRUE(output.back() == '/' || fs::exists(folder / output)) << output;
      fs::remove_all(folder / output);
    }
  }
}

std::string nameOf(const testing::TestParamInfo<Job>& job)
{
  return job.param.program;
}

INSTANTIATE_TEST_SUITE_P(Programs, HostileMachine, testing::ValuesIn(allJobs()), nameOf);

} // namespace

TEST(HostileMachine, AFolderThatVanishes)
{
  files::TemporaryFolder folder;
  prepareJobs(folder);
  fs::create_directory(folder / "sub");
  ASSERT_EQ(mkfifo((folder / "pipe.xyz").c_str(), 0600), 0);
  Process program("pcl_bsh_collide", {"pipe.xyz", "robot.xyz", "sub/out.pcd", "--clearance", "0.1"}, folder.path());
  {
    std::ofstream pipe(folder / "pipe.xyz"); // opens when the program reads: all is checked by then
    fs::remove(folder / "sub");
    pipe << "0 0 0\n";
  }
  EXPECT_EQ(program.end(), 1);
  EXPECT_THAT(program.err(), HasSubstr("there is no folder sub"));
  EXPECT_FALSE(fs::exists(folder / "sub"));
}

TEST(HostileMachine, StandardOutput)
{
  files::TemporaryFolder folder;
  prepareJobs(folder);
  const auto fill = [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); };
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"scan.xyz", "robot.xyz", "-", "--clearance", "0.1"},
                                                    {"scan.xyz", "robot.xyz", "out.pcd", "--clearance", "0.1"}}) {
    Process program("pcl_bsh_collide", arguments, folder.path(), fill);
    EXPECT_EQ(program.end(), 1) << arguments[0];
    EXPECT_THAT(program.err(), HasSubstr("pcl_bsh_collide: standard output: cannot be written"));
  }
  // A stream that is closed must not be taken for a file that is opened next.
  Process scene("pcl_bsh_scene", {"scene.json", "--out", "run"}, folder.path(), [] {
    close(STDOUT_FILENO);
    close(STDIN_FILENO);
  });
  EXPECT_EQ(scene.end(), 1) << "its summary is lost";
  EXPECT_THAT(scene.err(), HasSubstr("pcl_bsh_scene: standard output: cannot be written"));
  EXPECT_THAT(files::contentOf(folder / "run/steps.csv"), StartsWith("step,time_s"));
  EXPECT_THAT(files::contentOf(folder / "run/steps.csv"), testing::Not(HasSubstr("scene.json")));
}

/// A variable of the shell that is not set must not pass for an option that was left out.
TEST(HostileMachine, EmptyValues)
{
  files::TemporaryFolder folder;
  prepareJobs(folder);
  using Arguments = std::vector<std::string>;
  for (const auto& [name, arguments] :
       {std::pair{"pcl_bsh_collide", Arguments{"scan.xyz", "robot.xyz", "out.pcd", "--clearance", "0.1", "--pose", ""}},
        {"pcl_bsh_collide", {"scan.xyz", "robot.xyz", "out.pcd", "--clearance", "0.1", "--trajectory", ""}},
        {"pcl_bsh_collide", {"scan.xyz", "robot.xyz", "", "--clearance", "0.1"}},
        {"pcl_bsh_scene", {"scene.json", "--out", ""}},
        {"pcl_bsh_tunnel", {""}},
        {"pcl_bsh_site", {"make", "scan.xyz", "--out", ""}}}) {
    Process program(name, arguments, folder.path());
    EXPECT_EQ(program.end(), 2) << name;
    EXPECT_THAT(program.err(), HasSubstr(": is empty: give a value, or leave it out"));
  }
  EXPECT_FALSE(fs::exists(folder / "out.pcd"));
}

} // namespace pcl_bsh
