// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/las.h>
#include <pcl_bsh/io/clouds/las/laz/compressor.h>
#include <pcl_bsh/io/clouds/las/plan.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/version.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

namespace pcl_bsh::io {

namespace {

constexpr std::size_t most_returns = 15;

/// Sums over all points for the header.
struct LasSums {
  std::array<std::int32_t, 3> least{}, greatest{};
  std::array<std::uint64_t, most_returns> returns{};
};

LasSums sumsOf(const LasPoints& points, const LasPlan& plan)
{
  LasPlan part = plan; // coordinates and return numbers alone
  std::erase_if(part.targets, [](const LasTarget& target) {
    return target.packed_colour || !(target.field.at < 12 || target.field.name == "return_number");
  });
  const unsigned mask = plan.format >= 6 ? 15 : 7;
  constexpr std::size_t return_at = 14;
  LasSums sums;
  sums.least.fill(std::numeric_limits<std::int32_t>::max());
  sums.greatest.fill(std::numeric_limits<std::int32_t>::min());
  std::string records;
  points.forEachBatch([&](const std::uint8_t* in, std::size_t count) {
    part.encode(in, points.step(), count, records);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto stored = lasNumber<std::int32_t>(records, i * plan.record_length + k * sizeof(std::int32_t));
        sums.least[k] = std::min(sums.least[k], stored);
        sums.greatest[k] = std::max(sums.greatest[k], stored);
      }
      const unsigned number = static_cast<unsigned char>(records[i * plan.record_length + return_at]) & mask;
      if (number > 0) ++sums.returns[number - 1];
    }
  });
  return sums;
}

/// A new public header block of LAS 1.4.
std::string newBlock()
{
  std::string bytes(las_block_bytes, '\0');
  bytes.replace(0, 4, "LASF");
  constexpr std::uint16_t well_known_text = 16; // of coordinate systems: asked for with formats 6 to 10
  setLasNumber(bytes, las_at::global_encoding, well_known_text);
  bytes[las_at::major] = 1;
  bytes.replace(las_at::system, 5, "OTHER");
  const std::string software = "pcl_bsh " PCL_BSH_VERSION_TEXT;
  bytes.replace(las_at::software, software.size(), software);
  const auto today = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
  const auto year = std::chrono::year_month_day(today).year();
  const auto day = today - std::chrono::sys_days(year / 1 / 1);
  setLasNumber(bytes, las_at::day, static_cast<std::uint16_t>(day.count() + 1));
  setLasNumber(bytes, las_at::year, static_cast<std::uint16_t>(static_cast<int>(year)));
  setLasNumber(bytes, las_at::header_size, static_cast<std::uint16_t>(las_block_bytes));
  return bytes;
}

LasRecord recordOf(std::string_view user, std::uint16_t id, std::string_view description, const std::string& content)
{
  std::string record(las_record_head, '\0');
  record.replace(2, user.size(), user);
  setLasNumber(record, 18, id);
  setLasNumber(record, 20, static_cast<std::uint16_t>(content.size()));
  record.replace(22, description.size(), description);
  return {record + content};
}

/// The record of the system of points that come from no LAS file, where it has WKT that such a record can hold.
LasRecords recordsOfSystem(const LasHeader* header)
{
  LasRecords records;
  const std::string wkt = header ? wkt1Of(header->system) : std::string();
  if (!wkt.empty() && wkt.size() < std::numeric_limits<std::uint16_t>::max())
    records.records.push_back(recordOf(las_projection, las_wkt_id, "Coordinate system", wkt + '\0'));
  return records;
}

/// Replaces the description of extra bytes.
void describeExtraBytes(const LasPlan& plan, const LasHeader* header, std::vector<LasRecord>& records)
{
  const auto is_it = [](const LasRecord& record) {
    return record.user() == las_specification && record.id() == las_extra_bytes_id;
  };
  const auto found = std::find_if(records.begin(), records.end(), is_it);
  if (plan.descriptors->empty()) {
    if (found != records.end()) records.erase(found);
    return;
  }
  LasRecord record = recordOf(las_specification, las_extra_bytes_id, "Extra bytes", *plan.descriptors);
  constexpr std::uint16_t signature = 0xaabb; // of LAS 1.0
  if (header != nullptr && header->block.minor == 0) setLasNumber(record.bytes, 0, signature);
  if (found != records.end()) {
    found->bytes = std::move(record.bytes);
  }
  else {
    records.push_back(std::move(record));
  }
}

void setBounds(std::string& block, const LasPlan& plan, const LasSums& sums, const LasHeader* header)
{
  for (std::size_t k = 0; k < 3; ++k) {
    const auto placed = [&](std::int32_t stored) { return stored * plan.scale[k] + plan.offset[k]; };
    std::array<double, 2> bounds = {placed(sums.greatest[k]), placed(sums.least[k])};
    if (plan.scale[k] < 0) std::swap(bounds[0], bounds[1]);
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t at = las_at::bounds + (2 * k + side) * sizeof(double);
      const double given = lasNumber<double>(block, at); // of coordinates before their writer rounded them, perhaps
      const bool right = header != nullptr && std::abs(given - bounds[side]) <= std::abs(plan.scale[k]);
      if (!right) setLasNumber(block, at, bounds[side]);
    }
  }
}

void setCounts(std::string& block, const LasPlan& plan, std::uint64_t points, const LasSums& sums,
               const LasHeader* header)
{
  bool old_counts = plan.minor < 4 || plan.format < 6;
  if (plan.minor >= 4) {
    if (header != nullptr && header->block.points > 0) {
      old_counts = lasNumber<std::uint32_t>(header->before_points, las_at::old_points) != 0;
    }
    setLasNumber(block, las_at::points, points);
    for (std::size_t i = 0; i < most_returns; ++i)
      setLasNumber(block, las_at::returns + i * sizeof(std::uint64_t), sums.returns[i]);
  }
  setLasNumber(block, las_at::old_points, static_cast<std::uint32_t>(old_counts ? points : 0));
  for (std::size_t i = 0; i < 5; ++i) {
    setLasNumber(block, las_at::old_returns + i * sizeof(std::uint32_t),
                 static_cast<std::uint32_t>(old_counts ? sums.returns[i] : 0));
  }
}

/// Moves a place behind the old end of the points to the new end.
void moveBehind(std::string& block, std::size_t at, std::uint64_t old_end, std::uint64_t new_end)
{
  const auto place = lasNumber<std::uint64_t>(block, at);
  if (place >= old_end) setLasNumber(block, at, place - old_end + new_end);
}

} // namespace

void writeLas(std::ostream& out, const pcl::PCLPointCloud2& cloud, const LasHeader* given, bool is_compressed)
{
  const LasHeader* const header = given && given->before_points.empty() ? nullptr : given; // of a LAS file
  const LasPoints points(cloud);
  const LasPlan plan = planLas(points, header);
  const LasSums sums = sumsOf(points, plan);

  std::string block = header == nullptr ? newBlock() : header->before_points.substr(0, header->block.header_size);
  LasRecords between = header == nullptr ? recordsOfSystem(given) : lasRecordsOf(header->before_points, header->block);
  std::string behind = header == nullptr ? std::string() : header->behind_points;
  if (plan.descriptors) {
    describeExtraBytes(plan, header, between.records);
    if (header != nullptr && header->described_behind) {
      setLasNumber(behind, static_cast<std::size_t>(*header->described_behind) + 18, las_superseded_id);
    }
  }
  std::optional<LazCompressor> compressor;
  if (is_compressed) {
    compressor.emplace(plan.format, plan.record_length);
    between.records.push_back({compressor->record()});
  }
  std::uint64_t points_at = block.size() + between.padding.size();
  for (const LasRecord& record : between.records) points_at += record.bytes.size();
  if (points_at > std::numeric_limits<std::uint32_t>::max()) {
    throw FormatError("its records before the points take more than 4 GiB", "write a .pcd instead");
  }

  block[las_at::minor] = static_cast<char>(plan.minor);
  block[las_at::format] = static_cast<char>(plan.format | (is_compressed ? las_compressed : 0));
  setLasNumber(block, las_at::points_at, static_cast<std::uint32_t>(points_at));
  setLasNumber(block, las_at::variable_records, static_cast<std::uint32_t>(between.records.size()));
  setLasNumber(block, las_at::record_length, static_cast<std::uint16_t>(plan.record_length));
  for (std::size_t k = 0; k < 3; ++k) {
    setLasNumber(block, las_at::scale + k * sizeof(double), plan.scale[k]);
    setLasNumber(block, las_at::offset + k * sizeof(double), plan.offset[k]);
  }
  if (points.size() > 0) {
    setBounds(block, plan, sums, header);
  }
  else if (header == nullptr || header->block.points > 0) {
    std::fill_n(block.begin() + las_at::bounds, 6 * sizeof(double), '\0');
  }
  setCounts(block, plan, points.size(), sums, header);
  std::string records, compressed;
  const auto forEachBatch = [&](auto&& use) {
    points.forEachBatch([&](const std::uint8_t* in, std::size_t count) {
      plan.encode(in, points.step(), count, records);
      use(records);
    });
  };
  if (compressor) { // their size tells where the records behind them are
    forEachBatch([&](const std::string& batch) { compressor->add(batch); });
    compressed = compressor->finish(points_at);
  }
  if (header != nullptr) {
    const std::uint64_t old_end = header->block.endOfPoints();
    const std::uint64_t new_end = points_at + (compressor ? compressed.size() : points.size() * plan.record_length);
    if (header->block.waveforms_at != 0) moveBehind(block, las_at::waveforms, old_end, new_end);
    if (header->block.extended_records != 0) moveBehind(block, las_at::extended, old_end, new_end);
  }

  out << block;
  for (const LasRecord& record : between.records) out << record.bytes;
  out << between.padding << compressed;
  if (!compressor) forEachBatch([&](const std::string& batch) { out << batch; });
  out << behind;
}

} // namespace pcl_bsh::io
