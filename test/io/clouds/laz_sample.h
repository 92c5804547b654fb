// SPDX-License-Identifier: BSD-3-Clause
// Points as scanners write them, and unlike any of these, for tests of LAZ.
#pragma once

#include "las_sample.h"

namespace pcl_bsh::io {

/// Points along lines of a scan: small steps, returns that belong together, times in several sequences and now and then
/// far off, attributes that change seldom, colours that change alike.
/// @param channels of the scanner, in formats 6 to 10
inline void addScan(LasSample& sample, std::size_t count, unsigned seed = 1, unsigned channels = 1)
{
  std::mt19937 random(seed);
  const auto below = [&](unsigned most) { return static_cast<unsigned>(random() % most); };
  const auto rarely = [&] { return below(20) == 0; };
  const bool extended = sample.format >= 6;
  const std::size_t time_at = extended ? 22 : 20, colour_at = extended ? 30 : sample.format == 2 ? 20 : 28;
  const bool timed = sample.format != 0 && sample.format != 2;
  const bool coloured = sample.format == 2 || sample.format == 3 || sample.format == 5 || sample.format == 7 ||
                        sample.format == 8 || sample.format == 10;
  const bool waves = sample.format == 4 || sample.format == 5 || sample.format >= 9;
  const std::size_t waves_at = LasSample::lengths[sample.format] - 29;
  std::string point(sample.length(), '\0');
  std::array<double, 3> times = {1e5, 2e8, -7};
  unsigned returns = 1, number = 1, line = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t step = rarely() ? std::int64_t{static_cast<std::int32_t>(random())} : below(200) - 100LL;
      put(point, 4 * k, static_cast<std::int32_t>(get<std::int32_t>(point, 4 * k) + step));
    }
    put(point, 12, static_cast<std::uint16_t>(get<std::uint16_t>(point, 12) + below(9)));
    if (++number > returns) {
      number = 1;
      returns = 1 + below(extended ? 15 : 5);
      if (rarely()) number = below(extended ? 16 : 8); // beyond the returns of the pulse
      if (rarely()) line = below(3);
      double& time = times[line];
      if (below(3) > 0) time += 1e-5 * (rarely() ? below(2000) : 1) * (rarely() ? -3.0 : 1.0);
      if (rarely()) time += 1e-9 * static_cast<double>(random());
      if (rarely()) time = -time;
    }
    if (extended) {
      point[14] = static_cast<char>(number | returns << 4);
      const unsigned flags = rarely() ? below(256) : static_cast<unsigned char>(point[15]);
      point[15] = static_cast<char>((flags & 0xcfU) | below(rarely() ? channels : 1) << 4U);
      if (rarely()) put(point, 18, static_cast<std::int16_t>(random()));
      if (rarely()) put(point, 20, static_cast<std::uint16_t>(below(4)));
    }
    else {
      point[14] = static_cast<char>(number | returns << 3 | (rarely() ? below(4) << 6U : 0U));
      if (rarely()) point[15] = static_cast<char>(below(256));
      if (rarely()) put(point, 18, static_cast<std::uint16_t>(below(4)));
    }
    for (const std::size_t byte : {16u, 17u})
      if (rarely()) point[byte] = static_cast<char>(below(256));
    if (timed) put(point, time_at, times[line]);
    if (coloured) {
      const auto step = static_cast<std::uint16_t>(below(600));
      const bool grey = below(4) == 0;
      for (std::size_t k = 0; k < (sample.format == 8 || sample.format == 10 ? 4 : 3); ++k) {
        const std::size_t at = colour_at + 2 * k;
        put(point, at, static_cast<std::uint16_t>(grey && k < 3 ? step : get<std::uint16_t>(point, at) + step));
      }
    }
    if (waves) {
      point[waves_at] = static_cast<char>(below(2));
      const auto size = get<std::uint32_t>(point, waves_at + 9);
      const std::uint64_t by = below(3) == 0 ? 0 : below(3) == 0 ? below(1000) : rarely() ? random() << 20U : size;
      put(point, waves_at + 1, get<std::uint64_t>(point, waves_at + 1) + by);
      if (rarely()) put(point, waves_at + 9, 100 + below(100));
      for (std::size_t k = 0; k < 4; ++k) put(point, waves_at + 13 + 4 * k, static_cast<float>(below(100)) / 7);
    }
    for (std::size_t k = LasSample::lengths[sample.format]; k < point.size(); ++k)
      if (k % 3 != 2 && rarely()) point[k] = static_cast<char>(below(256)); // others never change
    sample.points.push_back(point);
  }
}

} // namespace pcl_bsh::io
