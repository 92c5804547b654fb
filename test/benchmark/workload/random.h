// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that are the same on every machine: the standard's distributions are not.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace pcl_bsh::bench {

/// One well-mixed 64-bit number per input (the finaliser of SplitMix64, Steele et al. 2014).
constexpr std::uint64_t mix(std::uint64_t x)
{
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Uniform in [0, 1): the top 53 bits.
constexpr double unit(std::uint64_t bits)
{
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

class Random {
public:
  explicit Random(std::uint64_t seed) : state_(mix(seed)) {}

  std::uint64_t bits()
  {
    const std::uint64_t value = mix(state_);
    state_ += 0x9e3779b97f4a7c15u;
    return value;
  }

  double uniform() { return unit(bits()); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform in [0, bound), bound far below 2^64 (the bias is not measurable).
  std::uint64_t below(std::uint64_t bound) { return bits() % bound; }

  /// Bell-shaped with standard deviation 1 and no libm behind it: a sum of twelve uniforms.
  double bell()
  {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

  /// Uniform on the unit sphere.
  std::array<double, 3> direction()
  {
    for (;;) {
      const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
      const double n = x * x + y * y + z * z;
      if (n > 0.01 && n <= 1.0) {
        const double length = std::sqrt(n);
        return {x / length, y / length, z / length};
      }
    }
  }

private:
  std::uint64_t state_;
};

} // namespace pcl_bsh::bench
