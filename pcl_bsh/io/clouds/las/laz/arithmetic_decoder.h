// SPDX-License-Identifier: BSD-3-Clause
// The entropy coder of LAZ: an arithmetic decoder with 32-bit intervals, and models that learn how often each symbol
// comes (A. Said, "Introduction to arithmetic coding", HPL-2004-76; "Arithmetic coding" of the LAZ specification).
#pragma once

#include <pcl_bsh/io/clouds/stored_number.h>

#include <algorithm>
#include <bit>
#include <cstddef>
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

  void prepare();
  void start();
  void update();

  std::size_t slotsAt() const { return 2 * (std::size_t{symbols_} + 1); }

  /// For each symbol, where its part of 2^15 begins, and its count; one entry more, beyond all places. Then slots of
  /// places: for each, twice the symbol at which it begins.
  std::vector<std::uint16_t> numbers_;
  unsigned symbols_, slot_shift_ = 0;
  unsigned total_ = 0, cycle_ = 0, until_update_ = 0;
};

/// The model of a bit.
class BitModel {
private:
  friend class ArithmeticDecoder;

  void update();

  unsigned zero_part_ = 1U << 12, zeros_ = 1, total_ = 2, cycle_ = 4, until_update_ = 4; ///< part of 2^13
};

class ArithmeticDecoder {
public:
  /// @param bytes stay where they are. @throws FormatError when no encoder writes such a beginning
  explicit ArithmeticDecoder(std::string_view bytes);

  unsigned symbol(SymbolModel& model)
  {
    if (model.until_update_ == 0) model.prepare();
    --model.until_update_;
    const std::uint32_t unit = length_ >> 15;
    const std::uint32_t place = value_ / unit;
    std::uint16_t* const numbers = model.numbers_.data();
    std::uint16_t* entry = numbers + numbers[model.slotsAt() + (place >> model.slot_shift_)];
    while (entry[2] <= place) entry += 2;
    const std::uint32_t low = entry[0] * unit;
    value_ -= low;
    length_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(std::uint64_t{entry[2]} * unit, length_)) - low;
    renormalise();
    ++entry[1];
    return static_cast<unsigned>(entry - numbers) / 2;
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
    renormalise();
    if (--model.until_update_ == 0) model.update();
    return bit;
  }

  /// How many of the bytes have been read. These are all that the encoder has written, once all that it coded is read.
  std::size_t consumed() const { return at_; }

  /// Bits without a model. @param count 1 to 32
  std::uint32_t bits(unsigned count);

  std::uint64_t bits64()
  {
    const std::uint64_t low = bits(32);
    return low | std::uint64_t{bits(32)} << 32;
  }

private:
  /// The interval becomes at least 2^24 long: no branch depends on how many bytes that takes, which are 0 to 3.
  void renormalise()
  {
    const auto bits = static_cast<unsigned>(std::countl_zero(length_)) & ~7U;
    const std::uint64_t joined =
        std::uint64_t{value_} << 32 | (at_ + 4 <= bytes_.size() ? nextFour() : lastOnes(bits / 8));
    value_ = static_cast<std::uint32_t>(joined >> (32 - bits));
    length_ <<= bits;
    at_ += bits / 8;
  }

  std::uint32_t nextFour() const { return __builtin_bswap32(loaded<std::uint32_t>(bytes_.data() + at_)); }
  std::uint32_t lastOnes(unsigned bytes);

  std::string_view bytes_;
  std::size_t at_ = 0; ///< may be beyond their end
  std::uint32_t value_ = 0, length_ = 0xffffffffU;
};

} // namespace pcl_bsh::io::laz
