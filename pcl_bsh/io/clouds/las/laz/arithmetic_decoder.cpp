// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/laz/arithmetic_decoder.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace pcl_bsh::io::laz {

namespace {

constexpr unsigned place_bits = 15, most_count = 1U << place_bits;
constexpr unsigned bit_place_bits = 13, most_bit_count = 1U << bit_place_bits;

} // namespace

void SymbolModel::start()
{
  const unsigned slot_bits = static_cast<unsigned>(std::bit_width(symbols_ - 1));
  slot_shift_ = place_bits - slot_bits;
  // The interval is no multiple of its 2^15 parts: places reach 63 beyond.
  const std::size_t slots = (std::size_t{1} << slot_bits) + (std::size_t{63} >> slot_shift_) + 1;
  numbers_.assign(2 * std::size_t{symbols_} + 1 + slots, 0);
  std::fill_n(counts(), symbols_, std::uint16_t{1});
  total_ = 0;
  cycle_ = symbols_;
  update();
  cycle_ = until_update_ = (symbols_ + 6) / 2;
}

void SymbolModel::update()
{
  std::uint16_t* const count = counts();
  total_ += cycle_;
  if (total_ > most_count) {
    total_ = 0;
    for (unsigned i = 0; i < symbols_; ++i) {
      count[i] = static_cast<std::uint16_t>((count[i] + 1) / 2);
      total_ += count[i];
    }
  }
  const std::uint32_t scale = (1U << 31) / total_;
  std::uint16_t* const begin = begins();
  std::uint32_t sum = 0;
  for (unsigned i = 0; i < symbols_; ++i) {
    begin[i] = static_cast<std::uint16_t>(scale * sum >> (31 - place_bits));
    sum += count[i];
  }
  begin[symbols_] = std::numeric_limits<std::uint16_t>::max();

  std::uint16_t* slot = slots();
  std::uint16_t* const first = slot;
  std::uint16_t* const end = numbers_.data() + numbers_.size();
  const unsigned round_up = (1U << slot_shift_) - 1;
  for (unsigned i = 0; i + 1 < symbols_; ++i) {
    std::uint16_t* const next = first + ((begin[i + 1] + round_up) >> slot_shift_);
    while (slot < next) *slot++ = static_cast<std::uint16_t>(i);
  }
  std::fill(slot, end, static_cast<std::uint16_t>(symbols_ - 1));

  cycle_ = std::min(cycle_ * 5 / 4, (symbols_ + 6) * 8);
  until_update_ = cycle_;
}

void BitModel::update()
{
  total_ += cycle_;
  if (total_ > most_bit_count) {
    total_ = (total_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == total_) ++total_;
  }
  const std::uint32_t scale = (1U << 31) / total_;
  zero_part_ = zeros_ * scale >> (31 - bit_place_bits);
  cycle_ = std::min(cycle_ * 5 / 4, 64U);
  until_update_ = cycle_;
}

ArithmeticDecoder::ArithmeticDecoder(std::string_view bytes) : at_(bytes.data()), end_(at_ + bytes.size())
{
  for (unsigned i = 0; i < sizeof value_; ++i) value_ = value_ << 8 | next();
  if (value_ == length_) throw FormatError("has bytes that no encoder writes");
}

std::uint32_t ArithmeticDecoder::bits(unsigned count)
{
  constexpr unsigned most_at_once = 19;
  if (count > most_at_once) {
    const std::uint32_t low = bits(16);
    return low | bits(count - 16) << 16;
  }
  length_ >>= count;
  const std::uint32_t value = value_ / length_;
  if (value >> count != 0) throw FormatError("has bytes that no encoder writes");
  value_ -= value * length_;
  if (length_ < least_length) renormalise();
  return value;
}

/// Encoders write more than decoders need; some leave out zeros at the end.
std::uint8_t ArithmeticDecoder::pastEnd()
{
  constexpr unsigned most = 8;
  if (++past_end_ > most) throw FormatError("ends before its points do");
  return 0;
}

} // namespace pcl_bsh::io::laz
