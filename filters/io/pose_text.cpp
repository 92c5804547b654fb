// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/cloud_file_error.h>
#include <pcl_bsh/filters/io/file_bytes.h>
#include <pcl_bsh/filters/io/pose_text.h>
#include <pcl_bsh/filters/io/text_cursor.h>

#include <string>

namespace pcl_bsh::io {

std::vector<double> numbersOf(std::string_view text)
{
  std::vector<double> numbers;
  TextCursor cursor(text, '#', ",;");
  while (cursor.nextLine()) {
    while (!cursor.line().empty()) numbers.push_back(cursor.number<double>());
  }
  return numbers;
}

Eigen::Isometry3d poseFrom(double x, double y, double z, double roll, double pitch, double yaw)
{
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return Eigen::Translation3d(x, y, z) * AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
         AngleAxisd(roll, Vector3d::UnitX());
}

Eigen::Isometry3d poseFrom(const std::vector<double>& n)
{
  if (n.size() == 6) return poseFrom(n[0], n[1], n[2], n[3], n[4], n[5]);
  if (n.size() != 12 && n.size() != 16) throw FormatError("holds " + std::to_string(n.size()) + " numbers");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < n.size(); ++i) {
    pose.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = n[i];
  }
  return pose;
}

Eigen::Isometry3d readPose(const std::filesystem::path& path)
{
  const FileBytes file(path);
  try {
    const std::vector<double> numbers = numbersOf(file.view());
    if (numbers.size() == 6) throw FormatError("holds 6 numbers");
    return poseFrom(numbers);
  }
  catch (const FormatError& error) {
    throw CloudFileError(path, error.what(), "give the 12 or 16 numbers of a pose's matrix, row by row");
  }
}

} // namespace pcl_bsh::io
