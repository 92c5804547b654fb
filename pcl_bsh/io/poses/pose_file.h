// SPDX-License-Identifier: BSD-3-Clause
// Trajectories as text: one pose a line.
#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// Reads a pose from each line; numbers are separated as numbersOfLine() has it. A '#' that begins a line, or stands
/// behind a blank, begins a comment; lines without a number are ignored. A first line without numbers, or a comment
/// before the first pose, may name the columns: then position and quaternion are where it says, and other columns are
/// not read. Otherwise the number of numbers in a line, equal in the whole file, tells how a pose is written:
///
///   12  the upper three rows of its matrix, row by row (KITTI)
///   16  all four rows
///    8  time tx ty tz qx qy qz qw (TUM); the time is not used, the quaternion is normalised
///
/// If the first line begins with `waypoints`, the file has places and headings of a way (waypoints.h). The poses along
/// the way are returned then.
///
/// The nearest rotation replaces a matrix with |R'R - I| from 1e-6 to 1e-4, as few printed digits leave it.
///
/// @param warnings if not null, gets a line that counts the replaced matrices
/// @throws files::FileError naming the file and the line: another number of numbers, or not that of the lines before; a
///   word that is no number; a matrix that is not rigid (|R'R - I| > 1e-4, a mirror, a last row other than 0 0 0 1).
///   Also a quaternion whose length is off 1 by more than 1e-3; a value that is not finite; a file that cannot be read
///   or holds no pose.
std::vector<Eigen::Isometry3d> readPoses(const std::filesystem::path& path,
                                         std::vector<std::string>* warnings = nullptr);

/// Reads the poses of a text. @throws FormatError naming the line
std::vector<Eigen::Isometry3d> parsePoses(std::string_view text, std::vector<std::string>* warnings = nullptr);

/// Writes twelve numbers a line, which read back to the same bits. The file appears complete or not at all.
/// @throws files::FileError
void writePoses(const std::filesystem::path& path, const std::vector<Eigen::Isometry3d>& poses);

} // namespace pcl_bsh::io
