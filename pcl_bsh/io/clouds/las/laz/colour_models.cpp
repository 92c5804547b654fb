// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/laz/colour_models.h>

#include <algorithm>
#include <array>

namespace pcl_bsh::io::laz {

void ColourModels::read(ArithmeticDecoder& in, char* last)
{
  const unsigned changed = in.symbol(changed_);
  std::array<int, 6> before{}; // bytes: lower and upper of red, green, blue
  for (std::size_t k = 0; k < before.size(); ++k) before[k] = static_cast<std::uint8_t>(last[k]);
  std::array<int, 6> now = before;
  const auto readByte = [&](unsigned k, int prediction) {
    if ((changed >> k & 1U) != 0) now[k] = (prediction + static_cast<int>(in.symbol(differences_[k]))) & 0xff;
  };
  readByte(0, before[0]);
  readByte(1, before[1]);
  constexpr unsigned coloured = 1U << 6;
  for (unsigned half = 0; half < 2; ++half) {
    if ((changed & coloured) == 0) {
      now[4 + half] = now[2 + half] = now[half];
      continue;
    }
    const int red = now[half] - before[half]; // others are likely to differ as red does
    readByte(2 + half, std::clamp(before[2 + half] + red, 0, 255));
    const int both = (red + now[2 + half] - before[2 + half]) / 2;
    readByte(4 + half, std::clamp(before[4 + half] + both, 0, 255));
  }
  for (std::size_t k = 0; k < now.size(); ++k) last[k] = static_cast<char>(now[k]);
}

} // namespace pcl_bsh::io::laz
