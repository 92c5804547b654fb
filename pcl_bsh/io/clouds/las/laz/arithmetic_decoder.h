// SPDX-License-Identifier: BSD-3-Clause
// The entropy coder of LAZ: an arithmetic decoder with 32-bit intervals, and models that learn how often each symbol
// comes (A. Said, "Introduction to arithmetic coding", HPL-2004-76; "Arithmetic coding" of the LAZ specification).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace pcl_bsh::io::laz {

/// How often each of some symbols comes. Takes memory with its first symbol: most models of a file are never used.
class SymbolModel {
public:
  /// @param symbols 2 to 2048
  explicit SymbolModel(unsigned symbols) : symbols_(symbols) {}

private:
  friend class ArithmeticDecoder;

  void start();
  void update();

  std::uint16_t* begins() { return numbers_.data(); } ///< of the symbols' parts of 2^15; one more, beyond all places
  std::uint16_t* counts() { return begins() + symbols_ + 1; }
  std::uint16_t* slots() { return counts() + symbols_; } ///< the symbol where a slot of places begins

  std::vector<std::uint16_t> numbers_;
  unsigned symbols_, slot_shift_ = 0;
  unsigned total_ = 0, cycle_ = 0, until_update_ = 0;
};

/// The same for a bit.
class BitModel {
private:
  friend class ArithmeticDecoder;

  void update();

  unsigned zero_part_ = 1U << 12, zeros_ = 1, total_ = 2, cycle_ = 4, until_update_ = 4; ///< part of 2^13
};

class ArithmeticDecoder {
public:
  /// @param bytes stay where they are. @throws FormatError when no encoder begins so
  explicit ArithmeticDecoder(std::string_view bytes);

  unsigned symbol(SymbolModel& model)
  {
    if (model.until_update_ == 0) model.start();
    const std::uint32_t unit = length_ >> 15;
    const std::uint32_t place = value_ / unit;
    const std::uint16_t* const begins = model.begins();
    unsigned symbol = model.slots()[place >> model.slot_shift_];
    while (begins[symbol + 1] <= place) ++symbol;
    const std::uint32_t low = begins[symbol] * unit;
    value_ -= low;
    length_ = symbol + 1 == model.symbols_ ? length_ - low : begins[symbol + 1] * unit - low;
    if (length_ < least_length) renormalise();
    ++model.counts()[symbol];
    if (--model.until_update_ == 0) model.update();
    return symbol;
  }

  unsigned bit(BitModel& model)
  {
    const std::uint32_t zeros = model.zero_part_ * (length_ >> 13);
    const unsigned bit = value_ < zeros ? 0 : 1;
    if (bit == 0) {
      length_ = zeros;
      ++model.zeros_;
    }
    else {
      value_ -= zeros;
      length_ -= zeros;
    }
    if (length_ < least_length) renormalise();
    if (--model.until_update_ == 0) model.update();
    return bit;
  }

  /// Bits without a model. @param count 1 to 32
  std::uint32_t bits(unsigned count);

  std::uint64_t bits64()
  {
    const std::uint64_t low = bits(32);
    return low | std::uint64_t{bits(32)} << 32;
  }

private:
  static constexpr std::uint32_t least_length = 1U << 24;

  void renormalise()
  {
    do {
      value_ = value_ << 8 | next();
      length_ <<= 8;
    } while (length_ < least_length);
  }

  std::uint8_t next() { return at_ != end_ ? static_cast<std::uint8_t>(*at_++) : pastEnd(); }
  std::uint8_t pastEnd();

  const char *at_, *end_;
  std::uint32_t value_ = 0, length_ = 0xffffffffU;
  unsigned past_end_ = 0;
};

} // namespace pcl_bsh::io::laz
