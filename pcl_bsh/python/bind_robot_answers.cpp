// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/robot_answers.h>
#include <pcl_bsh/robot/robot_world.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pcl_bsh::python {
namespace {

using robots::ClearanceResult;
using robots::Meeting;
using robots::MotionCheck;
using robots::StateCheck;

/// A read-only property: an array of what is read of each row.
template <class Answer, class Read>
auto columnOf(const Read& read)
{
  using T = std::decay_t<std::invoke_result_t<Read, const Answer&>>;
  return [read](const Answers<Answer>& answers) -> ArrayOf<T> {
    std::vector<T> values;
    for (const Answer& answer : answers.rows) values.push_back(read(answer));
    ArrayOf<T> column = arrayFrom(std::move(values));
    if (answers.is_one) column = column.reshape(std::vector<py::ssize_t>());
    return column;
  };
}

/// A property: an array of a number in each row's meeting; -1 where nothing meets, or the meeting lacks the number.
template <class Answer, class Read>
auto columnOfMeetings(const Read& read)
{
  return columnOf<Answer>([read](const Answer& answer) -> std::uint32_t {
    const std::optional<std::size_t> found = answer.meeting ? read(*answer.meeting) : std::nullopt;
    return found ? static_cast<std::uint32_t>(*found) : std::uint32_t{kNothing};
  });
}

template <class Answer>
auto bindAnswers(py::module_& module, const char* name, const char* doc)
{
  using Number = std::optional<std::size_t>;
  const auto link = [](const Meeting& meeting) -> Number { return meeting.link; };
  const auto shape = [](const Meeting& meeting) -> Number { return meeting.shape; };
  const auto other_link = [](const Meeting& meeting) -> Number { return meeting.other_link; };
  const auto other_shape = [](const Meeting& meeting) {
    return meeting.other_link ? Number(meeting.other_shape) : std::nullopt;
  };
  const auto obstacle = [](const Meeting& meeting) {
    return meeting.other_link ? std::nullopt : Number(meeting.obstacle);
  };
  const auto record = [](const Meeting& meeting) { return meeting.other_link ? std::nullopt : Number(meeting.record); };
  return py::class_<Answers<Answer>>(module, name, doc)
      .def_property_readonly("link", columnOfMeetings<Answer>(link))
      .def_property_readonly("shape", columnOfMeetings<Answer>(shape))
      .def_property_readonly("other_link", columnOfMeetings<Answer>(other_link))
      .def_property_readonly("other_shape", columnOfMeetings<Answer>(other_shape))
      .def_property_readonly("obstacle", columnOfMeetings<Answer>(obstacle))
      .def_property_readonly("record", columnOfMeetings<Answer>(record));
}

template <class Answer>
auto bindChecks(py::module_& module, const char* name, const char* doc)
{
  return bindAnswers<Answer>(module, name, doc)
      .def_property_readonly("verdict", columnOf<Answer>([](const Answer& check) { return check.verdict; }))
      .def("__repr__", [name](const Answers<Answer>& checks) {
        const auto count = [&](Verdict verdict) {
          return std::to_string(std::count_if(checks.rows.begin(), checks.rows.end(),
                                              [verdict](const Answer& check) { return check.verdict == verdict; }));
        };
        return std::string(name) + "(" + count(Verdict::free) + " free, " + count(Verdict::colliding) + " colliding, " +
               count(Verdict::undecided) + " undecided)";
      });
}

py::array_t<double> gapsOf(const Answers<ClearanceResult>& answers)
{
  std::vector<py::ssize_t> shape = {2};
  if (!answers.is_one) shape.insert(shape.begin(), static_cast<py::ssize_t>(answers.rows.size()));
  py::array_t<double> gaps(shape);
  double* number = gaps.mutable_data();
  for (const ClearanceResult& answer : answers.rows) {
    *number++ = answer.gap.lower;
    *number++ = answer.gap.upper;
  }
  return gaps;
}

} // namespace

void bindRobotAnswers(py::module_& module)
{
  bindChecks<StateCheck>(module, "StateChecks", "The answer of `RobotWorld.check_states`.");
  bindChecks<MotionCheck>(module, "MotionChecks", "The answer of `RobotWorld.check_motions`.")
      .def_property_readonly("fraction", columnOf<MotionCheck>([](const MotionCheck& check) { return check.fraction; }))
      .def_property_readonly("last_valid",
                             columnOf<MotionCheck>([](const MotionCheck& check) { return check.last_valid; }));
  bindAnswers<ClearanceResult>(module, "Clearances", "The answer of `RobotWorld.clearance`.")
      .def_property_readonly("gap", &gapsOf)
      .def("__repr__", [](const Answers<ClearanceResult>& found) {
        return "Clearances(" + counted(found.rows.size(), "state") + ")";
      });
}

} // namespace pcl_bsh::python
