// SPDX-License-Identifier: BSD-3-Clause
// Answers of a robot's world about states and motions.
#pragma once

#include <pcl_bsh/python/typed.h>
#include <pcl_bsh/query/result.h>

#include <pybind11/numpy.h>

#include <cstddef>
#include <vector>

namespace pcl_bsh::python {

/// @tparam Answer of one state or motion
template <class Answer>
struct Answers {
  std::vector<Answer> rows;
  bool is_one = false; ///< asked about a single one: arrays lack the dimension of rows
};

using FreeOnes = As<"Union[bool, npt.NDArray[np.bool_]]">;

/// Which rows are certainly free.
template <class Answer>
FreeOnes freeOnes(const Answers<Answer>& answers)
{
  if (answers.is_one) return py::bool_(answers.rows.front().verdict == Verdict::free);
  py::array_t<bool> free(static_cast<py::ssize_t>(answers.rows.size()));
  bool* is_free = free.mutable_data();
  for (const Answer& answer : answers.rows) *is_free++ = answer.verdict == Verdict::free;
  return free;
}

} // namespace pcl_bsh::python
