// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/lines/scan_text.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>
#include <pcl_bsh/io/clouds/lines/text_rows.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/io/text/header_count.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace pcl_bsh::io {

namespace {

/// The words of the line that comes next, which is not taken.
std::vector<std::string_view> nextWords(TextCursor text)
{
  std::vector<std::string_view> words;
  if (text.nextLine())
    while (!text.line().empty()) words.push_back(text.word());
  return words;
}

/// The meaning of a point's values, by the first point's line.
struct PointLine {
  Fields values;
  bool shares = false; ///< colours are shares of 1

  explicit PointLine(const std::vector<std::string_view>& words)
  {
    for (const char* axis : {"x", "y", "z"}) values.push_back(textValue(axis));
    const std::size_t count = words.size();
    if (count > 3 && count != 6) values.push_back(textValue("intensity", pcl::PCLPointField::FLOAT32));
    if (count == 6 || count >= 7) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (words[values.size()].find('.') != std::string_view::npos) shares = true;
        values.push_back(textValue(ply_channels[k], pcl::PCLPointField::UINT8));
      }
    }
    while (values.size() < count) values.push_back(textValue("column_" + std::to_string(values.size() + 1)));
  }

  std::size_t intensity() const { return values.size() > 3 && values[3].name == "intensity" ? 3 : 0; }
};

/// Takes the next line as a point.
class PointReader {
public:
  /// @param remedy for words that are no numbers
  explicit PointReader(PointLine line, const char* remedy = remedy_for_damage)
  : line_(std::move(line)),
    numbers_(line_.values.size()),
    remedy_(remedy)
  {
  }

  /// @return false when the next line has other words than numbers; nothing has happened then
  bool nextPlain(TextCursor& text)
  {
    if (!text.nextNumbers(numbers_)) return false;
    checkColours(text);
    return true;
  }

  /// @return false at the end of the text
  bool next(TextCursor& text)
  {
    if (nextPlain(text)) return true;
    if (!text.nextLine()) return false;
    try {
      for (double& number : numbers_) number = text.number<double>();
    }
    catch (const FormatError& error) {
      throw FormatError(error.what(), error.remedy() == remedy_for_damage ? remedy_ : error.remedy());
    }
    text.requireEndOfLine();
    checkColours(text);
    return true;
  }

  std::vector<double>& numbers() { return numbers_; }

private:
  void checkColours(const TextCursor& text)
  {
    for (std::size_t i = 3; i < numbers_.size(); ++i) {
      if (line_.values[i].datatype != pcl::PCLPointField::UINT8) continue;
      if (line_.shares) numbers_[i] = std::round(numbers_[i] * 255);
      if (!(numbers_[i] >= 0 && numbers_[i] <= 255 && std::trunc(numbers_[i]) == numbers_[i])) {
        text.fail("has a colour that is no whole number from 0 to 255");
      }
    }
  }

  PointLine line_;
  std::vector<double> numbers_;
  std::string remedy_;
};

std::optional<std::uint64_t> countOf(const std::vector<std::string_view>& words)
{
  return words.size() == 1 ? numberOf<std::uint64_t>(words[0]) : std::nullopt;
}

/// Reads a block's count, if there is one.
std::optional<std::uint64_t> readPtsCount(TextCursor& text)
{
  const std::optional<std::uint64_t> count = countOf(nextWords(text));
  if (!count) return std::nullopt;
  text.nextLine();
  constexpr std::uint64_t least_bytes = 6; // three digits and their separators
  requireBytes(*count, least_bytes, text.rest().size() + 1);
  return count;
}

/// Whether the first line is a comment, names columns or separates values otherwise than PTS: then all lines are
/// columns.
bool isPtsOfColumns(std::string_view file)
{
  TextCursor text(file);
  if (!text.nextLine()) return false;
  const std::string_view line = text.line();
  return line.starts_with('#') || line.starts_with("//") || separatorOf(line) == ',' || separatorOf(line) == ';' ||
         !looksLikeNumber(TextCursor(text).word());
}

PointLine ptsLine(const TextCursor& text, std::uint64_t promised)
{
  TextCursor line = text;
  const std::vector<std::string_view> words = nextWords(text);
  if (words.size() >= 3) return PointLine(words);
  if (line.nextLine()) line.fail("is no point: it has fewer than three numbers");
  if (promised > 0) throw FormatError("is truncated: its header promises points, and there are none");
  return PointLine({"", "", ""});
}

/// Whether a line has more than one word, as those of points have and those of counts have not.
bool isOfSeveralWords(std::string_view line)
{
  return line.find_first_of(" \t,;") != std::string_view::npos;
}

struct PtxScan {
  bool has_header = false;
  std::uint64_t columns = 0, rows = 0;
  Eigen::Matrix<double, 4, 3> transform = Eigen::Matrix<double, 4, 3>::Zero(); ///< (x y z 1) times this
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity(); ///< the scanner's rotation, after takeTransform()
};

/// Refuses points behind the last that a scan's header counts. The text is at the line behind that.
void requireNoMorePoints(TextCursor text, const PtxScan& scan)
{
  std::uint64_t there = scan.columns * scan.rows;
  do {
    if (!isOfSeveralWords(text.line())) break;
    ++there;
  } while (text.nextLine());
  requireNoMore({scan.columns * scan.rows}, there);
}

/// Reads a scan's ten lines. @param scan the one before, or none of points
/// @return false at the end of the text
bool readPtxScan(TextCursor& text, PtxScan& scan)
{
  if (!text.nextLine()) return false;
  if (scan.has_header) requireNoMorePoints(text, scan);
  scan.has_header = true;
  const auto next = [&](bool there) {
    if (!there) throw FormatError("is truncated: it ends within a scan's header");
  };
  const auto last = [&] { text.requireEndOfLine(); };
  scan.columns = text.number<std::uint32_t>();
  last();
  next(text.nextLine());
  scan.rows = text.number<std::uint32_t>();
  last();
  for (std::size_t i = 0; i < 4; ++i) { // the registered position and axes, which the transform has, too
    next(text.nextLine());
    for (std::size_t k = 0; k < 3; ++k) text.number<double>();
    last();
  }
  for (Eigen::Index i = 0; i < 4; ++i) {
    next(text.nextLine());
    for (Eigen::Index k = 0; k < 3; ++k) scan.transform(i, k) = text.number<double>();
    if (text.number<double>() != (i == 3 ? 1 : 0)) text.fail("does not end with 0 0 0 1, as a transform's rows do");
    last();
  }
  if (!scan.transform.allFinite()) text.fail("ends a transform that is not finite");
  constexpr std::uint64_t least_bytes = 6; // three digits and their separators
  requireBytes(scan.columns * scan.rows, least_bytes, text.rest().size() + 1);
  return true;
}

/// Replaces the linear part of a transform by that of rigidPart(), and sets the scanner's rotation.
/// @return |R'R - I| of the given transform where another takes its place, else 0
/// @throws FormatError for one that is no rigid motion
double takeTransform(PtxScan& scan, std::size_t number, bool allow_scale)
{
  const RigidPart part = rigidPart(scan.transform.topRows<3>().transpose(), allow_scale);
  if (!part.wrong.empty()) {
    throw FormatError("scan " + std::to_string(number) + " has a transform that " + part.wrong,
                      part.scales ? remedy_for_scale
                                  : "export it again with the scanner's pose, a rotation and a position");
  }
  scan.transform.topRows<3>() = part.linear.transpose();
  scan.turn = part.rotation;
  return part.deviation;
}

/// Counts the transforms that the nearest rotation replaced.
struct ReplacedTransforms {
  std::size_t count = 0, worst = 0;
  double deviation = 0; ///< of the worst

  void add(std::size_t scan, double off)
  {
    if (off > 0) ++count;
    if (off <= deviation) return;
    worst = scan;
    deviation = off;
  }

  void tell(std::vector<std::string>* remarks) const
  {
    if (!remarks || count == 0) return;
    remarks->push_back("transform of scan " + std::to_string(worst) +
                       (count > 1 ? ", the worst of " + std::to_string(count) : "") + ": " +
                       nearestRotationWarning(deviation));
  }
};

Viewpoint scannerPose(const PtxScan& scan)
{
  const Eigen::Quaterniond q(scan.turn);
  const Eigen::Vector3d at = scan.transform.row(3);
  return {at.x(), at.y(), at.z(), q.w(), q.x(), q.y(), q.z()};
}

/// Moves a point into the common frame, or makes it NaN where the scanner saw nothing.
void place(const PtxScan& scan, std::size_t intensity, std::vector<double>& numbers)
{
  const Eigen::RowVector3d point(numbers[0], numbers[1], numbers[2]);
  const bool at_scanner = numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0;
  const bool no_return = at_scanner && (intensity == 0 || numbers[intensity] == 0 || numbers[intensity] == 0.5);
  const Eigen::RowVector3d turned = point * scan.transform.topRows<3>();
  const Eigen::RowVector3d placed = turned + scan.transform.row(3);
  for (Eigen::Index k = 0; k < 3; ++k)
    numbers[static_cast<std::size_t>(k)] = no_return ? std::numeric_limits<double>::quiet_NaN() : placed[k];
}

/// How many scans there are, and how the first wanted one's points look.
struct PtxContents {
  std::size_t scans = 0;
  std::optional<PointLine> line;

  PtxContents(std::string_view file, std::optional<std::size_t> wanted, bool allow_scale)
  {
    TextCursor text(file);
    for (PtxScan scan; readPtxScan(text, scan); ++scans) {
      if (wanted.value_or(scans) == scans) takeTransform(scan, scans, allow_scale);
      const std::vector<std::string_view> words = nextWords(text);
      const bool empty = scan.columns * scan.rows == 0;
      if (!empty && words.size() < 3) text.fail("is followed by no point");
      if (!empty && !line && wanted.value_or(scans) == scans) line = PointLine(words);
      for (std::uint64_t i = 0; i < scan.columns * scan.rows; ++i)
        if (!text.nextLine() || !isOfSeveralWords(text.line())) requireNoFewer({scan.columns * scan.rows}, i);
    }
    if (scans == 0) throw FormatError("is not a PTX file: it has no scan");
    if (wanted && *wanted >= scans) {
      throw FormatError("has " + counted(scans, "scan") + ", and no scan " + std::to_string(*wanted), "count from 0");
    }
    if (!line) line = PointLine({"", "", ""});
  }

  Fields values(bool several) const
  {
    Fields values = line->values;
    if (several) values.push_back(textValue("scan", pcl::PCLPointField::UINT16));
    return values;
  }
};

/// Reorders points from column by column to row by row.
void transpose(pcl::PCLPointCloud2& cloud, const PtxScan& scan)
{
  const auto columns = static_cast<std::size_t>(scan.columns), rows = static_cast<std::size_t>(scan.rows);
  const std::size_t step = cloud.point_step;
  std::vector<std::uint8_t> turned(cloud.data.size());
  for (std::size_t i = 0; i < columns * rows; ++i) {
    const std::size_t to = i % rows * columns + i / rows;
    std::memcpy(&turned[to * step], &cloud.data[i * step], step);
  }
  cloud.data = std::move(turned);
  cloud.width = static_cast<std::uint32_t>(columns);
  cloud.height = static_cast<std::uint32_t>(rows);
  cloud.row_step = cloud.width * cloud.point_step;
}

} // namespace

pcl::PCLPointCloud2 parsePts(std::string_view file, std::vector<std::string>* remarks)
{
  if (isPtsOfColumns(file)) return parseColumns(file, {}, remarks);
  TextCursor text(file);
  std::optional<std::uint64_t> promised = readPtsCount(text);
  const PointLine line = ptsLine(text, promised.value_or(0));
  TextRows rows(line.values);
  rows.reserveLines(text.rest());
  PointReader reader(line, "where a column holds no numbers, name all columns in a first line, as x y z name");
  std::uint64_t points = 0, all_promised = 0, all_points = 0; // in this block; in blocks with a count
  const auto endBlock = [&] {
    if (!promised) return;
    requireNoFewer({*promised}, points);
    all_promised += *promised;
    all_points += points;
  };
  for (;;) {
    if (!reader.nextPlain(text)) {
      if (countOf(nextWords(text))) {
        endBlock();
        promised = readPtsCount(text);
        points = 0;
        continue;
      }
      if (!reader.next(text)) break;
    }
    rows.add(reader.numbers());
    ++points;
  }
  endBlock();
  const auto other = remarkOnCount({all_promised}, all_points);
  if (remarks && other) remarks->push_back(*other);
  return std::move(rows).finished();
}

pcl::PCLPointCloud2 parsePtsHeader(std::string_view file, bool whole)
{
  if (isPtsOfColumns(file)) return parseColumnNames(file, whole);
  TextCursor text(file);
  const std::uint64_t promised = readPtsCount(text).value_or(0);
  return TextRows(ptsLine(text, promised).values).finished();
}

pcl::PCLPointCloud2 parsePtx(std::string_view file, Viewpoint& viewpoint, std::optional<std::size_t> wanted,
                             std::vector<Viewpoint>* scanners, bool allow_scale, std::vector<std::string>* remarks)
{
  const PtxContents contents(file, wanted, allow_scale);
  const bool several = contents.scans > 1 && !wanted;
  TextRows rows(contents.values(several));
  rows.reserveLines(file);
  PointReader reader(*contents.line);
  viewpoint = no_viewpoint;
  TextCursor text(file);
  PtxScan scan, only;
  ReplacedTransforms replaced;
  for (std::size_t number = 0; readPtxScan(text, scan); ++number) {
    const bool kept = wanted.value_or(number) == number;
    if (kept) replaced.add(number, takeTransform(scan, number, allow_scale));
    if (number == wanted.value_or(0)) viewpoint = scannerPose(scan);
    if (kept) only = scan;
    if (scanners && kept) scanners->push_back(scannerPose(scan));
    for (std::uint64_t i = 0; i < scan.columns * scan.rows; ++i) {
      if (!kept) {
        text.nextLine();
        continue;
      }
      if (!reader.next(text)) throw FormatError("is truncated: it ends before the last of its points");
      std::vector<double>& numbers = reader.numbers();
      place(scan, contents.line->intensity(), numbers);
      rows.add(numbers);
      if (several) rows.put(rows.size() - 1, numbers.size(), static_cast<double>(number));
    }
  }
  replaced.tell(remarks);
  pcl::PCLPointCloud2 cloud = std::move(rows).finished();
  if (!several && only.columns > 0 && only.rows > 0) transpose(cloud, only);
  return cloud;
}

pcl::PCLPointCloud2 parsePtxHeader(std::string_view file, std::optional<std::size_t> wanted, bool allow_scale)
{
  const PtxContents contents(file, wanted, allow_scale);
  return TextRows(contents.values(contents.scans > 1 && !wanted)).finished();
}

} // namespace pcl_bsh::io
