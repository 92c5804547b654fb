// SPDX-License-Identifier: BSD-3-Clause
// What a question's answer does not say by itself, as Python's warnings.
#pragma once

#include <pcl_bsh/python/callback.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/question/warnings.h>

#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh::python {

/// Two clouds, by the names of the arguments, and where the second is in the world.
struct Asked {
  const char* name_a;
  const Placed& a;
  const char* name_b;
  const SphereHierarchy& b;
  std::vector<Eigen::Isometry3d> poses_b;
  std::optional<double> clearance; ///< none: distances are asked for
  bool measures = false;           ///< how far points are apart, too: once for the points of a hierarchy
};

/// While nobody changes the hierarchies, and without the interpreter's lock.
std::vector<Warning> warningsOf(const Asked& asked);

/// By warnings.warn(), which tells each sentence once for a line of Python, unless its filters say otherwise.
void warn(const std::vector<Warning>& warnings);

/// The query's answer, computed without the interpreter's lock; then its question's warnings.
template <class Query>
auto answered(const Asked& asked, Query&& query)
{
  std::vector<Warning> warnings;
  auto found = unlocked([&] {
    auto answer = query();
    warnings = warningsOf(asked);
    return answer;
  });
  warn(warnings);
  return found;
}

} // namespace pcl_bsh::python
