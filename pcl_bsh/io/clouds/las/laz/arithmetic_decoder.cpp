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

void SymbolModel::prepare()
{
  constexpr unsigned bytes = 256; // symbols of most models, which are copied: small chunks use them for a few points
  static const SymbolModel fresh = [] {
    SymbolModel model(bytes);
    model.start();
    return model;
  }();
  if (!numbers_.empty())
    update();
  else if (symbols_ == bytes)
    *this = fresh;
  else
    start();
}

void SymbolModel::start()
{
  const unsigned slot_bits = static_cast<unsigned>(std::bit_width(symbols_ - 1));
  slot_shift_ = place_bits - slot_bits;
  // The interval's length is no multiple of its 2^15 parts: places reach up to 63 beyond 2^15.
  const std::size_t slots = (std::size_t{1} << slot_bits) + (std::size_t{63} >> slot_shift_) + 1;
  numbers_.assign(slotsAt() + slots, 1);
  numbers_[slotsAt() - 2] = std::numeric_limits<std::uint16_t>::max();
  total_ = 0;
  cycle_ = symbols_;
  update();
  cycle_ = until_update_ = (symbols_ + 6) / 2;
}

void SymbolModel::update()
{
  std::uint16_t* const slots = numbers_.data() + slotsAt();
  total_ += cycle_;
  if (total_ > most_count) {
    total_ = 0;
    for (std::uint16_t* entry = numbers_.data(); entry != slots - 2; entry += 2) {
      entry[1] = static_cast<std::uint16_t>((entry[1] + 1) / 2);
      total_ += entry[1];
    }
  }
  const std::uint32_t scale = (1U << 31) / total_, round_up = (1U << slot_shift_) - 1;
  std::uint32_t sum = 0;
  std::uint16_t* slot = slots;
  for (unsigned twice = 0; twice < 2 * symbols_; twice += 2) {
    std::uint16_t* const entry = numbers_.data() + twice;
    entry[0] = static_cast<std::uint16_t>(scale * sum >> (31 - place_bits));
    sum += entry[1];
    for (const std::uint16_t* const end = slots + ((entry[0] + round_up) >> slot_shift_); slot < end;)
      *slot++ = static_cast<std::uint16_t>(twice - 2);
  }
  std::fill(slot, numbers_.data() + numbers_.size(), static_cast<std::uint16_t>(2 * symbols_ - 2));
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

ArithmeticDecoder::ArithmeticDecoder(std::string_view bytes) : bytes_(bytes)
{
  const auto first = static_cast<unsigned>(sizeof value_);
  value_ = bytes.size() >= first ? nextFour() : lastOnes(first);
  at_ += first;
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
  renormalise();
  return value;
}

/// Behind the end come zeros: encoders write more than decoders need, but some leave out zeros there.
std::uint32_t ArithmeticDecoder::lastOnes(unsigned bytes)
{
  constexpr std::size_t most_beyond = 8;
  if (at_ + bytes > bytes_.size() + most_beyond) throw FormatError("ends before its points do");
  std::uint32_t ones = 0;
  for (std::size_t i = at_; i < at_ + 4; ++i)
    ones = ones << 8 | (i < bytes_.size() ? static_cast<std::uint8_t>(bytes_[i]) : 0U);
  return ones;
}

} // namespace pcl_bsh::io::laz
