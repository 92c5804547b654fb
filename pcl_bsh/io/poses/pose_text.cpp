// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <pcl_bsh/question/warnings/warnings.h>

#include <string>

namespace pcl_bsh::io {

std::vector<double> numbersOfLine(TextCursor& text)
{
  constexpr std::size_t matrix_columns = 4;
  std::vector<double> numbers;
  const bool in_rows = text.line().find(';') != std::string_view::npos;
  text.separateBy(separatorOf(text.line()));
  std::size_t columns = 0;
  while (!text.line().empty()) {
    if (!in_rows) {
      numbers.push_back(text.number<double>());
      continue;
    }
    TextCursor row(text.word());
    if (!row.nextLine()) text.fail("has an empty value");
    row.separateBy(separatorOf(row.line()));
    const std::size_t before = numbers.size();
    while (!row.line().empty()) text.naming([&] { numbers.push_back(parseNumber<double>(row.word())); });
    if (columns == 0) columns = numbers.size() - before;
    if (columns != numbers.size() - before || (columns != 1 && columns != matrix_columns)) {
      text.fail("separates numbers by several characters, or has decimal commas",
                "separate them alike, and write decimal points");
    }
  }
  return numbers;
}

std::vector<double> numbersOf(std::string_view text)
{
  std::vector<double> numbers;
  TextCursor cursor(text, '#');
  while (cursor.nextLine()) {
    const std::vector<double> line = numbersOfLine(cursor);
    numbers.insert(numbers.end(), line.begin(), line.end());
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
  if (n.size() != 12 && n.size() != 16) throw FormatError("holds " + counted(n.size(), "number"));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < n.size(); ++i) {
    pose.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = n[i];
  }
  return pose;
}

std::optional<std::string> warningOfAngles(const std::vector<double>& n)
{
  return n.size() == 6 ? pcl_bsh::warningOfAngles(n[3], n[4], n[5]) : std::nullopt;
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
    throw files::FileError(path, error.what(), "give the 12 or 16 numbers of a pose's matrix, row by row");
  }
}

} // namespace pcl_bsh::io
