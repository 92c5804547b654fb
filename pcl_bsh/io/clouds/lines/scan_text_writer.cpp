// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/lines/field_text.h>
#include <pcl_bsh/io/clouds/lines/scan_text.h>
#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/clouds/records.h>

#include <pcl_bsh/search/cloud_view.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <optional>

namespace pcl_bsh::io {

namespace {

/// Takes a field out of a list. None where it is not there, or has several values.
std::optional<pcl::PCLPointField> take(Fields& fields, const std::string& name)
{
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const auto& field) { return field.name == name && field.count <= 1; });
  if (found == fields.end()) return std::nullopt;
  const pcl::PCLPointField field = *found;
  fields.erase(found);
  return field;
}

/// The values in a point's line behind x y z. Readers tell the meaning of values by their number, so values are written
/// only where their number gives the right meaning.
struct LineFields {
  std::optional<pcl::PCLPointField> intensity, scan;
  Fields values; ///< in the line's order

  LineFields(const pcl::PCLPointCloud2& cloud, const std::string& extension, bool several_scans)
  {
    Fields left = namedForFiles(namedFields(cloud), ply_channels);
    for (const char* axis : {"x", "y", "z"}) take(left, axis);
    if (several_scans) scan = take(left, "scan");
    intensity = take(left, "intensity");
    if (intensity) values.push_back(*intensity);
    Fields colours;
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto channel = take(left, ply_channels[k])) colours.push_back(*channel);
    const bool coloured = colours.size() == 3 && std::all_of(colours.begin(), colours.end(), [](const auto& channel) {
                            return channel.datatype == pcl::PCLPointField::UINT8;
                          });
    if (coloured) values.insert(values.end(), colours.begin(), colours.end());
    const std::size_t most = !intensity ? 0 : coloured ? left.size() : 1; // unnamed columns
    for (std::size_t k = 0; k < most; ++k)
      if (const auto column = take(left, "column_" + std::to_string(values.size() + 4))) values.push_back(*column);
    if (!colours.empty() && !coloured) left.insert(left.end(), colours.begin(), colours.end());
    if (!left.empty())
      throw FormatError("field '" + left[0].name + "' has no place in a " + extension, "write a .pcd instead");
  }

  void append(std::string& text, const pcl::PCLPointCloud2& cloud, std::size_t i) const
  {
    for (const pcl::PCLPointField& field : values) {
      text += ' ';
      appendNumber(text, field.datatype, valueAt(cloud, i, field));
    }
    text += '\n';
  }

  static const char* valueAt(const pcl::PCLPointCloud2& cloud, std::size_t i, const pcl::PCLPointField& field)
  {
    return reinterpret_cast<const char*>(cloud.data.data()) + i * cloud.point_step + field.offset;
  }
};

void appendNumbers(std::string& text, const Eigen::Vector3d& p)
{
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (k > 0) text += ' ';
    appendNumber(text, pcl::PCLPointField::FLOAT64, reinterpret_cast<const char*>(&p[k]));
  }
}

/// Appends x y z in the type that the cloud has, so that float32 gets no more digits than it holds.
void appendCoordinates(std::string& text, const PointsView& view, std::size_t i)
{
  const std::uint8_t type = view.scalar == Scalar::float32 ? pcl::PCLPointField::FLOAT32 : pcl::PCLPointField::FLOAT64;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k > 0) text += ' ';
    appendNumber(text, type, static_cast<const char*>(view.data) + i * view.stride + view.offset[k]);
  }
}

/// Gives the text to the stream where it has grown large.
void flush(std::ostream& out, std::string& text, std::size_t most = std::size_t{1} << 20)
{
  if (text.size() < most) return;
  out << text;
  text.clear();
}

Eigen::Isometry3d poseOf(const Viewpoint& viewpoint)
{
  const Eigen::Matrix<double, 7, 1> v = Eigen::Map<const Eigen::Matrix<double, 7, 1>>(viewpoint.data());
  const Eigen::Quaterniond turn(v[3], v[4], v[5], v[6]);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (!v.allFinite() || !(turn.norm() > 0.0)) return pose;
  pose.linear() = turn.normalized().toRotationMatrix();
  pose.translation() = v.head<3>();
  return pose;
}

std::string ptxHeader(std::size_t columns, std::size_t rows, const Eigen::Isometry3d& pose)
{
  std::string text = std::to_string(columns) + '\n' + std::to_string(rows) + '\n';
  const auto line = [&](const Eigen::Vector3d& numbers, const char* end) {
    appendNumbers(text, numbers);
    text += end;
  };
  line(pose.translation(), "\n");
  for (Eigen::Index k = 0; k < 3; ++k) line(pose.linear().col(k), "\n");
  for (Eigen::Index k = 0; k < 3; ++k) line(pose.linear().col(k), " 0\n");
  line(pose.translation(), " 1\n");
  return text;
}

/// Points [begin, end) of a cloud are a scan.
struct ScanRange {
  std::size_t begin = 0, end = 0;
};

std::vector<ScanRange> scansOf(const pcl::PCLPointCloud2& cloud, const std::optional<pcl::PCLPointField>& scan)
{
  const std::size_t count = std::size_t{cloud.width} * cloud.height;
  std::vector<ScanRange> scans = {{0, count}};
  if (!scan) return scans;
  for (std::size_t i = 1; i < count; ++i) {
    const auto bytes = static_cast<std::size_t>(sizeOf(scan->datatype));
    if (std::memcmp(LineFields::valueAt(cloud, i, *scan), LineFields::valueAt(cloud, i - 1, *scan), bytes) == 0)
      continue;
    scans.back().end = i;
    scans.push_back({i, count});
  }
  return scans;
}

} // namespace

Fields fieldsForScans(const pcl::PCLPointCloud2& cloud, bool several_scans)
{
  Fields held;
  for (const pcl::PCLPointField& field : cloud.fields) {
    const bool coordinate = field.name == "x" || field.name == "y" || field.name == "z";
    if (coordinate || field.name == "intensity" || field.name == "rgb" || field.name.starts_with("column_") ||
        (several_scans && field.name == "scan"))
      held.push_back(field);
  }
  return held;
}

void writePts(std::ostream& out, const pcl::PCLPointCloud2& cloud)
{
  const LineFields fields(cloud, ".pts", false);
  const PointsView view = viewOf(cloud);
  std::size_t finite = 0;
  for (std::uint32_t i = 0; i < view.count; ++i) finite += isFinite(view.point(i)) ? 1 : 0;
  std::string text = std::to_string(finite) + '\n';
  for (std::uint32_t i = 0; i < view.count; ++i) {
    if (!isFinite(view.point(i))) continue;
    appendCoordinates(text, view, i);
    fields.append(text, cloud, i);
    flush(out, text);
  }
  flush(out, text, 0);
}

void writePtx(std::ostream& out, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint)
{
  const LineFields fields(cloud, ".ptx", true);
  const PointsView view = viewOf(cloud);
  const bool moved = viewpoint != no_viewpoint;
  const Eigen::Isometry3d pose = moved ? poseOf(viewpoint) : Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d scanner = pose.inverse();
  std::string nothing = "0 0 0";
  for (std::size_t k = 0; k < fields.values.size(); ++k) nothing += " 0";
  nothing += '\n';
  const auto intensityAt = [&](std::size_t i) {
    double value = 0.0;
    if (fields.intensity) {
      withFieldType(fields.intensity->datatype, [&](auto typed) {
        std::memcpy(&typed, LineFields::valueAt(cloud, i, *fields.intensity), sizeof typed);
        value = static_cast<double>(typed);
      });
    }
    return value;
  };
  std::string text;
  const auto append = [&](std::size_t i) {
    const Point3 given = view.point(static_cast<std::uint32_t>(i));
    if (!isFinite(given)) {
      text += nothing;
      return;
    }
    const Eigen::Vector3d p =
        moved ? scanner * Eigen::Vector3d(given[0], given[1], given[2]) : Eigen::Vector3d(given[0], given[1], given[2]);
    const double intensity = p.isZero(0.0) ? intensityAt(i) : 1.0;
    if (intensity == 0.0 || intensity == 0.5) {
      throw FormatError("point " + std::to_string(i) + " is at the scanner, where PTX says that nothing was seen",
                        "write a .pts instead, or leave the point out");
    }
    if (moved)
      appendNumbers(text, p);
    else
      appendCoordinates(text, view, i);
    fields.append(text, cloud, i);
  };
  for (const ScanRange& scan : scansOf(cloud, fields.scan)) {
    const bool organised = !fields.scan && cloud.height > 1;
    const std::size_t rows = organised ? cloud.height : 1, columns = (scan.end - scan.begin) / rows;
    text += ptxHeader(columns, rows, pose);
    for (std::size_t i = 0; i < columns * rows; ++i) {
      append(scan.begin + i % rows * columns + i / rows);
      flush(out, text);
    }
  }
  flush(out, text, 0);
}

} // namespace pcl_bsh::io
