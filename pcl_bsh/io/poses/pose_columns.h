// SPDX-License-Identifier: BSD-3-Clause
// Which columns of a table of poses are position and rotation, by the names in its first line.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

class TextCursor;

/// Where x y z of the position and x y z w of the quaternion stand in a line.
struct PoseColumns {
  std::array<std::size_t, 3> position = {};
  std::array<std::size_t, 4> quaternion = {};
  std::size_t count = 0; ///< of all columns
};

/// The last part of a name is the axis, the parts before it say of what: tx qw (TUM), p_RS_R_x [m] q_RS_w [] (EuRoC),
/// field.pose.position.x field.pose.orientation.w (ROS), position_x, x; in any case of letters.
/// @return none unless each of the seven is there once
std::optional<PoseColumns> poseColumnsOf(const std::vector<std::string>& names);

/// The words of a line, separated as separatorOf() has it. Takes them off the line.
std::vector<std::string> wordsOfLine(TextCursor& line);

} // namespace pcl_bsh::io
