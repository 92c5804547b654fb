// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/files/file_error.h>
#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/filters/pose_files/pose_file.h>
#include <pcl_bsh/filters/pose_files/pose_text.h>
#include <pcl_bsh/filters/pose_files/rigid_pose.h>
#include <pcl_bsh/filters/text_files/file_bytes.h>
#include <pcl_bsh/filters/text_files/format_error.h>
#include <pcl_bsh/filters/text_files/number_text.h>
#include <pcl_bsh/filters/text_files/text_cursor.h>

#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/query/request_check.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace pcl_bsh::io {

namespace {

constexpr auto forms_of_a_pose =
    "give 12 or 16 numbers of a rigid matrix, row by row, or time tx ty tz qx qy qz qw, a pose to "
    "a line";

Eigen::Isometry3d fromMatrix(const std::vector<double>& numbers)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    pose.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = numbers[i];
  }
  return pose;
}

Eigen::Isometry3d fromQuaternion(const std::vector<double>& n, const TextCursor& cursor)
{
  const Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
  const double length = rotation.norm();
  if (!(std::abs(length - 1) <= 1e-3))
    cursor.fail("has a quaternion of length " + numberText(length, std::chars_format::general, 6) + ", not 1");
  Eigen::Isometry3d pose(rotation.normalized());
  pose.translation() = Eigen::Vector3d(n[1], n[2], n[3]);
  return pose;
}

/// Refuses a pose that a query would refuse.
void requireRigid(const Eigen::Isometry3d& pose, const TextCursor& cursor)
{
  try {
    checkPose("pose", pose);
  }
  catch (const InvalidInput& error) {
    cursor.fail("holds no pose, " + error.wrong());
  }
}

} // namespace

std::vector<Eigen::Isometry3d> parsePoses(std::string_view text, std::vector<std::string>* warnings)
{
  std::vector<Eigen::Isometry3d> poses;
  std::size_t columns = 0;
  std::size_t replaced = 0; // matrices that others took the place of
  double worst = 0;         // deviation of these
  TextCursor cursor(text, '#');
  while (cursor.nextLine()) {
    const std::vector<double> numbers = numbersOfLine(cursor);
    const std::string count = std::to_string(numbers.size());
    if (numbers.size() != 8 && numbers.size() != 12 && numbers.size() != 16) {
      cursor.fail("has " + count + " numbers, not 8, 12 or 16");
    }
    if (columns != 0 && numbers.size() != columns) {
      cursor.fail("has " + count + " numbers, the lines before have " + std::to_string(columns));
    }
    columns = numbers.size();
    const RigidPose rigid = nearestRigid(columns == 8 ? fromQuaternion(numbers, cursor) : fromMatrix(numbers));
    requireRigid(rigid.pose, cursor);
    poses.push_back(rigid.pose);
    if (rigid.deviation > 0) ++replaced;
    worst = std::max(worst, rigid.deviation);
  }
  if (poses.empty()) throw FormatError("holds no pose");
  if (warnings && replaced > 0)
    warnings->push_back(std::to_string(replaced) + " of " + std::to_string(poses.size()) + " poses: the worst " +
                        nearestRotationWarning(worst));
  return poses;
}

std::vector<Eigen::Isometry3d> readPoses(const std::filesystem::path& path, std::vector<std::string>* warnings)
{
  const FileBytes file(path);
  try {
    std::vector<std::string> found;
    std::vector<Eigen::Isometry3d> poses = parsePoses(file.view(), &found);
    if (warnings)
      for (const std::string& warning : found) warnings->push_back(path.string() + ": " + warning);
    return poses;
  }
  catch (const FormatError& error) {
    throw files::FileError(path, error.what(), forms_of_a_pose);
  }
}

void writePoses(const std::filesystem::path& path, const std::vector<Eigen::Isometry3d>& poses)
{
  files::replaceFile(path, [&](std::ostream& out) {
    for (const Eigen::Isometry3d& pose : poses) {
      for (int i = 0; i < 12; ++i) {
        out << (i == 0 ? "" : " ") << numberText(pose.matrix()(i / 4, i % 4));
      }
      out << '\n';
    }
  });
}

} // namespace pcl_bsh::io
