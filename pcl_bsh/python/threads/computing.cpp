// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/threads/computing.h>

#include <pcl_bsh/python/threads/callback.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <new>
#include <optional>
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

/// Never destroyed: threads may wait when the process ends.
Turns& turns()
{
  static auto* const all = new Turns;
  return *all;
}

/// How long a new query lets waiting changes go first. The limit ends a deadlock: a change waits for a running query,
/// and that query's callback may wait for the new query.
constexpr std::chrono::milliseconds kGivesWay{50};

/// How long the interpreter's end waits for queries: they may wait in callbacks for what never comes.
constexpr std::chrono::seconds kLastWait{10};

thread_local std::size_t depth = 0; ///< how many Computing and Changing this thread has
thread_local bool changes = false;  ///< one of these is a Changing
thread_local std::optional<Changing> fork_turn;

void beforeFork()
{
  if (depth > 0) return;
  const Unlocked unlocked;
  fork_turn.emplace();
}

void afterForkInChild()
{
  new (&turns()) Turns; // other threads may have waited, and held the mutex
  turns().computing = depth > 0 && !changes ? 1 : 0;
  turns().changing = changes;
  changesBegun() = changes && !fork_turn ? 1 : 0;
  fork_turn.reset();
}

void atExit()
{
  setEnding();
  const Unlocked unlocked;
  std::unique_lock lock(turns().mutex);
  turns().ended.wait_for(lock, kLastWait, [] { return turns().computing == 0 && !turns().changing; });
}

} // namespace

Computing::Computing()
{
  if (depth++ > 0) return;
  std::unique_lock lock(turns().mutex);
  turns().ended.wait_for(lock, kGivesWay, [] { return turns().waiting == 0 && !turns().changing; });
  turns().ended.wait(lock, [] { return !turns().changing && !isEnding(); });
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
  turns().ended.wait(lock, [] { return turns().computing == 0 && !turns().changing && !isEnding(); });
  --turns().waiting;
  turns().changing = true;
  changes = true;
  ++depth;
}

Changing::~Changing()
{
  --depth;
  changes = false;
  const std::lock_guard lock(turns().mutex);
  turns().changing = false;
  turns().ended.notify_all();
}

void takeTurnsWithInterpreter()
{
  py::dict hooks;
  hooks["before"] = py::cpp_function(&beforeFork);
  hooks["after_in_parent"] = py::cpp_function([] { fork_turn.reset(); });
  hooks["after_in_child"] = py::cpp_function(&afterForkInChild);
  py::module_::import("os").attr("register_at_fork")(**hooks);
  py::module_::import("atexit").attr("register")(py::cpp_function(&atExit));
}

} // namespace pcl_bsh::python
