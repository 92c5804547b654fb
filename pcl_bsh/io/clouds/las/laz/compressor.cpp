// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/fields.h>
#include <pcl_bsh/io/clouds/las/laz/compressor.h>
#include <pcl_bsh/io/clouds/stored_number.h>
#include <pcl_bsh/io/text/format_error.h>

#include <fstream> // laszip_api.h puts the namespace std into the global one
#include <laszip/laszip_api.h>
#include <sstream>
#include <utility>

namespace pcl_bsh::io {

bool writesLaz()
{
  return true;
}

namespace {

constexpr const char* write_las = "write a .las file";

} // namespace

struct LazCompressor::Laszip {
  laszip_POINTER handle = nullptr;
  laszip_point* point = nullptr; ///< of the handle: what it writes next
  std::uint8_t format;
  std::size_t record_length;
  std::ostringstream bytes;
  bool is_open = false;

  Laszip(std::uint8_t point_format, std::size_t length) : format(point_format), record_length(length)
  {
    if (laszip_create(&handle) != 0) throw FormatError("cannot be compressed: LASzip does not start", write_las);
  }

  ~Laszip()
  {
    if (is_open) laszip_close_writer(handle);
    laszip_destroy(handle);
  }

  Laszip(const Laszip&) = delete;
  Laszip& operator=(const Laszip&) = delete;

  /// @throws FormatError with LASzip's words where it failed
  void require(laszip_I32 failed) const
  {
    if (failed == 0) return;
    laszip_CHAR* error = nullptr;
    laszip_get_error(handle, &error);
    throw FormatError(std::string("cannot be compressed: LASzip says: ") + (error ? error : "nothing"), write_las);
  }

  /// The struct begins as formats 0 to 5 do. Formats 6 to 10 have fields of their own there, and LASzip asks that the
  /// old flags are the same.
  void take(const char* from)
  {
    constexpr std::size_t old_bytes = 20;
    const auto byteAt = [&](std::size_t at) { return unsigned{static_cast<std::uint8_t>(from[at])}; };
    std::size_t at = old_bytes;
    if (format < 6) {
      std::memcpy(static_cast<void*>(point), from, old_bytes);
    }
    else {
      constexpr std::size_t same_bytes = 14; // x y z intensity
      std::memcpy(static_cast<void*>(point), from, same_bytes);
      point->extended_point_type = 1;
      point->extended_return_number = byteAt(14) & 15U;
      point->extended_number_of_returns = (byteAt(14) >> 4U) & 15U;
      point->extended_classification_flags = byteAt(15) & 15U;
      point->extended_scanner_channel = (byteAt(15) >> 4U) & 3U;
      point->scan_direction_flag = (byteAt(15) >> 6U) & 1U;
      point->edge_of_flight_line = (byteAt(15) >> 7U) & 1U;
      point->synthetic_flag = byteAt(15) & 1U;
      point->keypoint_flag = (byteAt(15) >> 1U) & 1U;
      point->withheld_flag = (byteAt(15) >> 2U) & 1U;
      point->extended_classification = static_cast<laszip_U8>(byteAt(16));
      point->user_data = static_cast<laszip_U8>(byteAt(17));
      point->extended_scan_angle = loaded<std::int16_t>(from + 18);
      point->point_source_ID = loaded<std::uint16_t>(from + 20);
      at = 22;
    }
    const auto next = [&](void* to, std::size_t size) {
      std::memcpy(to, from + at, size);
      at += size;
    };
    if (format != 0 && format != 2) next(&point->gps_time, sizeof point->gps_time);
    const bool has_infrared = format == 8 || format == 10;
    if (hasLasColours(format)) next(point->rgb, (has_infrared ? 4 : 3) * sizeof *point->rgb);
    if (hasLasWaves(format)) next(point->wave_packet, sizeof point->wave_packet);
    if (at < record_length) next(point->extra_bytes, record_length - at);
  }
};

LazCompressor::LazCompressor(std::uint8_t format, std::size_t record_length)
: laszip_(std::make_unique<Laszip>(format, record_length))
{
  Laszip& laszip = *laszip_;
  laszip.require(laszip_set_point_type_and_size(laszip.handle, format, static_cast<laszip_U16>(record_length)));
  laszip.require(laszip_request_native_extension(laszip.handle, 1));
  laszip_U8* record = nullptr;
  laszip_U32 bytes = 0;
  laszip.require(laszip_create_laszip_vlr(laszip.handle, &record, &bytes));
  record_.assign(reinterpret_cast<const char*>(record), bytes);
  laszip.require(laszip_open_writer_stream(laszip.handle, laszip.bytes, 1, 1));
  laszip.is_open = true;
  laszip.require(laszip_get_point_pointer(laszip.handle, &laszip.point));
}

LazCompressor::~LazCompressor() = default;

void LazCompressor::add(std::string_view points)
{
  for (std::size_t at = 0; at < points.size(); at += laszip_->record_length) {
    laszip_->take(points.data() + at);
    laszip_->require(laszip_write_point(laszip_->handle));
  }
}

std::string LazCompressor::finish(std::uint64_t points_at)
{
  laszip_->is_open = false;
  laszip_->require(laszip_close_writer(laszip_->handle));
  std::string bytes = std::move(laszip_->bytes).str();
  const auto table_at = loaded<std::int64_t>(bytes.data()); // from the first of these bytes
  store(bytes.data(), table_at + static_cast<std::int64_t>(points_at));
  return bytes;
}

} // namespace pcl_bsh::io
