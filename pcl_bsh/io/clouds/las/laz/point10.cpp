// SPDX-License-Identifier: BSD-3-Clause
// The item POINT10, versions 1 and 2: x y z, intensity, a byte of returns, classification, scan angle, user data,
// source.
#include <pcl_bsh/io/clouds/las/laz/integer_decompressor.h>
#include <pcl_bsh/io/clouds/las/laz/item.h>
#include <pcl_bsh/io/clouds/las/laz/return_contexts.h>
#include <pcl_bsh/io/clouds/las/laz/streaming_median.h>

#include <algorithm>

namespace pcl_bsh::io::laz {

namespace {

constexpr std::size_t y10 = 4, z10 = 8, intensity10 = 12, returns10 = 14, class10 = 15, angle10 = 16, user10 = 17,
                      source10 = 18;

/// Models of a byte, one for each value of the byte before.
using ModelsByLast = std::vector<SymbolModel>;

ModelsByLast byteModels()
{
  return ModelsByLast(256, SymbolModel(256));
}

void readByte(ArithmeticDecoder& in, ModelsByLast& models, char& byte)
{
  byte = static_cast<char>(in.symbol(models[static_cast<std::uint8_t>(byte)]));
}

void addTo(char* at, std::int32_t difference)
{
  store(at, loaded<std::uint32_t>(at) + static_cast<std::uint32_t>(difference));
}

class Point10V1 {
public:
  void read(ArithmeticDecoder& in, char* last)
  {
    const std::int32_t x = x_.read(in, median(x_differences_));
    addTo(last, x);
    const std::int32_t y = y_.read(in, median(y_differences_), std::min(x_.width(), 19U));
    addTo(last + y10, y);
    const unsigned width = (x_.width() + y_.width()) / 2;
    store(last + z10, z_.read(in, loaded<std::int32_t>(last + z10), std::min(width, 19U)));

    const unsigned changed = in.symbol(changed_);
    if ((changed & 32U) != 0) read16(in, intensity_, last + intensity10);
    if ((changed & 16U) != 0) readByte(in, returns_, last[returns10]);
    if ((changed & 8U) != 0) readByte(in, classes_, last[class10]);
    if ((changed & 4U) != 0) {
      const auto angle = static_cast<std::uint8_t>(last[angle10]);
      last[angle10] = static_cast<char>(angles_.read(in, angle, width < 3 ? 1 : 0));
    }
    if ((changed & 2U) != 0) readByte(in, user_data_, last[user10]);
    if ((changed & 1U) != 0) read16(in, sources_, last + source10);

    x_differences_[next_] = x;
    y_differences_[next_] = y;
    next_ = (next_ + 1) % 3;
  }

private:
  using Differences = std::array<std::int32_t, 3>;

  static std::int32_t median(const Differences& of)
  {
    return std::max(std::min(of[0], of[1]), std::min(std::max(of[0], of[1]), of[2]));
  }

  static void read16(ArithmeticDecoder& in, IntegerDecompressor& integers, char* at)
  {
    store(at, static_cast<std::uint16_t>(integers.read(in, loaded<std::uint16_t>(at))));
  }

  Differences x_differences_{}, y_differences_{};
  std::size_t next_ = 0; ///< of the differences, to be replaced
  IntegerDecompressor x_{32}, y_{32, 20}, z_{32, 20}, intensity_{16}, angles_{8, 2}, sources_{16};
  SymbolModel changed_{64};
  ModelsByLast returns_ = byteModels(), classes_ = byteModels(), user_data_ = byteModels();
};

class Point10V2 {
public:
  void read(ArithmeticDecoder& in, char* last)
  {
    const unsigned changed = in.symbol(changed_);
    if ((changed & 32U) != 0) readByte(in, returns_, last[returns10]);
    const auto flags = static_cast<std::uint8_t>(last[returns10]);
    const unsigned number = flags & 7U, returns = flags >> 3 & 7U;
    static constexpr auto contexts = returnTable<8>(returnContext10);
    const unsigned context = contexts[returns][number], level = returnLevel(returns, number);

    if ((changed & 16U) != 0) {
      const std::int32_t read = intensity_.read(in, intensities_[context], std::min(context, 3U));
      intensities_[context] = static_cast<std::uint16_t>(read);
    }
    store(last + intensity10, intensities_[context]);
    if ((changed & 8U) != 0) readByte(in, classes_, last[class10]);
    if ((changed & 4U) != 0) {
      const unsigned difference = in.symbol(angles_[flags >> 6 & 1U]); // of the scan direction
      last[angle10] = static_cast<char>(static_cast<std::uint8_t>(last[angle10]) + difference);
    }
    if ((changed & 2U) != 0) readByte(in, user_data_, last[user10]);
    if ((changed & 1U) != 0) {
      store(last + source10, static_cast<std::uint16_t>(sources_.read(in, loaded<std::uint16_t>(last + source10))));
    }

    const unsigned single = returns == 1 ? 1 : 0;
    const std::int32_t x = x_.read(in, x_differences_[context].value(), single);
    addTo(last, x);
    x_differences_[context].add(x);
    const std::int32_t y = y_.read(in, y_differences_[context].value(), single + std::min(x_.width() & ~1U, 20U));
    addTo(last + y10, y);
    y_differences_[context].add(y);
    const unsigned width = (x_.width() + y_.width()) / 2;
    heights_[level] = z_.read(in, heights_[level], single + std::min(width & ~1U, 18U));
    store(last + z10, heights_[level]);
  }

private:
  std::array<StreamingMedian, 16> x_differences_, y_differences_;
  std::array<std::uint16_t, 16> intensities_{};
  std::array<std::int32_t, 8> heights_{};
  IntegerDecompressor x_{32, 2}, y_{32, 22}, z_{32, 20}, intensity_{16, 4}, sources_{16};
  SymbolModel changed_{64};
  std::array<SymbolModel, 2> angles_ = {SymbolModel(256), SymbolModel(256)};
  ModelsByLast returns_ = byteModels(), classes_ = byteModels(), user_data_ = byteModels();
};

} // namespace

std::unique_ptr<PointwiseItem> newPoint10(unsigned version, std::size_t size)
{
  if (version == 1) return newPointwise<Point10V1>(size);
  return newPointwise<Point10V2>(size);
}

} // namespace pcl_bsh::io::laz
