// SPDX-License-Identifier: BSD-3-Clause
// The items WAVEPACKET13, version 1, and WAVEPACKET14, versions 3 and 4: where the waveform of a return is, and how the
// return lies in it.
#include <pcl_bsh/io/clouds/las/laz/integer_decompressor.h>
#include <pcl_bsh/io/clouds/las/laz/item.h>

namespace pcl_bsh::io::laz {

namespace {

constexpr std::size_t wave_offset = 1, wave_size = 9, wave_location = 13, wave_direction = 17;

class WaveModels {
public:
  void read(ArithmeticDecoder& in, char* last)
  {
    last[0] = static_cast<char>(in.symbol(descriptor_));
    how_ = in.symbol(how_models_[how_]);
    auto offset = loaded<std::uint64_t>(last + wave_offset);
    const auto size = loaded<std::uint32_t>(last + wave_size);
    if (how_ == 1) offset += size;
    if (how_ == 2) {
      difference_ = differences_.read(in, difference_);
      offset += static_cast<std::uint64_t>(std::int64_t{difference_});
    }
    if (how_ == 3) offset = in.bits64();
    store(last + wave_offset, offset);
    store(last + wave_size, sizes_.read(in, static_cast<std::int32_t>(size)));
    store(last + wave_location, locations_.read(in, loaded<std::int32_t>(last + wave_location)));
    for (unsigned k = 0; k < 3; ++k) {
      char* const axis = last + wave_direction + std::size_t{4} * k;
      store(axis, directions_.read(in, loaded<std::int32_t>(axis), k));
    }
  }

  void read(std::span<Layer> layers, char* last)
  {
    if (layers[0]) read(*layers[0], last);
  }

private:
  SymbolModel descriptor_{256};
  std::vector<SymbolModel> how_models_ = std::vector<SymbolModel>(4, SymbolModel(4)); ///< by how it was before
  unsigned how_ = 0; ///< the offset differs: 0 not, 1 by the size of the last, 2 by 32 bits, 3 by more
  std::int32_t difference_ = 0;
  IntegerDecompressor differences_{32}, sizes_{32}, locations_{32}, directions_{32, 3};
};

} // namespace

std::unique_ptr<PointwiseItem> newWavePacket13(unsigned /*version*/, std::size_t size)
{
  return newPointwise<WaveModels>(size);
}

std::unique_ptr<LayeredItem> newWavePacket14(unsigned version, std::size_t size)
{
  return newLayered<WaveModels>(size, 1, version);
}

} // namespace pcl_bsh::io::laz
