// SPDX-License-Identifier: BSD-3-Clause
// The items RGB14 and RGBNIR14, versions 3 and 4: red, green and blue, and infrared in a layer of its own.
#include <pcl_bsh/io/clouds/las/laz/colour_models.h>
#include <pcl_bsh/io/clouds/las/laz/item.h>

namespace pcl_bsh::io::laz {

namespace {

struct ColourLayers {
  void read(std::span<Layer> layers, char* last)
  {
    if (layers[0]) colours.read(*layers[0], last);
    if (layers.size() < 2 || !layers[1]) return;
    ArithmeticDecoder& in = *layers[1];
    const unsigned changed = in.symbol(infrared_changed);
    for (unsigned half = 0; half < 2; ++half) {
      char& byte = last[6 + half];
      if ((changed >> half & 1U) != 0)
        byte = static_cast<char>(static_cast<std::uint8_t>(byte) + in.symbol(infrared[half]));
    }
  }

  ColourModels colours;
  SymbolModel infrared_changed{4};
  std::array<SymbolModel, 2> infrared = {SymbolModel(256), SymbolModel(256)}; ///< lower, upper byte
};

} // namespace

std::unique_ptr<LayeredItem> newRgb14(unsigned version, std::size_t size)
{
  return newLayered<ColourLayers>(size, 1, version);
}

std::unique_ptr<LayeredItem> newRgbNir14(unsigned version, std::size_t size)
{
  return newLayered<ColourLayers>(size, 2, version);
}

} // namespace pcl_bsh::io::laz
