// SPDX-License-Identifier: BSD-3-Clause
// The item GPSTIME11, versions 1 and 2: a double.
#include <pcl_bsh/io/clouds/las/laz/gps_times.h>
#include <pcl_bsh/io/clouds/las/laz/item.h>

namespace pcl_bsh::io::laz {

namespace {

/// Times of one sequence.
class GpsTime11V1 {
public:
  void read(ArithmeticDecoder& in, char* last)
  {
    time_ = loaded<std::uint64_t>(last);
    if (last_difference_ == 0) {
      const unsigned symbol = in.symbol(zero_);
      if (symbol == 1) add(last_difference_ = differences_.read(in, 0, 0));
      if (symbol == 2) time_ = in.bits64();
    }
    else {
      readMultiple(in);
    }
    store(last, time_);
  }

private:
  static constexpr std::uint32_t most_multiple = 509, huge = 510; // 511: unchanged

  void add(std::int32_t difference) { time_ += static_cast<std::uint64_t>(std::int64_t{difference}); }

  void readMultiple(ArithmeticDecoder& in)
  {
    const std::uint32_t symbol = in.symbol(multiples_);
    if (symbol == huge) time_ = in.bits64();
    if (symbol >= huge) return;
    const std::int32_t prediction =
        symbol == 0 ? last_difference_ / 4
                    : static_cast<std::int32_t>(symbol * static_cast<std::uint32_t>(last_difference_));
    const unsigned context = symbol == 1 ? 1 : symbol == 0 ? 2 : symbol < 10 ? 3 : symbol < 50 ? 4 : 5;
    const std::int32_t difference = differences_.read(in, prediction, context);
    add(difference);
    const bool extreme = symbol == 0 || symbol == most_multiple;
    if (extreme) ++extremes_;
    if (symbol == 1 || (extreme && extremes_ > 3)) {
      last_difference_ = difference;
      extremes_ = 0;
    }
  }

  std::uint64_t time_ = 0;
  std::int32_t last_difference_ = 0;
  unsigned extremes_ = 0; ///< how often differences were far from the last
  SymbolModel zero_{3}, multiples_{512};
  IntegerDecompressor differences_{32, 6};
};

struct GpsTime11V2 {
  void read(ArithmeticDecoder& in, char* last) { store(last, times.read(in, loaded<std::uint64_t>(last))); }

  GpsTimes times{true};
};

} // namespace

std::unique_ptr<PointwiseItem> newGpsTime11(unsigned version, std::size_t size)
{
  if (version == 1) return newPointwise<GpsTime11V1>(size);
  return newPointwise<GpsTime11V2>(size);
}

} // namespace pcl_bsh::io::laz
