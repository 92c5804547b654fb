// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/io/poses/waypoints.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/query/request_check.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

namespace pcl_bsh::io {

namespace {

constexpr auto forms_of_a_pose =
    "give 12 or 16 numbers of a rigid matrix, row by row, or time tx ty tz qx qy qz qw, a pose to "
    "a line; or a first line that names the columns, tx ty tz qx qy qz qw among them";

/// @param n time tx ty tz qx qy qz qw
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

/// Where x y z of the position and x y z w of the quaternion stand in a line.
struct PoseColumns {
  std::array<std::size_t, 3> position = {};
  std::array<std::size_t, 4> quaternion = {};
  std::size_t count = 0; ///< of all columns
};

/// Parts of a name in small letters, without a unit in brackets.
std::vector<std::string> partsOf(std::string_view name)
{
  std::vector<std::string> parts(1);
  for (const char c : name.substr(0, name.find_first_of("[("))) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      parts.back() += c;
    else if (!parts.back().empty())
      parts.emplace_back();
  }
  if (parts.size() > 1 && parts.back().empty()) parts.pop_back();
  for (std::string& part : parts) part = inSmallLetters(part);
  return parts;
}

struct Meaning {
  bool rotation = false;
  std::size_t axis = 0; ///< of x y z w
};

std::optional<Meaning> meaningOf(const std::string& name)
{
  std::vector<std::string> parts = partsOf(name);
  if (parts.back().empty()) return std::nullopt;
  const std::size_t axis = std::string_view("xyzw").find(parts.back().back());
  parts.back().pop_back(); // tx is t and x
  if (parts.back().empty()) parts.pop_back();
  if (axis == std::string_view::npos) return std::nullopt;
  const auto has = [&](std::initializer_list<std::string_view> words) {
    return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
      return std::find(words.begin(), words.end(), part) != words.end();
    });
  };
  const std::string first = parts.empty() ? "" : parts.front();
  const bool rotation = first == "q" || has({"quaternion", "quat", "orientation", "rotation", "rot"});
  const bool position = first.empty() || first == "t" || first == "p" || has({"position", "pos", "translation"});
  if (rotation) return Meaning{true, axis};
  return position && axis < 3 ? std::optional<Meaning>({false, axis}) : std::nullopt;
}

/// The last part of a name is the axis, the parts before it say of what: tx qw (TUM), p_RS_R_x [m] q_RS_w [] (EuRoC),
/// field.pose.position.x field.pose.orientation.w (ROS), position_x, x; in any case of letters.
/// @return none unless each of the seven is there once
std::optional<PoseColumns> poseColumnsOf(const std::vector<std::string>& names)
{
  PoseColumns columns;
  columns.count = names.size();
  std::array<int, 7> found = {};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<Meaning> meaning = meaningOf(names[i]);
    if (!meaning) continue;
    (meaning->rotation ? columns.quaternion[meaning->axis] : columns.position[meaning->axis]) = i;
    ++found[meaning->axis + (meaning->rotation ? 3 : 0)];
  }
  if (std::any_of(found.begin(), found.end(), [](int times) { return times != 1; })) return std::nullopt;
  return columns;
}

/// The words of a line, separated as separatorOf() has it. Takes them off the line.
std::vector<std::string> wordsOfLine(TextCursor& line)
{
  line.separateBy(separatorOf(line.line()));
  std::vector<std::string> words;
  while (!line.line().empty()) words.emplace_back(line.word());
  return words;
}

/// The last comment before the first pose that names the columns.
std::optional<PoseColumns> columnsInComments(std::string_view text)
{
  std::optional<PoseColumns> columns;
  for (TextCursor cursor(text); cursor.nextLine() && cursor.line().starts_with('#');) {
    TextCursor comment(cursor.line().substr(1));
    if (!comment.nextLine()) continue;
    if (const auto named = poseColumnsOf(wordsOfLine(comment))) columns = named;
  }
  return columns;
}

/// Whether nothing in the line is a number or meant for one.
bool namesColumns(const std::vector<std::string>& words)
{
  return std::none_of(words.begin(), words.end(), looksLikeNumber);
}

/// The line's pose as time tx ty tz qx qy qz qw.
std::vector<double> numbersByName(TextCursor& cursor, const PoseColumns& columns)
{
  const TextCursor line = cursor;
  const std::vector<std::string> words = wordsOfLine(cursor);
  if (words.size() != columns.count)
    line.fail("has " + counted(words.size(), "value") + ", and " + counted(columns.count, "column is", "columns are") +
              " named");
  std::vector<double> numbers = {0.0};
  const auto take = [&](std::size_t column) {
    line.naming([&] { numbers.push_back(parseNumber<double>(words[column])); });
  };
  for (const std::size_t column : columns.position) take(column);
  for (const std::size_t column : columns.quaternion) take(column);
  return numbers;
}

} // namespace

std::vector<Eigen::Isometry3d> parsePoses(std::string_view text, std::vector<std::string>* warnings)
{
  if (areWaypoints(text)) return posesAlong(parseWaypoints(text));
  std::vector<Eigen::Isometry3d> poses;
  std::size_t columns = 0;
  std::size_t replaced = 0; // matrices that the nearest rotation replaced
  double worst = 0;         // the greatest deviation of these
  TextCursor cursor(text, '#');
  std::optional<PoseColumns> named = columnsInComments(text);
  for (bool first = true; cursor.nextLine(); first = false) {
    TextCursor line = cursor;
    const std::vector<std::string> words = first ? wordsOfLine(line) : std::vector<std::string>();
    if (first && namesColumns(words)) {
      named = poseColumnsOf(words);
      if (!named) cursor.fail("names columns, and not one each of tx ty tz qx qy qz qw");
      continue;
    }
    if (first && named && named->count != words.size()) named.reset(); // a comment on something else
    const std::vector<double> numbers = named ? numbersByName(cursor, *named) : numbersOfLine(cursor);
    const std::string count = std::to_string(numbers.size());
    if (numbers.size() != 8 && numbers.size() != 12 && numbers.size() != 16) {
      cursor.fail("has " + count + " numbers, not 8, 12 or 16");
    }
    if (columns != 0 && numbers.size() != columns) {
      cursor.fail("has " + count + " numbers, the lines before have " + std::to_string(columns));
    }
    columns = numbers.size();
    const RigidPose rigid = nearestRigid(columns == 8 ? fromQuaternion(numbers, cursor) : poseFrom(numbers));
    requireRigid(rigid.pose, cursor);
    poses.push_back(rigid.pose);
    if (rigid.deviation > 0) ++replaced;
    worst = std::max(worst, rigid.deviation);
  }
  if (poses.empty()) throw FormatError("holds no pose");
  if (warnings && replaced > 0)
    warnings->push_back(std::to_string(replaced) + " of " + counted(poses.size(), "pose") + ": the worst " +
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
    throw files::FileError(path, error.what(), areWaypoints(file.view()) ? error.remedy() : forms_of_a_pose);
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
