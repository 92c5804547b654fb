// SPDX-License-Identifier: BSD-3-Clause
// The item RGB12, versions 1 and 2: red, green and blue of 16 bits.
#include <pcl_bsh/io/clouds/las/laz/colour_models.h>
#include <pcl_bsh/io/clouds/las/laz/integer_decompressor.h>
#include <pcl_bsh/io/clouds/las/laz/item.h>

namespace pcl_bsh::io::laz {

namespace {

constexpr unsigned rgb_bytes = 6;

/// Six bytes, each by itself.
struct Rgb12V1 {
  void read(ArithmeticDecoder& in, char* last)
  {
    const unsigned changes = in.symbol(changed);
    for (unsigned k = 0; k < rgb_bytes; ++k)
      if ((changes >> k & 1U) != 0) last[k] = static_cast<char>(bytes.read(in, static_cast<std::uint8_t>(last[k]), k));
  }

  SymbolModel changed{64};
  IntegerDecompressor bytes{8, rgb_bytes};
};

} // namespace

std::unique_ptr<PointwiseItem> newRgb12(unsigned version, std::size_t size)
{
  if (version == 1) return newPointwise<Rgb12V1>(size);
  return newPointwise<ColourModels>(size);
}

} // namespace pcl_bsh::io::laz
