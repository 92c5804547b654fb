// SPDX-License-Identifier: BSD-3-Clause
// Points of LAS compressed by LASzip, where that was found when this was built (liblaszip-dev).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

/// Whether this was built with LASzip.
bool writesLaz();

/// Layered chunks for point formats 6 to 10, chunks of points for 0 to 5; 50,000 points each.
class LazCompressor {
public:
  /// @pre writesLaz(). @param record_length of a point, in bytes
  /// @throws FormatError for what LASzip refuses
  LazCompressor(std::uint8_t format, std::size_t record_length);
  ~LazCompressor();

  /// The variable length record that says how the points are compressed, with its head.
  const std::string& record() const { return record_; }

  /// Takes whole points as LAS has them. @throws FormatError
  void add(std::string_view points);

  /// Ends the last chunk. @param points_at the place in the file of what is returned
  /// @return all points, and the table of their chunks. @throws FormatError
  std::string finish(std::uint64_t points_at);

private:
  struct Laszip;
  std::unique_ptr<Laszip> laszip_;
  std::string record_;
};

} // namespace pcl_bsh::io
