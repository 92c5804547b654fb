// SPDX-License-Identifier: BSD-3-Clause
// Python's clouds, what is asked of two of them, and what the answer does not say by itself, as Python's warnings.
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

  /// By the name of an argument.
  Shape named(std::string name) const { return shape_.named(std::move(name)); }

  /// Its points are about to move: what was measured of them counts no more. While none computes, with the
  /// interpreter's lock.
  void forget()
  {
    shape_ = Shape("", itself());
    ++changes_;
  }

  /// How often its points have moved, or nearly. While this thread computes.
  std::size_t changes() const noexcept { return changes_; }

private:
  std::shared_ptr<const SphereHierarchy> itself() const { return {std::shared_ptr<const void>(), this}; }
  Shape shape_{"", itself()};
  std::size_t changes_ = 0;
};

/// Whether a question about hierarchies has an option: not what decides how they are built.
bool isOfHierarchies(const QuestionOption& option, QuestionKind kind);

/// Options by their names in the table, of a kind of question: faces have them without a word of their own.
/// @throws py::type_error for an unknown name or a wrong value
void setOptions(Question& question, const py::kwargs& options, QuestionKind kind);

/// Two clouds by the names of arguments, where they are in the world, and what is asked. A planner asks about the same
/// clouds thousands of times: how far their points are apart is measured once.
struct PythonQuestion {
  /// The second cloud is where the question says.
  PythonQuestion(const char* name_a, const Cloud& cloud_a, const PoseLike& pose_a, const char* name_b,
                 const Cloud& cloud_b);

  /// The arguments a, pose_a, b and pose_b.
  PythonQuestion(const Cloud& cloud_a, const PoseLike& pose_a, const Cloud& cloud_b, const PoseLike& pose_b);

  /// setOptions() of the question.
  void set(const py::kwargs& options, QuestionKind kind) { setOptions(question, options, kind); }

  /// The answer of ask(), computed without the interpreter's lock; its warnings are told.
  Answer answer();

  /// The answer of a query that no question has. @param nearest its nearest pair, as nearestOf() has it
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
