// SPDX-License-Identifier: BSD-3-Clause
#include "one_shot.h"

#include "flags_racers.h"
#include "harness.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace pcl_bsh::bench {
namespace {

constexpr const char* kMark = "--one-shot-of-this-program";

[[noreturn]] void fail(const std::string& what)
{
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

void writeAll(int descriptor, const void* data, std::size_t bytes)
{
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = write(descriptor, next, bytes);
    if (done <= 0) fail("the clouds cannot be written to memory");
    next += done;
    bytes -= static_cast<std::size_t>(done);
  }
}

/// From `offset`, which it moves on: processes share the descriptor's own.
void readAll(int descriptor, void* data, std::size_t bytes, off_t& offset)
{
  char* next = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t done = pread(descriptor, next, bytes, offset);
    if (done <= 0) fail("the clouds cannot be read from memory");
    next += done;
    offset += done;
    bytes -= static_cast<std::size_t>(done);
  }
}

Points readCloud(int descriptor, off_t& offset)
{
  std::uint64_t count = 0;
  readAll(descriptor, &count, sizeof count, offset);
  Points points(count);
  readAll(descriptor, points.data(), count * sizeof(Point), offset);
  return points;
}

double wallMilliseconds()
{
  timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

} // namespace

CloudsInMemory::CloudsInMemory(const Points& a, const Points& b) : descriptor_(memfd_create("clouds", MFD_CLOEXEC))
{
  if (descriptor_ < 0) fail("memory for the clouds");
  for (const Points* points : {&a, &b}) {
    const std::uint64_t count = points->size();
    writeAll(descriptor_, &count, sizeof count);
    writeAll(descriptor_, points->data(), count * sizeof(Point));
  }
}

CloudsInMemory::~CloudsInMemory()
{
  close(descriptor_);
}

OneShotResult runInNewProcess(const OneShot& shot, const CloudsInMemory& clouds)
{
  std::vector<std::string> words = {"bench_cold", kMark, shot.racer, shot.question};
  const auto addNumber = [&](double value) {
    char word[64];
    std::snprintf(word, sizeof word, "%a", value);
    words.emplace_back(word);
  };
  addNumber(shot.d);
  for (const double value : shot.tuning) addNumber(value);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail("a pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, clouds.descriptor(), 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  pid_t child = 0;
  const int error = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string said;
  char part[512];
  for (ssize_t got = 0; error == 0 && (got = read(ends[0], part, sizeof part)) > 0;)
    said.append(part, static_cast<std::size_t>(got));
  close(ends[0]);
  int status = 0;
  if (error != 0 || waitpid(child, &status, 0) != child || status != 0)
    throw std::runtime_error("a new process for " + shot.racer + " failed");

  OneShotResult result;
  std::istringstream in(said);
  in >> result.wall_ms >> result.cpu_ms >> result.build_cpu_ms >> result.faults >> result.build_faults >>
      result.peak_bytes >> result.found;
  if (!in) throw std::runtime_error("a new process for " + shot.racer + " said '" + said + "'");
  std::getline(in >> std::ws, result.remark);
  return result;
}

bool isOneShot(int argc, char** argv)
{
  return argc >= 5 && std::strcmp(argv[1], kMark) == 0;
}

int runOneShot(int argc, char** argv)
{
  try {
    off_t offset = 0;
    const Points a = readCloud(0, offset), b = readCloud(0, offset);
    const bool any = std::strcmp(argv[3], "any") == 0;
    const double d = std::strtod(argv[4], nullptr);
    std::vector<double> tuning;
    for (int i = 5; i < argc; ++i) tuning.push_back(std::strtod(argv[i], nullptr));
    const auto racer = makeFlagsRacer(argv[2]);
    racer->adopt(a, b);
    if (!tuning.empty()) racer->useTuning(tuning);

    useFreshMemory();
    Stopwatch::use("cpu");
    const MemoryPeak peak;
    const double faults_before = minorFaults(), wall_before = wallMilliseconds();
    const Stopwatch cpu;
    const FlagsRun run = any ? racer->runAny(d) : racer->run(d, 1);
    const double cpu_ms = 1e3 * cpu.seconds(), wall_ms = wallMilliseconds() - wall_before;
    const double faults = minorFaults() - faults_before;
    std::printf("%.6f %.6f %.6f %.0f %.0f %zu %zu %s\n", wall_ms, cpu_ms, 1e3 * run.build_seconds, faults,
                run.build_faults, peak.bytes(),
                static_cast<std::size_t>(std::count(run.flags.begin(), run.flags.end(), 1)), run.remark.c_str());
    return 0;
  }
  catch (const std::exception& error) {
    std::fprintf(stderr, "bench_cold: %s\n", error.what());
    return 1;
  }
}

} // namespace pcl_bsh::bench
