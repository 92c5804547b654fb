// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/e57/reader.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>
#include <pcl_bsh/search/find_field.h>

#include <cmath>
#include <limits>

namespace pcl_bsh::io {

namespace {

using Field = pcl::PCLPointField;
using Kind = E57Value::Kind;
constexpr std::size_t points_at_once = 4096; ///< whose columns the caches hold

/// Reads the next values of a stream to places that lie `step` apart.
template <class T>
void decodeE57(E57Streams& streams, std::size_t stream, const E57Value& value, std::size_t count, std::uint8_t* to,
               std::size_t step)
{
  std::uint64_t greatest = 0;
  const auto read = [&](auto&& meant) {
    streams.read(stream, value.bits(), count,
                 [&](std::size_t i, std::uint64_t bits) { store(to + i * step, static_cast<T>(meant(bits))); });
  };
  const auto integer = [&, least = static_cast<std::uint64_t>(value.minimum)](std::uint64_t bits) {
    greatest = std::max(greatest, bits);
    return static_cast<std::int64_t>(least + bits);
  };
  if (value.kind == Kind::integer) read(integer);
  if constexpr (std::is_floating_point_v<T>) {
    if (value.kind == Kind::single_float)
      read([](std::uint64_t bits) { return std::bit_cast<float>(static_cast<std::uint32_t>(bits)); });
  }
  if constexpr (std::is_same_v<T, double>) {
    if (value.kind == Kind::double_float) read([](std::uint64_t bits) { return std::bit_cast<double>(bits); });
    if (value.kind == Kind::scaled)
      read([&, scale = value.scale, offset = value.offset](std::uint64_t bits) {
        return static_cast<double>(integer(bits)) * scale + offset;
      });
  }
  if (value.isInteger() && greatest > value.range())
    throw FormatError("is damaged: a value of '" + value.name + "' is above its maximum");
}

/// The values of cartesianInvalidState and sphericalInvalidState that matter.
constexpr int state_point = 0, state_direction = 1;

/// The types that the values of one field have in all scans.
struct FieldTypes {
  std::string field;
  bool is_double = false, is_single = false, is_integer = false;
  std::int64_t minimum = std::numeric_limits<std::int64_t>::max(), maximum = std::numeric_limits<std::int64_t>::min();

  void add(const E57Value& value)
  {
    is_double = is_double || value.kind == Kind::double_float || value.kind == Kind::scaled;
    is_single = is_single || value.kind == Kind::single_float;
    is_integer = is_integer || value.kind == Kind::integer;
    if (value.column > E57Column::blue && value.column < E57Column::none) is_single = true; // normals are turned
    constexpr std::int64_t most = std::int64_t{1} << 53; // that a column of numbers holds
    if (value.column != E57Column::none && (value.minimum < -most || value.maximum > most)) is_double = true;
    minimum = std::min(minimum, value.minimum);
    maximum = std::max(maximum, value.maximum);
  }

  std::uint8_t datatype() const
  {
    const auto within = [&](std::int64_t least, std::int64_t most) { return minimum >= least && maximum <= most; };
    if (is_double || (is_single && is_integer)) return Field::FLOAT64;
    if (is_single) return Field::FLOAT32;
    if (within(0, 0xff)) return Field::UINT8;
    if (within(-0x80, 0x7f)) return Field::INT8;
    if (within(0, 0xffff)) return Field::UINT16;
    if (within(-0x8000, 0x7fff)) return Field::INT16;
    if (within(0, 0xffffffff)) return Field::UINT32;
    return within(-0x80000000LL, 0x7fffffff) ? Field::INT32 : Field::INT64;
  }
};

/// From spherical coordinates to Cartesian ones.
void straighten(std::vector<double>& x, std::vector<double>& y, std::vector<double>& z, std::size_t points)
{
  for (std::size_t i = 0; i < points; ++i) {
    const double range = x[i], azimuth = y[i], elevation = z[i], flat = range * std::cos(elevation);
    x[i] = flat * std::cos(azimuth);
    y[i] = flat * std::sin(azimuth);
    z[i] = range * std::sin(elevation);
  }
}

void turnColumns(const Eigen::Matrix3d& by, const Eigen::Vector3d& to, std::vector<double>& x, std::vector<double>& y,
                 std::vector<double>& z, std::size_t points)
{
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector3d turned = by * Eigen::Vector3d(x[i], y[i], z[i]) + to;
    x[i] = turned.x();
    y[i] = turned.y();
    z[i] = turned.z();
  }
}

} // namespace

E57Reader::E57Reader(std::unique_ptr<ByteSource> file, std::optional<std::size_t> scan, bool beams)
: pages_(std::move(file)),
  contents_(parseE57Contents(pages_.xml()))
{
  std::vector<E57Scan>& scans = contents_.scans;
  if (scan && *scan >= scans.size())
    throw FormatError("has " + counted(scans.size(), "scan") + ", and no scan " + std::to_string(*scan),
                      "count from 0");
  if (scan) scans = {scans[*scan]};
  if (scans.size() > std::numeric_limits<std::uint16_t>::max())
    throw FormatError("has " + counted(scans.size(), "scan") + ", more than can be numbered",
                      "export them to several files");
  layOut(beams);
  requireRoom();
  for (std::vector<double>& column : columns_) column.resize(points_at_once);
}

void E57Reader::layOut(bool beams)
{
  std::vector<FieldTypes> fields;
  bool has_colours = false;
  for (const E57Scan& scan : contents_.scans) {
    has_colours = has_colours || scan.has_colours;
    for (const E57Value& value : scan.values) {
      if (value.field.empty() || value.kind == Kind::unread) continue;
      const auto same = [&](const FieldTypes& other) { return other.field == value.field; };
      auto found = std::find_if(fields.begin(), fields.end(), same);
      if (found == fields.end()) found = fields.insert(found, FieldTypes{value.field});
      found->add(value);
    }
  }
  for (const char* axis : {"x", "y", "z"}) addField(cloud_, axis, Field::FLOAT64);
  if (has_colours) addField(cloud_, "rgb", Field::FLOAT32);
  if (beams) {
    beams_at_ = cloud_.point_step;
    for (const std::string_view name : beam_field_names) addField(cloud_, std::string(name), Field::FLOAT32);
  }
  for (const FieldTypes& field : fields) addField(cloud_, field.field, field.datatype());
  if (contents_.scans.size() > 1) addField(cloud_, scan_field_name, Field::UINT16);
  cloud_.height = 1;
}

/// Refuses counts of points that the file has no room for, before memory is asked for. A point takes a bit of the file
/// at least, and its record no more than most_growth times its share of the file.
void E57Reader::requireRoom()
{
  constexpr std::uint64_t most_growth = 512;
  const auto require = [](std::uint64_t promised, std::uint64_t most) {
    if (promised > most)
      throw FormatError("is truncated: its header promises " + counted(promised, "point") + ", its size allows " +
                        std::to_string(most) + " at most");
  };
  std::uint64_t bits_left = 8 * pages_.size();
  for (const E57Scan& scan : contents_.scans) {
    std::uint64_t bits = 0;
    for (const E57Value& value : scan.values) bits += value.bits();
    require(scan.points, bits_left / std::max<std::uint64_t>(bits, 1));
    bits_left -= scan.points * std::max<std::uint64_t>(bits, 1);
    size_ += scan.points;
  }
  require(size_, pages_.size() * most_growth / cloud_.point_step);
}

CloudFacts E57Reader::facts() const
{
  CloudFacts facts;
  std::string texts;
  bool are_known = true;
  for (const E57Scan& scan : contents_.scans) {
    are_known = are_known && (scan.points == 0 || scan.has_pose || scan.is_spherical);
    facts.scanners.push_back(
        {scan.place.x(), scan.place.y(), scan.place.z(), scan.turn.w(), scan.turn.x(), scan.turn.y(), scan.turn.z()});
    for (const E57Value& value : scan.values) {
      const std::string quoted = " '" + value.name + "'";
      if (value.field.empty() && value.column == E57Column::none && texts.find(quoted) == std::string::npos)
        texts += quoted;
    }
  }
  if (!facts.scanners.empty()) facts.viewpoint = facts.scanners.front();
  if (!are_known) facts.scanners.clear();
  facts.coordinate_system = contents_.coordinate_system;
  facts.unit = LengthUnit::m; // of all E57 files
  if (!texts.empty()) facts.remarks.push_back("its points have texts, which are not read:" + texts);
  return facts;
}

void E57Reader::beginScan()
{
  const E57Scan& scan = contents_.scans[scan_];
  streams_.emplace(pages_, scan.section_at, scan.values.size());
  fields_.clear();
  absent_.clear();
  for (const E57Value& value : scan.values)
    fields_.push_back(value.kind == Kind::unread ? nullptr : findField(cloud_, value.field));
  for (std::size_t f = 3; f < cloud_.fields.size(); ++f)
    if (std::find(fields_.begin(), fields_.end(), &cloud_.fields[f]) == fields_.end() &&
        !isBeamField(cloud_.fields[f].name))
      absent_.push_back(&cloud_.fields[f]);
}

/// Writes directions of beams. Called before the scan's pose moves the columns of coordinates.
void E57Reader::putBeams(std::uint8_t* records, std::size_t points)
{
  const Eigen::Matrix3d rotation = contents_.scans[scan_].turn.toRotationMatrix();
  for (std::size_t i = 0; i < points; ++i) {
    Eigen::Vector3f beam = Eigen::Vector3f::Zero();
    if (column(E57Column::state)[i] == state_direction) {
      const Eigen::Vector3d way(column(E57Column::x)[i], column(E57Column::y)[i], column(E57Column::z)[i]);
      const double length = way.stableNorm();
      if (length > 0 && std::isfinite(length)) beam = (rotation * (way / length)).cast<float>();
    }
    store(records + i * cloud_.point_step + *beams_at_, std::array{beam.x(), beam.y(), beam.z()});
  }
}

void E57Reader::readBatch(std::uint8_t* records, std::size_t points)
{
  const E57Scan& scan = contents_.scans[scan_];
  const std::size_t step = cloud_.point_step;
  std::fill_n(column(E57Column::state).begin(), points, 0.0);
  for (std::size_t s = 0; s < fields_.size(); ++s) {
    const E57Value& value = scan.values[s];
    if (value.column != E57Column::none) {
      auto* const numbers = reinterpret_cast<std::uint8_t*>(column(value.column).data());
      decodeE57<double>(*streams_, s, value, points, numbers, sizeof(double));
    }
    else if (fields_[s]) {
      withFieldType(fields_[s]->datatype, [&](auto zero) {
        decodeE57<decltype(zero)>(*streams_, s, value, points, records + fields_[s]->offset, step);
      });
    }
  }
  std::vector<double>&x = column(E57Column::x), &y = column(E57Column::y), &z = column(E57Column::z);
  if (scan.is_spherical) {
    for (std::size_t i = 0; i < points; ++i)
      if (column(E57Column::state)[i] == state_direction) x[i] = 1; // which has no range
    straighten(x, y, z, points);
  }
  if (beams_at_) putBeams(records, points);
  const Eigen::Matrix3d rotation = scan.turn.toRotationMatrix();
  if (scan.has_pose) turnColumns(rotation, scan.place, x, y, z, points);
  if (scan.has_normals)
    turnColumns(rotation, Eigen::Vector3d::Zero(), column(E57Column::normal_x), column(E57Column::normal_y),
                column(E57Column::normal_z), points);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < points; ++i) {
    const bool is_point = column(E57Column::state)[i] == state_point;
    const std::array place = {is_point ? x[i] : nan, is_point ? y[i] : nan, is_point ? z[i] : nan};
    store(records + i * step, place);
  }
  const auto fill = [&](const Field& field, auto&& numberOf) {
    withFieldType(field.datatype, [&](auto zero) {
      for (std::size_t i = 0; i < points; ++i)
        store(records + i * step + field.offset, static_cast<decltype(zero)>(numberOf(i)));
    });
  };
  for (std::size_t s = 0; s < fields_.size(); ++s)
    if (fields_[s] && scan.values[s].column != E57Column::none)
      fill(*fields_[s], [&](std::size_t i) { return column(scan.values[s].column)[i]; });
  for (const Field* const field : absent_) {
    const bool is_float = field->datatype == Field::FLOAT32 || field->datatype == Field::FLOAT64;
    if (field->name == scan_field_name) {
      fill(*field, [&](std::size_t) { return scan_; });
    }
    else if (field->name != "rgb") {
      fill(*field, [&](std::size_t) { return is_float ? nan : 0; });
    }
    else {
      const auto byteOf = [&](std::size_t channel, std::size_t i) {
        const auto [least, most] = scan.colour_limits[channel];
        const double value = column(E57Column(static_cast<std::size_t>(E57Column::red) + channel))[i];
        const double byte = std::round((value - least) / (most - least) * 255);
        return static_cast<std::uint32_t>(byte > 0 ? std::min(byte, 255.0) : 0.0);
      };
      for (std::size_t i = 0; i < points; ++i)
        store(records + i * step + field->offset,
              scan.has_colours ? byteOf(0, i) << 16U | byteOf(1, i) << 8U | byteOf(2, i) : 0U);
    }
  }
}

std::size_t E57Reader::read(std::uint8_t* records, std::size_t most)
{
  std::size_t done = 0;
  while (done < most && scan_ < contents_.scans.size()) {
    const std::uint64_t left = contents_.scans[scan_].points - next_;
    if (left == 0) {
      ++scan_;
      next_ = 0;
      streams_.reset();
      continue;
    }
    if (!streams_) beginScan();
    const auto points = static_cast<std::size_t>(std::min<std::uint64_t>({most - done, points_at_once, left}));
    readBatch(records + done * cloud_.point_step, points);
    done += points;
    next_ += points;
  }
  return done;
}

} // namespace pcl_bsh::io
