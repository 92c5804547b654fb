// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/python_question.h>

namespace pcl_bsh::python {

PythonQuestion::PythonQuestion(const char* name_a, const Cloud& cloud_a, const PoseLike& pose_a, const char* name_b,
                               const Cloud& cloud_b)
: a(cloud_a, poseOf(std::string("pose_") + name_a, pose_a)),
  b(cloud_b),
  input(cloud_a.named(name_a)),
  obstacle(cloud_b.named(name_b))
{
  question.pose_of_input = a.pose;
}

PythonQuestion::PythonQuestion(const Cloud& cloud_a, const PoseLike& pose_a, const Cloud& cloud_b,
                               const PoseLike& pose_b)
: PythonQuestion("a", cloud_a, pose_a, "b", cloud_b)
{
  question.pose = b.pose = poseOf("pose_b", pose_b);
}

bool isOfHierarchies(const QuestionOption& option, QuestionKind kind)
{
  const auto is = [&](auto member) { return option.member == OptionMember(member); };
  return isOf(option.kind, kind) && !is(&Question::vertices_only) && !is(&Question::uncertainty) &&
         !is(&Question::obstacle_uncertainty) && !is(&Question::pose_uncertainty) &&
         !is(&Question::input_pose_uncertainty) && !is(&Question::sigmas) && !is(&Question::ignore_points) &&
         !is(&Question::obstacle_ignore_points) && !is(&Question::seen_beyond);
}

void setOptions(Question& question, const py::kwargs& options, QuestionKind kind)
{
  for (const auto& [key, value] : options) {
    const std::string name = py::str(key);
    const QuestionOption* const option = questionOption(name);
    if (!option || !isOfHierarchies(*option, kind)) throw py::type_error("there is no argument '" + name + "'");
    if (value.is_none()) continue;
    const std::string text = py::str(value);
    setOption(question, name, py::isinstance<py::bool_>(value) ? text == "True" ? "true" : "false" : text);
  }
}

Answer PythonQuestion::answer()
{
  Answer found = unlocked([&] { return ask(question, input, obstacle); });
  warn(found.warnings);
  return found;
}

void PythonQuestion::warn(const std::vector<Warning>& warnings)
{
  for (const Warning& warning : warnings) python::warn(warning.text);
}

void warn(const std::string& text)
{
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

} // namespace pcl_bsh::python
