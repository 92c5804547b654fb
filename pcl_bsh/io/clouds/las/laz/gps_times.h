// SPDX-License-Identifier: BSD-3-Clause
// Times of points, as integers of the doubles' bits, in up to four sequences that points change between: of GPSTIME11
// version 2, and of POINT14.
#pragma once

#include <pcl_bsh/io/clouds/las/laz/integer_decompressor.h>

#include <array>
#include <cstdint>

namespace pcl_bsh::io::laz {

class GpsTimes {
public:
  /// @param unchanged whether a symbol says that the time is the one before
  explicit GpsTimes(bool unchanged) : left_out_(unchanged ? 0 : 1), zero_(6 - left_out_), multiples_(516 - left_out_) {}

  /// @param last the bits of the time before. @return those of the next time
  std::uint64_t read(ArithmeticDecoder& in, std::uint64_t last);

private:
  void readMultiple(ArithmeticDecoder& in, std::uint32_t symbol);
  void add(std::int32_t difference) { times_[last_] += static_cast<std::uint64_t>(std::int64_t{difference}); }
  void countExtreme(std::int32_t difference);
  void readHuge(ArithmeticDecoder& in);

  unsigned left_out_; ///< of the symbols
  SymbolModel zero_, multiples_;
  IntegerDecompressor differences_{32, 9};
  std::array<std::uint64_t, 4> times_{};          ///< the last of each sequence
  std::array<std::int32_t, 4> last_difference_{}; ///< of each sequence
  std::array<unsigned, 4> extremes_{};            ///< how often differences were far from the last, since a reset
  unsigned last_ = 0, newest_ = 0;                ///< sequences
};

} // namespace pcl_bsh::io::laz
