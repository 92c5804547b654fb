// SPDX-License-Identifier: BSD-3-Clause
// The arithmetic coder of LAZ as an encoder, written from the description of the format without the decoder under test:
// simple, and slow.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh::io::laz_test {

struct Model {
  explicit Model(unsigned symbols) : counts(symbols, 1), begins(symbols), cycle(symbols)
  {
    update();
    cycle = until_update = (symbols + 6) / 2;
  }

  void update()
  {
    total += cycle;
    if (total > 32768) {
      total = 0;
      for (unsigned& count : counts) total += count = (count + 1) / 2;
    }
    unsigned sum = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      begins[i] = (0x80000000U / total) * sum / 65536;
      sum += counts[i];
    }
    cycle = std::min<unsigned>(cycle * 5 / 4, (static_cast<unsigned>(counts.size()) + 6) * 8);
    until_update = cycle;
  }

  std::vector<unsigned> counts, begins;
  unsigned total = 0, cycle = 0, until_update = 0;
};

struct BitModel {
  void update()
  {
    total += cycle;
    if (total > 8192) {
      total = (total + 1) / 2;
      zeros = (zeros + 1) / 2;
      if (zeros == total) ++total;
    }
    part = zeros * (0x80000000U / total) / 262144;
    cycle = std::min(cycle * 5 / 4, 64U);
    until_update = cycle;
  }

  unsigned zeros = 1, total = 2, part = 4096, cycle = 4, until_update = 4;
};

class Coder {
public:
  void symbol(Model& model, unsigned symbol)
  {
    const std::uint32_t unit = length_ / 32768, low = model.begins[symbol] * unit;
    const bool last = symbol + 1 == model.counts.size();
    narrow(low, last ? length_ - low : model.begins[symbol + 1] * unit - low);
    ++model.counts[symbol];
    if (--model.until_update == 0) model.update();
  }

  void bit(BitModel& model, unsigned bit)
  {
    const std::uint32_t zeros = model.part * (length_ / 8192);
    if (bit == 0) {
      ++model.zeros;
      narrow(0, zeros);
    }
    else {
      narrow(zeros, length_ - zeros);
    }
    if (--model.until_update == 0) model.update();
  }

  void bits(unsigned count, std::uint32_t value)
  {
    if (count > 19) {
      bits(16, value & 0xffffU);
      return bits(count - 16, value >> 16);
    }
    const std::uint32_t unit = length_ >> count;
    narrow(value * unit, unit);
  }

  void bits64(std::uint64_t value)
  {
    bits(32, static_cast<std::uint32_t>(value));
    bits(32, static_cast<std::uint32_t>(value >> 32));
  }

  /// All bytes: as many as a decoder has read at its end.
  std::string finish()
  {
    const bool one_byte = length_ > 0x2000000U;
    if (one_byte)
      narrow(0x1000000U, 0x800000U);
    else
      narrow(0x800000U, 0x8000U);
    return bytes_ + std::string(one_byte ? 3 : 2, '\0');
  }

private:
  void narrow(std::uint32_t low, std::uint32_t length)
  {
    if (base_ + low < base_) { // modulo 2^32
      std::size_t at = bytes_.size();
      while (++bytes_[--at] == '\0') {
      }
    }
    base_ += low;
    length_ = length;
    for (; length_ < 0x1000000U; length_ <<= 8, base_ <<= 8) bytes_ += static_cast<char>(base_ >> 24);
  }

  std::string bytes_;
  std::uint32_t base_ = 0, length_ = std::numeric_limits<std::uint32_t>::max();
};

class Integers {
public:
  explicit Integers(unsigned number_of_bits, unsigned contexts = 1)
  : bits_(number_of_bits),
    widths_(contexts, Model(number_of_bits + 1))
  {
    for (unsigned i = 1; i <= bits_; ++i) upper_.emplace_back(1U << std::min(i, 8U));
  }

  void write(Coder& out, std::int32_t prediction, std::int32_t value, unsigned context = 0)
  {
    std::int64_t c = std::int64_t{value} - prediction;
    const std::int64_t range = std::int64_t{1} << bits_;
    while (c < -range / 2) c += range;
    while (c >= range / 2) c -= range;
    width = 0;
    for (std::int64_t rest = c <= 0 ? -c : c - 1; rest > 0; rest /= 2) ++width;
    out.symbol(widths_[context], width);
    if (width == 0) return out.bit(one_, static_cast<unsigned>(c));
    if (width == 32) return;
    const auto place = static_cast<std::uint32_t>(c < 0 ? c + (std::int64_t{1} << width) - 1 : c - 1);
    if (width <= 8) return out.symbol(upper_[width - 1], place);
    out.symbol(upper_[width - 1], place >> (width - 8));
    out.bits(width - 8, place & ((1U << (width - 8)) - 1));
  }

  unsigned width = 0;

private:
  unsigned bits_;
  std::vector<Model> widths_, upper_;
  BitModel one_;
};

} // namespace pcl_bsh::io::laz_test
