// SPDX-License-Identifier: BSD-3-Clause
// Python's clouds, questions about two of them, and the warnings of an answer as Python's warnings.
#pragma once

#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/threads/callback.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/question/warnings/hollow.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::python {

/// Python's SphereHierarchy, and what is kept of it from one question to the next.
class Cloud : public SphereHierarchy {
public:
  using SphereHierarchy::SphereHierarchy;
  Cloud(Cloud&&) = delete;

  /// This cloud as a shape of a question, with the name of an argument.
  Shape named(std::string name) const { return shape_.named(std::move(name)); }

  /// Drops what was measured of its points, as they are about to move. To be called while no thread computes, with the
  /// interpreter's lock.
  void forget()
  {
    shape_ = Shape("", itself());
    ++changes_;
  }

  /// How often forget() was called. To be read while this thread computes.
  std::size_t changes() const noexcept { return changes_; }

private:
  std::shared_ptr<const SphereHierarchy> itself() const { return {std::shared_ptr<const void>(), this}; }
  Shape shape_{"", itself()};
  std::size_t changes_ = 0;
};

/// Whether a question about hierarchies has an option. Options that decide how hierarchies are built are left out.
bool isOfHierarchies(const QuestionOption& option, QuestionKind kind);

/// Sets options of a question by their names in the table of options. @param kind an option must be one of this kind
/// @throws py::type_error for an unknown name or a wrong value
void setOptions(Question& question, const py::kwargs& options, QuestionKind kind);

/// Two clouds with the names of arguments, their poses in the world, and the question. A planner asks about the same
/// clouds thousands of times, so the spacings of their points are measured once.
struct PythonQuestion {
  /// Leaves the pose of the second cloud to the caller: it goes along a path, or has many poses.
  PythonQuestion(const char* name_a, const Cloud& cloud_a, const PoseLike& pose_a, const char* name_b,
                 const Cloud& cloud_b);

  /// The arguments a, pose_a, b and pose_b.
  PythonQuestion(const Cloud& cloud_a, const PoseLike& pose_a, const Cloud& cloud_b, const PoseLike& pose_b);

  /// setOptions() of the question.
  void set(const py::kwargs& options, QuestionKind kind) { setOptions(question, options, kind); }

  /// The answer of ask(), computed without the interpreter's lock; its warnings are told.
  Answer answer();

  /// The answer of a query that Question does not have; its warnings are told.
  /// @param nearest returns the smallest distance that the answer tells, as nearestOf() does
  template <class Query, class Nearest>
  auto answer(Query&& query, const Nearest& nearest)
  {
    std::vector<Warning> warnings;
    auto found = unlocked([&] {
      auto answer = query();
      warnings = warningsOf(question, nearest(answer), input, obstacle);
      return answer;
    });
    warn(warnings);
    return found;
  }

  Placed a, b;
  Shape input, obstacle;
  Question question;

private:
  static void warn(const std::vector<Warning>& warnings);
};

/// By warnings.warn(), which tells each sentence once for a line of Python, unless its filters say otherwise.
void warn(const std::string& text);

} // namespace pcl_bsh::python
