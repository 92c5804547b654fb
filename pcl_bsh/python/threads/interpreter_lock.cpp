// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/threads/interpreter_lock.h>

#include <atomic>
#include <thread>

#include <cxxabi.h>
#include <unistd.h>

namespace pcl_bsh::python {
namespace {

namespace py = pybind11;

std::atomic<std::thread::id> ending_thread; ///< none: the interpreter goes on

[[noreturn]] void stop()
{
  for (;;) pause();
}

/// Calls act(). Stops this thread where CPython unwinds it. @param act takes the interpreter's lock; owns nothing
template <class Act>
void orStop(Act&& act)
{
  try {
    act();
  }
  catch (abi::__forced_unwind&) {
    stop();
  }
}

} // namespace

Locked::Locked()
{
  orStop([&] { lock_.emplace(); });
}

Unlocked::~Unlocked()
{
  if (isEnding()) stop();
  orStop([&] { PyEval_RestoreThread(state_); });
}

py::object called(const py::object& f, const py::object& argument)
{
  PyObject* result = nullptr;
  orStop([&] { result = PyObject_CallFunctionObjArgs(f.ptr(), argument.ptr(), nullptr); });
  if (!result) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(result);
}

bool isEnding() noexcept
{
  const std::thread::id ending = ending_thread.load();
  return ending != std::thread::id() && ending != std::this_thread::get_id();
}

void setEnding() noexcept
{
  ending_thread = std::this_thread::get_id();
}

} // namespace pcl_bsh::python
