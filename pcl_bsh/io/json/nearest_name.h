// SPDX-License-Identifier: BSD-3-Clause
// The valid name that is most like a mistyped one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// How many letters must be added, dropped or replaced to turn one word into the other; case does not count.
std::size_t editDistance(std::string_view a, std::string_view b);

/// The valid name with the least editDistance() to `name`, the first of several. A `name` without dot or colon is also
/// compared with the part of a valid name behind its last dot or colon. A valid name that contains it counts as 1 away
/// at most. Empty when there are no names.
std::string nearestName(std::string_view name, const std::vector<std::string>& valid);

/// "did you mean 'x'?", or what to do where nothing is valid.
std::string suggestion(std::string_view name, const std::vector<std::string>& valid);

/// "a, b, c"
std::string listed(const std::vector<std::string>& names);

} // namespace pcl_bsh::io
