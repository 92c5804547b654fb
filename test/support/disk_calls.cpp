// SPDX-License-Identifier: BSD-3-Clause
#include "disk_calls.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <stdexcept>

namespace pcl_bsh::test {
namespace {

DiskCalls* recording = nullptr;
std::mutex one_at_a_time; ///< of what it notes

std::string nameOf(int descriptor)
{
  std::error_code none;
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), none).filename();
}

/// Notes a call. @return whether it is to be made; else errno is set
bool passes(const std::string& call)
{
  if (!recording) return true;
  const std::lock_guard lock(one_at_a_time);
  DiskCalls& now = *recording;
  ++now.made;
  if (now.calls.empty() || now.calls.back() != call) now.calls.push_back(call);
  if (const auto once = now.failing_once.find(call); once != now.failing_once.end()) {
    errno = once->second;
    now.failing_once.erase(once);
    return false;
  }
  const auto failing = now.failing.find(call);
  if (failing == now.failing.end()) return true;
  errno = failing->second;
  return false;
}

/// The function of that name that this one stands before.
template <class Function>
Function* original(const char* name)
{
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

} // namespace

DiskCalls::DiskCalls()
{
  if (recording) throw std::logic_error("DiskCalls: there is one already");
  recording = this;
}

DiskCalls::~DiskCalls()
{
  recording = nullptr;
}

} // namespace pcl_bsh::test

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t count)
{
  using namespace pcl_bsh::test;
  static const auto next = original<ssize_t(int, const void*, size_t)>("write");
  return !recording || passes("write " + nameOf(descriptor)) ? next(descriptor, bytes, count) : -1;
}

ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t at)
{
  using namespace pcl_bsh::test;
  static const auto next = original<ssize_t(int, const void*, size_t, off_t)>("pwrite");
  return !recording || passes("write " + nameOf(descriptor)) ? next(descriptor, bytes, count, at) : -1;
}

int syncfs(int descriptor) noexcept
{
  using namespace pcl_bsh::test;
  static const auto next = original<int(int)>("syncfs");
  return !recording || passes("syncfs " + nameOf(descriptor)) ? next(descriptor) : -1;
}

int fsync(int descriptor)
{
  using namespace pcl_bsh::test;
  static const auto next = original<int(int)>("fsync");
  return !recording || passes("fsync " + nameOf(descriptor)) ? next(descriptor) : -1;
}

int rename(const char* from, const char* to) noexcept
{
  using namespace pcl_bsh::test;
  using std::filesystem::path;
  static const auto next = original<int(const char*, const char*)>("rename");
  if (recording && !passes("rename " + path(from).filename().string() + " " + path(to).filename().string())) return -1;
  return next(from, to);
}
}
