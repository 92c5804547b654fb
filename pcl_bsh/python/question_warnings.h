// SPDX-License-Identifier: BSD-3-Clause
// What a question's answer does not say by itself, as Python's warnings.
#pragma once

#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/threads/callback.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/question/warnings.h>

#include <optional>
#include <string>
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

/// The arguments a, pose_a, b and pose_b of a query.
struct TwoPlaced {
  TwoPlaced(const SphereHierarchy& cloud_a, const PoseLike& pose_a, const SphereHierarchy& cloud_b,
            const PoseLike& pose_b)
  : a(cloud_a, poseOf("pose_a", pose_a)),
    b(cloud_b, poseOf("pose_b", pose_b))
  {
  }
  Asked asked(std::optional<double> clearance, bool measures = false) const
  {
    return {"a", a, "b", b.hierarchy(), {b.pose}, clearance, measures};
  }
  Placed a, b;
};

/// @param measures how far the points are apart, too: once for the arrays that a hierarchy stands on, for a planner
/// asks
///   about the same clouds thousands of times; not of points with radii, which are taken for the balls of a surface
NamedCloud factsOf(std::string name, const SphereHierarchy& hierarchy, bool measures);

/// While nobody changes the hierarchies, and without the interpreter's lock.
std::vector<Warning> warningsOf(const Asked& asked);

/// By warnings.warn(), which tells each sentence once for a line of Python, unless its filters say otherwise.
void warn(const std::string& text);

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
  for (const Warning& warning : warnings) warn(warning.text);
  return found;
}

} // namespace pcl_bsh::python
