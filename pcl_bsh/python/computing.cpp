// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/computing.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <stdexcept>

namespace pcl_bsh::python {
namespace {

struct Turns {
  std::mutex mutex;
  std::condition_variable ended;
  std::size_t computing = 0; ///< threads
  std::size_t waiting = 0;   ///< to change
  bool changing = false;
};

Turns& turns()
{
  static Turns all;
  return all;
}

/// How long a query lets changes go first that wait already. No longer: it may be what a callback waits for, in a query
/// for whose end the change waits.
constexpr std::chrono::milliseconds kGivesWay{50};

thread_local std::size_t depth = 0; ///< how many Computing and Changing this thread has

} // namespace

Computing::Computing()
{
  if (depth++ > 0) return;
  std::unique_lock lock(turns().mutex);
  turns().ended.wait_for(lock, kGivesWay, [] { return turns().waiting == 0 && !turns().changing; });
  turns().ended.wait(lock, [] { return !turns().changing; });
  ++turns().computing;
}

Computing::~Computing()
{
  if (--depth > 0) return;
  const std::lock_guard lock(turns().mutex);
  if (--turns().computing == 0) turns().ended.notify_all();
}

Changing::Changing()
{
  if (depth > 0)
    throw std::runtime_error("points cannot change while a query runs: do it after the query, not in its callback");
  std::unique_lock lock(turns().mutex);
  ++turns().waiting;
  turns().ended.wait(lock, [] { return turns().computing == 0 && !turns().changing; });
  --turns().waiting;
  turns().changing = true;
  ++depth;
}

Changing::~Changing()
{
  --depth;
  const std::lock_guard lock(turns().mutex);
  turns().changing = false;
  turns().ended.notify_all();
}

} // namespace pcl_bsh::python
