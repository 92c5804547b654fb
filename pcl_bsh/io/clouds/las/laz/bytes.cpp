// SPDX-License-Identifier: BSD-3-Clause
// The items BYTE, versions 1 and 2, and BYTE14, versions 3 and 4: extra bytes, each by itself.
#include <pcl_bsh/io/clouds/las/laz/integer_decompressor.h>
#include <pcl_bsh/io/clouds/las/laz/item.h>

namespace pcl_bsh::io::laz {

namespace {

struct BytesV1 {
  explicit BytesV1(std::size_t count) : size(static_cast<unsigned>(count)) {}

  void read(ArithmeticDecoder& in, char* last)
  {
    for (unsigned k = 0; k < size; ++k)
      last[k] = static_cast<char>(integers.read(in, static_cast<std::uint8_t>(last[k]), k));
  }

  unsigned size;
  IntegerDecompressor integers{8, size};
};

/// In one stream, or each in its layer.
struct ByteModels {
  explicit ByteModels(std::size_t size) : differences(size, SymbolModel(256)) {}

  void read(ArithmeticDecoder& in, char* last)
  {
    for (std::size_t k = 0; k < differences.size(); ++k) last[k] = next(in, differences[k], last[k]);
  }

  void read(std::span<Layer> layers, char* last)
  {
    for (std::size_t k = 0; k < layers.size(); ++k)
      if (layers[k]) last[k] = next(*layers[k], differences[k], last[k]);
  }

  static char next(ArithmeticDecoder& in, SymbolModel& difference, char last)
  {
    return static_cast<char>(static_cast<std::uint8_t>(last) + in.symbol(difference));
  }

  std::vector<SymbolModel> differences;
};

} // namespace

std::unique_ptr<PointwiseItem> newBytes(unsigned version, std::size_t size)
{
  if (version == 1) return newPointwise(size, BytesV1(size));
  return newPointwise(size, ByteModels(size));
}

std::unique_ptr<LayeredItem> newBytes14(unsigned version, std::size_t size)
{
  return newLayered(size, size, version, ByteModels(size));
}

} // namespace pcl_bsh::io::laz
