// SPDX-License-Identifier: BSD-3-Clause
// The interpreter's lock, taken and let go by threads that outlive the interpreter. When the interpreter is gone,
// CPython unwinds a thread that wants the lock by pthread_exit(). Destructors then work on objects without the lock,
// and std::terminate() ends the process at the first function that no exception may leave. Here such a thread stops
// where it is, until the process ends.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

namespace pcl_bsh::python {

/// Holds the interpreter's lock while it lives.
class Locked {
public:
  Locked();

private:
  std::optional<pybind11::gil_scoped_acquire> lock_;
};

/// Lets go of the interpreter's lock, which this thread holds, while it lives.
class Unlocked {
public:
  Unlocked() : state_(PyEval_SaveThread()) {}
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

private:
  PyThreadState* state_;
};

/// Returns f(argument). Needs the interpreter's lock, which f may let go.
pybind11::object called(const pybind11::object& f, const pybind11::object& argument);

/// Whether another thread is ending the interpreter. Then this thread shall end its work, and cannot return to Python.
bool isEnding() noexcept;

/// Says that this thread is ending the interpreter.
void setEnding() noexcept;

} // namespace pcl_bsh::python
