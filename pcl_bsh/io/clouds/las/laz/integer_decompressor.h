// SPDX-License-Identifier: BSD-3-Clause
// Integers of LAZ, coded as corrections of a prediction: the number of bits, then the bits, the upper eight of them by
// models.
#pragma once

#include <pcl_bsh/io/clouds/las/laz/arithmetic_decoder.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh::io::laz {

class IntegerDecompressor {
public:
  /// @param bits of the integers: 8, 16 or 32
  /// @param contexts number of contexts; each has a model of the number of bits
  explicit IntegerDecompressor(unsigned bits, unsigned contexts = 1)
  : bits_(bits),
    widths_(contexts, SymbolModel(bits + 1))
  {
    upper_.reserve(bits);
    for (unsigned width = 1; width <= bits; ++width) upper_.emplace_back(1U << (width < modelled ? width : modelled));
  }

  /// The integer: signed if it has 32 bits, else from 0 to 2^bits - 1
  std::int32_t read(ArithmeticDecoder& in, std::int32_t prediction, unsigned context = 0)
  {
    std::uint32_t value = static_cast<std::uint32_t>(prediction) + correction(in, context);
    if (bits_ < 32) value &= (1U << bits_) - 1;
    return static_cast<std::int32_t>(value);
  }

  /// How many bits the last correction had: a context for what comes next.
  unsigned width() const { return width_; }

private:
  static constexpr unsigned modelled = 8; ///< bits

  /// Modulo 2^32: 0 or 1 has no bits; k bits stand for [-(2^k - 1), -2^(k-1)] and [2^(k-1) + 1, 2^k]
  std::uint32_t correction(ArithmeticDecoder& in, unsigned context)
  {
    width_ = in.symbol(widths_[context]);
    if (width_ == 0) return in.bit(one_);
    if (width_ == 32) return 1U << 31;
    std::uint32_t bits = in.symbol(upper_[width_ - 1]);
    if (width_ > modelled) bits = bits << (width_ - modelled) | in.bits(width_ - modelled);
    return bits >> (width_ - 1) != 0 ? bits + 1 : bits - ((1U << width_) - 1);
  }

  unsigned bits_, width_ = 0;
  std::vector<SymbolModel> widths_, upper_; ///< of contexts; of widths
  BitModel one_;
};

} // namespace pcl_bsh::io::laz
