// SPDX-License-Identifier: BSD-3-Clause
// The extension module of the Python package pcl_bsh; package/pcl_bsh/__init__.py shows its names.
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>
#include <pcl_bsh/python/threads/computing.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/version.h>

#include <cctype>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <string_view>

namespace pcl_bsh::python {
namespace {

/// "f(a: int, b: float = 0.0) -> int" as "f(a, b=0.0)", which Python's inspect reads.
std::string withoutTypes(std::string_view typed)
{
  std::string plain;
  int level = 0;
  bool in_type = false;
  for (std::size_t i = 0; i < typed.size(); ++i) {
    const char c = typed[i];
    if (c == '(' || c == '[') ++level;
    if (c == ')' || c == ']') --level;
    const bool ends = level == 0 && c == ')';
    if (ends || (level == 1 && c == ',')) in_type = false;
    if (level == 1 && c == ':') in_type = true;
    if (in_type && level == 1 && typed.substr(i, 3) == " = ") {
      in_type = false;
      plain += '=';
      i += 2;
    }
    else if (!in_type) {
      plain += c;
    }
    if (ends) break;
  }
  if (const std::size_t at = plain.find("**kwargs"); at != plain.npos) plain.replace(at, 8, "**options");
  return plain;
}

/// A docstring that begins with the signature of the function, or of its first overload, as Python's own do.
std::string plainDocstring(std::string_view doc)
{
  const std::size_t first = doc.find("\n1. "), second = doc.find("\n2. ");
  if (first != doc.npos && second != doc.npos) doc = doc.substr(first + 4, second - first - 4);
  const std::size_t line = std::min(doc.find('\n'), doc.size());
  const std::size_t text = std::min(doc.find_first_not_of('\n', line), doc.size());
  return withoutTypes(doc.substr(0, line)) + "\n--\n\n" + std::string(doc.substr(text));
}

/// The description of a question's option, as the paragraph below a parameter's name.
std::string sentenceOf(const QuestionOption& option)
{
  std::string text = std::string(option.doc) + (option.unit[0] == 'm' ? "; in the clouds' unit." : ".");
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  const py::object fill = py::module_::import("textwrap").attr("fill");
  return py::str(fill(text, "width"_a = 116, "initial_indent"_a = "    ", "subsequent_indent"_a = "    "));
}

/// The options of a kind of question that a docstring does not name, as parameters.
std::string otherOptions(const std::string& doc, QuestionKind kind)
{
  std::string text;
  for (const QuestionOption& option : questionOptions())
    if (isOfHierarchies(option, kind) && doc.find("\n" + std::string(option.name) + " : ") == doc.npos) {
      const bool is_switch = std::holds_alternative<bool Question::*>(option.member);
      const bool is_text = std::holds_alternative<ScanOrigins Question::*>(option.member);
      text += std::string(option.name) + " : " + (is_switch ? "bool" : is_text ? "str" : "float") + ", optional\n";
      text += sentenceOf(option) + '\n';
    }
  return text;
}

/// Parameters without a description are options of questions; `**options of` a kind stands for all others.
std::string described(const std::string& doc)
{
  std::istringstream lines(doc);
  std::string text, line;
  const QuestionOption* option = nullptr; // that the last line names
  while (std::getline(lines, line)) {
    if (line.rfind("**options of ", 0) == 0) {
      if (option) text += sentenceOf(*option) + '\n';
      option = nullptr;
      text += otherOptions(doc, line == "**options of distances" ? QuestionKind::distances : QuestionKind::collisions);
      continue;
    }
    if (option && line.rfind("    ", 0) != 0) text += sentenceOf(*option) + '\n';
    const std::size_t colon = line.find(" : ");
    option = colon == line.npos ? nullptr : questionOption(line.substr(0, colon));
    text += line + '\n';
  }
  return text;
}

/// Takes types out of the docstrings of functions of a module or a class.
void hideTypes(const py::object& scope)
{
  for (const auto& [name, member] : py::dict(scope.attr("__dict__"))) {
    if (PyType_Check(member.ptr())) hideTypes(py::reinterpret_borrow<py::object>(member));
    const py::object found = scope.attr(name);
    const py::handle function = py::detail::get_function(found);
    if (!PyCFunction_Check(function.ptr()) || !PyCFunction_GET_SELF(function.ptr())) continue;
    if (!PyCapsule_CheckExact(PyCFunction_GET_SELF(function.ptr()))) continue; // Python's own
    PyMethodDef& definition = *reinterpret_cast<PyCFunctionObject*>(function.ptr())->m_ml;
    if (!definition.ml_doc || std::strstr(definition.ml_doc, "\n--\n")) continue;
    const std::string doc = described(plainDocstring(definition.ml_doc));
    std::free(const_cast<char*>(definition.ml_doc)); // as pybind11 does in the end
    definition.ml_doc = strdup(doc.c_str());
  }
}

} // namespace
} // namespace pcl_bsh::python

PYBIND11_MODULE(_core, module)
{
  using namespace pcl_bsh::python;
  pybind11::options options;
  options.disable_enum_members_docstring();
  module.attr("__version__") = PCL_BSH_VERSION_TEXT;
  takeTurnsWithInterpreter();
  bindWords(module);
  bindHierarchy(module);
  bindCollision(module);
  bindObstacles(module);
  bindContacts(module);
  bindManifold(module);
  bindMass(module);
  bindDistances(module);
  bindNeighbors(module);
  bindClusters(module);
  bindTrajectory(module);
  bindAxis(module);
  bindGauge(module);
  bindSeenOutline(module);
  bindManyPoses(module);
  bindScene(module);
  bindFiles(module);
#ifdef PCL_BSH_ROBOTS
  bindRobot(module);
  bindRobotAnswers(module);
  bindRobotWorld(module);
#endif
  bindPipeline(module);
  module.def("_hide_types", [] { hideTypes(py::module_::import("pcl_bsh._core")); });
}
