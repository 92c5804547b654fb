// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/computing.h>

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
  bool changing = false;
};

Turns& turns()
{
  static Turns all;
  return all;
}

thread_local std::size_t depth = 0; ///< how many Computing this thread has

} // namespace

Computing::Computing()
{
  if (depth++ > 0) return;
  std::unique_lock lock(turns().mutex);
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
  turns().ended.wait(lock, [] { return turns().computing == 0 && !turns().changing; });
  turns().changing = true;
}

Changing::~Changing()
{
  const std::lock_guard lock(turns().mutex);
  turns().changing = false;
  turns().ended.notify_all();
}

} // namespace pcl_bsh::python
