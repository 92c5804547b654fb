// SPDX-License-Identifier: BSD-3-Clause
// Smooth multi-octave value noise: a height over the plane, a bump over the sphere. Only + - * and floor, so every
// machine makes the same surface.
#pragma once

#include "random.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace pcl_bsh::bench {

/// Random values on the integer lattice of space, blended smoothly between; in [-1, 1].
inline double valueNoise(std::array<double, 3> p, std::uint64_t seed)
{
  std::array<std::int64_t, 3> cell;
  std::array<double, 3> blend;
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = std::floor(p[k]);
    const double f = p[k] - low;
    cell[k] = static_cast<std::int64_t>(low);
    blend[k] = f * f * f * (f * (f * 6 - 15) + 10); // second derivative continuous: no creases in the surface
  }
  double sum = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::uint64_t key = seed;
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned up = (corner >> k) & 1u;
      weight *= up ? blend[k] : 1.0 - blend[k];
      if (weight == 0.0) break; // the plane z = 0 asks only four corners
      key = mix(key ^ static_cast<std::uint64_t>(cell[k] + static_cast<std::int64_t>(up)));
    }
    if (weight > 0.0) sum += weight * (2.0 * unit(key) - 1.0);
  }
  return sum;
}

/// Octaves from the longest wavelength down, each half as long and half as high as the one before.
inline double octaveNoise(std::array<double, 3> p, double wavelength, double height, int octaves, std::uint64_t seed)
{
  double sum = 0.0;
  for (int octave = 0; octave < octaves; ++octave) {
    const double f = 1.0 / wavelength;
    sum += height * valueNoise({p[0] * f, p[1] * f, p[2] * f}, seed + static_cast<std::uint64_t>(octave));
    wavelength *= 0.5;
    height *= 0.5;
  }
  return sum;
}

} // namespace pcl_bsh::bench
