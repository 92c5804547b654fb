// SPDX-License-Identifier: BSD-3-Clause
// Names of several obstacles, and pairs of them that do not count against each other.
//
//   const IgnoredPairs ignored({"press:c*", "input:mill"}, {"press", "crane", "mill"});
//   ignored.holds("crane", "press"); // true
#pragma once

#include <pcl_bsh/export.h>

#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The name of the input among those of obstacles.
inline constexpr auto kInputName = "input";

/// @throws InvalidInput for two obstacles of one name, one without a name, and one that has the input's
void checkObstacleNames(const std::vector<std::string>& names);

/// Returns for each name whether one of the patterns fits it. Patterns are those of IgnoredPairs.
/// @param option that has the patterns. @throws InvalidInput for a pattern that no name matches
std::vector<bool> fittingNames(const char* option, const std::vector<std::string>& patterns,
                               const std::vector<std::string>& names);

/// Two obstacles, or an obstacle and the input, that do not count against each other.
class IgnoredPairs {
public:
  IgnoredPairs() = default; ///< none

  /// @param texts FIRST:SECOND each, where * stands for any letters. A colon, a star or a backslash of a name has a
  ///   backslash before it; before any other letter a backslash is itself. @param obstacles all their names
  /// @throws InvalidInput for another text, and for a pattern that no name matches
  IgnoredPairs(const std::vector<std::string>& texts, const std::vector<std::string>& obstacles);

  /// Whether the two do not count against each other, in either order.
  bool holds(const std::string& one, const std::string& other) const;

private:
  std::vector<std::pair<std::string, std::string>> patterns_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
