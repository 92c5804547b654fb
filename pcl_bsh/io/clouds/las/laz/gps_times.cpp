// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/laz/gps_times.h>
#include <pcl_bsh/io/text/format_error.h>

namespace pcl_bsh::io::laz {

namespace {

// Symbols of a difference as a multiple of the last; the least is -10.
constexpr std::uint32_t most_multiple = 500, least_multiple = 510, unchanged_multiple = 511;

enum DifferenceContext : unsigned { after_zero, equal, few, many, most, negative, most_negative, none, upper_half };

} // namespace

std::uint64_t GpsTimes::read(ArithmeticDecoder& in, std::uint64_t last)
{
  times_[last_] = last;
  for (std::size_t sequences = 0; sequences <= times_.size(); ++sequences) {
    const bool from_zero = last_difference_[last_] == 0;
    const std::uint32_t unchanged = from_zero ? 0 : unchanged_multiple, huge = from_zero ? 2 : unchanged_multiple + 1;
    std::uint32_t symbol = in.symbol(from_zero ? zero_ : multiples_);
    if (symbol >= unchanged) symbol += left_out_;
    if (symbol > huge) { // another sequence
      last_ = (last_ + symbol - huge) % 4;
      continue;
    }
    if (symbol == huge) {
      readHuge(in);
    }
    else if (symbol != unchanged && from_zero) {
      last_difference_[last_] = differences_.read(in, 0, after_zero);
      add(last_difference_[last_]);
      extremes_[last_] = 0;
    }
    else if (symbol != unchanged) {
      readMultiple(in, symbol);
    }
    return times_[last_];
  }
  throw FormatError("has a time that belongs to no sequence of times");
}

void GpsTimes::readMultiple(ArithmeticDecoder& in, std::uint32_t symbol)
{
  const auto last = static_cast<std::uint32_t>(last_difference_[last_]);
  const auto read = [&](std::uint32_t multiple, unsigned context) {
    return differences_.read(in, static_cast<std::int32_t>(multiple * last), context);
  };
  if (symbol == 1) {
    add(read(1, equal));
    extremes_[last_] = 0;
  }
  else if (symbol == 0) {
    countExtreme(read(0, none));
  }
  else if (symbol < most_multiple) {
    add(read(symbol, symbol < 10 ? few : many));
  }
  else if (symbol == most_multiple) {
    countExtreme(read(symbol, most));
  }
  else if (symbol < least_multiple) {
    add(read(most_multiple - symbol, negative)); // modulo 2^32
  }
  else {
    countExtreme(read(most_multiple - least_multiple, most_negative));
  }
}

void GpsTimes::countExtreme(std::int32_t difference)
{
  add(difference);
  if (++extremes_[last_] <= 3) return;
  last_difference_[last_] = difference;
  extremes_[last_] = 0;
}

void GpsTimes::readHuge(ArithmeticDecoder& in)
{
  const auto upper = static_cast<std::int32_t>(times_[last_] >> 32);
  const auto read = static_cast<std::uint32_t>(differences_.read(in, upper, upper_half));
  newest_ = (newest_ + 1) % static_cast<unsigned>(times_.size());
  last_ = newest_;
  times_[last_] = std::uint64_t{read} << 32 | in.bits(32);
  last_difference_[last_] = 0;
  extremes_[last_] = 0;
}

} // namespace pcl_bsh::io::laz
