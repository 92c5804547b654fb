// SPDX-License-Identifier: BSD-3-Clause
// LAS files put together byte by byte from the specification (1.4 R15), without the code under test.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace pcl_bsh::io {

template <typename T>
void put(std::string& bytes, std::size_t at, T value)
{
  if (bytes.size() < at + sizeof value) bytes.resize(at + sizeof value);
  std::memcpy(&bytes[at], &value, sizeof value);
}

template <typename T>
T get(const std::string& bytes, std::size_t at)
{
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// A LAS file of random points; its members are what can be chosen, header() and text() follow from them.
struct LasSample {
  std::uint8_t minor = 4, format = 6;
  std::array<double, 3> scale = {0.01, 0.001, 0.0001}, offset = {600000, -5e6, 12.5};
  std::string user_bytes;           ///< between the header and the records
  std::vector<std::string> records; ///< with their heads
  std::string padding;              ///< before the points
  std::vector<std::string> extended;
  std::size_t extra_bytes = 0; ///< per point
  std::uint16_t global_encoding = 0;
  std::vector<std::string> points;

  static constexpr std::array<std::size_t, 11> lengths = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

  LasSample(std::uint8_t minor_version, std::uint8_t point_format, std::size_t extra = 0)
  : minor(minor_version),
    format(point_format),
    extra_bytes(extra)
  {
  }

  std::size_t length() const { return lengths[format] + extra_bytes; }

  void addPoints(std::size_t count, unsigned seed = 5)
  {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < count; ++i) {
      std::string point(length(), '\0');
      for (char& byte : point) byte = static_cast<char>(random());
      points.push_back(point);
    }
  }

  static std::string record(const std::string& user, std::uint16_t id, const std::string& content)
  {
    std::string bytes(54, '\0');
    bytes.replace(2, user.size(), user);
    put(bytes, 18, id);
    put(bytes, 20, static_cast<std::uint16_t>(content.size()));
    bytes.replace(22, 9, "described");
    return bytes + content;
  }

  static std::string extendedRecord(const std::string& user, std::uint16_t id, const std::string& content)
  {
    std::string bytes(60, '\0');
    bytes.replace(2, user.size(), user);
    put(bytes, 18, id);
    put(bytes, 20, std::uint64_t{content.size()});
    return bytes + content;
  }

  /// The descriptor of one of the extra bytes. @param options which of no_data (1), scale (8), offset (16) count
  static std::string descriptor(std::uint8_t type, const std::string& name, std::uint8_t options = 0,
                                double scale_by = 0, double move_by = 0, std::uint64_t no_data = 0)
  {
    std::string bytes(192, '\0');
    put(bytes, 2, type);
    put(bytes, 3, options);
    bytes.replace(4, name.size(), name);
    for (std::size_t k = 0; k < 3; ++k) {
      put(bytes, 40 + 8 * k, no_data);
      put(bytes, 112 + 8 * k, scale_by);
      put(bytes, 136 + 8 * k, move_by);
    }
    return bytes;
  }

  std::size_t headerSize() const { return (minor >= 4 ? 375 : minor == 3 ? 235 : 227) + user_bytes.size(); }

  std::string text() const
  {
    std::string bytes(headerSize() - user_bytes.size(), '\0');
    bytes.replace(0, 4, "LASF");
    put(bytes, 6, global_encoding);
    bytes[24] = 1;
    bytes[25] = static_cast<char>(minor);
    bytes.replace(26, 4, "TEST");
    put(bytes, 94, static_cast<std::uint16_t>(headerSize()));
    std::size_t at = headerSize() + padding.size();
    for (const std::string& one : records) at += one.size();
    put(bytes, 96, static_cast<std::uint32_t>(at));
    put(bytes, 100, static_cast<std::uint32_t>(records.size()));
    put(bytes, 104, format);
    put(bytes, 105, static_cast<std::uint16_t>(length()));

    std::array<std::uint64_t, 16> returns{};
    std::array<std::array<double, 2>, 3> bounds{};
    for (std::size_t k = 0; k < 3; ++k) bounds[k] = {-HUGE_VAL, HUGE_VAL};
    for (const std::string& point : points) {
      ++returns[static_cast<unsigned char>(point[14]) & (format >= 6 ? 15 : 7)];
      for (std::size_t k = 0; k < 3; ++k) {
        const double value = get<std::int32_t>(point, 4 * k) * scale[k] + offset[k];
        bounds[k] = {std::max(bounds[k][0], value), std::min(bounds[k][1], value)};
      }
    }
    const bool old_counts = minor < 4 || format < 6;
    put(bytes, 107, static_cast<std::uint32_t>(old_counts ? points.size() : 0));
    for (std::size_t i = 0; i < 5; ++i)
      put(bytes, 111 + 4 * i, static_cast<std::uint32_t>(old_counts ? returns[i + 1] : 0));
    for (std::size_t k = 0; k < 3; ++k) {
      put(bytes, 131 + 8 * k, scale[k]);
      put(bytes, 155 + 8 * k, offset[k]);
      put(bytes, 179 + 16 * k, points.empty() ? 0 : bounds[k][0]);
      put(bytes, 187 + 16 * k, points.empty() ? 0 : bounds[k][1]);
    }
    const std::size_t end = at + points.size() * length();
    if (minor >= 3) put(bytes, 227, std::uint64_t{(global_encoding & 2U) != 0 ? end : 0});
    if (minor >= 4) {
      put(bytes, 235, std::uint64_t{extended.empty() ? 0 : end});
      put(bytes, 243, static_cast<std::uint32_t>(extended.size()));
      put(bytes, 247, std::uint64_t{points.size()});
      for (std::size_t i = 0; i < 15; ++i) put(bytes, 255 + 8 * i, returns[i + 1]);
    }
    bytes += user_bytes;
    for (const std::string& one : records) bytes += one;
    bytes += padding;
    for (const std::string& point : points) bytes += point;
    for (const std::string& one : extended) bytes += one;
    return bytes;
  }
};

} // namespace pcl_bsh::io
