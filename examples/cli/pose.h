// SPDX-License-Identifier: BSD-3-Clause
// Poses as users write them.
#pragma once

#include "program.h"

#include <pcl_bsh/filters/io/cloud_file_error.h>
#include <pcl_bsh/filters/io/file_bytes.h>
#include <pcl_bsh/filters/io/text_cursor.h>

#include <Eigen/Geometry>

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// All numbers of a text, separated by blanks, commas, semicolons or line ends. @throws io::FormatError
inline std::vector<double> numbersOf(std::string_view text)
{
  std::vector<double> numbers;
  io::TextCursor cursor(text, '#', ",;");
  while (cursor.nextLine()) {
    while (!cursor.line().empty()) numbers.push_back(cursor.number<double>());
  }
  return numbers;
}

/// Translation, then angles in radians: R = Rz(yaw) Ry(pitch) Rx(roll), as pcl::getTransformation() has it.
inline Eigen::Isometry3d poseFrom(double x, double y, double z, double roll, double pitch, double yaw)
{
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return Eigen::Translation3d(x, y, z) * AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
         AngleAxisd(roll, Vector3d::UnitX());
}

/// A file of the 12 or 16 numbers of a 3x4 or 4x4 matrix, row by row. Whether it is rigid is for the query to judge.
/// @throws io::CloudFileError
inline Eigen::Isometry3d readPose(const std::filesystem::path& path)
{
  const io::FileBytes file(path);
  try {
    const std::vector<double> numbers = numbersOf(file.view());
    if (numbers.size() != 12 && numbers.size() != 16) {
      throw io::FormatError("holds " + std::to_string(numbers.size()) + " numbers");
    }
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      matrix(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = numbers[i];
    }
    Eigen::Isometry3d pose;
    pose.matrix() = matrix;
    return pose;
  }
  catch (const io::FormatError& error) {
    throw io::CloudFileError(path, error.what(), "give the 12 or 16 numbers of a pose's matrix, row by row");
  }
}

/// What stands behind an option for a pose: six numbers x,y,z,roll,pitch,yaw or the name of a file for readPose().
/// @throws UsageError when it is neither, io::CloudFileError as readPose() does
inline Eigen::Isometry3d parsePose(const std::string& option, const std::string& text)
{
  if (std::filesystem::exists(text)) return readPose(text);
  try {
    const std::vector<double> n = numbersOf(text);
    if (n.size() == 6) return poseFrom(n[0], n[1], n[2], n[3], n[4], n[5]);
  }
  catch (const io::FormatError&) {
    // Not numbers, and no file either.
  }
  throw UsageError(option + ": '" + text +
                   "' is neither six numbers nor a file: give x,y,z,roll,pitch,yaw or a file name");
}

} // namespace pcl_bsh::cli
