// SPDX-License-Identifier: BSD-3-Clause
// Poses as text.
#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

class TextCursor;

/// All numbers of the cursor's line: separated by blanks, by tabs, by commas or by semicolons, but not by several of
/// them, for `1,5;2,5` may be two numbers or four. As an exception, semicolons may separate rows of four numbers, as of
/// a matrix, and another separator the numbers. @throws FormatError naming the line
std::vector<double> numbersOfLine(TextCursor& text);

/// All numbers of a text, line by line. @throws FormatError
std::vector<double> numbersOf(std::string_view text);

/// Translation, then angles in radians: R = Rz(yaw) Ry(pitch) Rx(roll), as pcl::getTransformation() has it.
Eigen::Isometry3d poseFrom(double x, double y, double z, double roll, double pitch, double yaw);

/// x y z roll pitch yaw, or the 12 or 16 numbers of a 3x4 or 4x4 matrix, row by row. Whether that is rigid is for the
/// query to judge. @throws FormatError for any other number of numbers
Eigen::Isometry3d poseFrom(const std::vector<double>& numbers);

/// A warning about angles of more than two turns, which may be degrees.
std::optional<std::string> warningOfAngles(const std::vector<double>& numbers);

/// A file of the 12 or 16 numbers of a pose's matrix, row by row. @throws files::FileError
Eigen::Isometry3d readPose(const std::filesystem::path& path);

} // namespace pcl_bsh::io
