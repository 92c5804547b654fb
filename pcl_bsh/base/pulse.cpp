// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/pulse.h>

#include <utility>

namespace pcl_bsh {
namespace {

thread_local Watcher* watcher_of_thread = nullptr;

} // namespace

Watcher* watcherOfThread() noexcept
{
  return watcher_of_thread;
}

Watched::Watched(Watcher* watcher) noexcept : before_(std::exchange(watcher_of_thread, watcher))
{
}

Watched::~Watched()
{
  watcher_of_thread = before_;
}

} // namespace pcl_bsh
