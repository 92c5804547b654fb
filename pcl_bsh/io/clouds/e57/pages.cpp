// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/e57/pages.h>
#include <pcl_bsh/io/clouds/stored_number.h>
#include <pcl_bsh/io/text/format_error.h>

#include <boost/endian/conversion.hpp>

#include <algorithm>
#include <array>
#include <cstring>

namespace pcl_bsh::io {

namespace {

constexpr std::size_t e57_head_bytes = 48;
constexpr std::uint64_t least_page = 64, most_page = std::uint64_t{1} << 20;
constexpr std::uint64_t window_bytes = std::uint64_t{1} << 17;
constexpr std::uint64_t most_xml = std::uint64_t{1} << 25; ///< ten thousand scans have less

/// Row k: the checksums of a byte that k zeros follow, so that eight bytes are taken at once.
using ChecksumTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr ChecksumTables makeChecksumTables()
{
  constexpr std::uint32_t polynomial = 0x82f63b78U; // Castagnoli's, its bits reversed
  ChecksumTables made{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? polynomial : 0);
    made[0][byte] = rest;
  }
  for (std::size_t row = 1; row < made.size(); ++row)
    for (std::size_t byte = 0; byte < 256; ++byte)
      made[row][byte] = (made[row - 1][byte] >> 8U) ^ made[0][made[row - 1][byte] & 0xffU];
  return made;
}

constexpr ChecksumTables checksum_tables = makeChecksumTables();

} // namespace

std::uint32_t crc32c(const std::uint8_t* bytes, std::size_t count) noexcept
{
  std::uint32_t sum = ~std::uint32_t{0};
  for (; count >= 8; bytes += 8, count -= 8) {
    const std::uint32_t low = loaded<std::uint32_t>(bytes) ^ sum, high = loaded<std::uint32_t>(bytes + 4);
    sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum ^= checksum_tables[7 - i][low >> 8 * i & 0xffU];
      sum ^= checksum_tables[3 - i][high >> 8 * i & 0xffU];
    }
  }
  for (; count > 0; ++bytes, --count) sum = (sum >> 8U) ^ checksum_tables[0][(sum ^ *bytes) & 0xffU];
  return ~sum;
}

E57Pages::E57Pages(std::unique_ptr<ByteSource> file) : file_(std::move(file))
{
  const std::uint64_t there = file_->size();
  const std::string head = file_->text(0, static_cast<std::size_t>(std::min<std::uint64_t>(there, e57_head_bytes)));
  if (head.substr(0, 8) != "ASTM-E57") throw FormatError("is not an E57 file: it does not begin with ASTM-E57");
  if (head.size() < e57_head_bytes) throw FormatError("is truncated: it ends within its header");
  if (const auto major = loaded<std::uint32_t>(&head[8]); major != 1)
    throw FormatError("is of version " + std::to_string(major) + " of E57", "export it as E57 1.0");
  file_bytes_ = loaded<std::uint64_t>(&head[16]);
  xml_at_ = loaded<std::uint64_t>(&head[24]);
  xml_bytes_ = loaded<std::uint64_t>(&head[32]);
  page_ = loaded<std::uint64_t>(&head[40]);
  if (page_ < least_page || page_ > most_page || page_ % 4 != 0)
    throw FormatError("has pages of " + std::to_string(page_) + " bytes, which E57 has not");
  if (file_bytes_ > there || file_bytes_ < page_)
    throw FormatError("is truncated: its header promises " + std::to_string(file_bytes_) + " bytes, and " +
                      std::to_string(there) + " are there");
  file_bytes_ -= file_bytes_ % page_;
}

std::uint64_t E57Pages::logical(std::uint64_t physical) const
{
  const std::uint64_t within = physical % page_;
  if (physical >= file_bytes_ || within >= payload())
    throw FormatError("points to byte " + std::to_string(physical) + ", where it has no content");
  return physical / page_ * payload() + within;
}

void E57Pages::fillWindow(std::uint64_t page)
{
  const std::uint64_t pages = std::min(std::max<std::uint64_t>(window_bytes / page_, 1), file_bytes_ / page_ - page);
  window_.clear(); // should reading throw
  std::string bytes = file_->text(page * page_, static_cast<std::size_t>(pages * page_));
  for (std::size_t i = 0; i < pages; ++i) {
    const char* const from = bytes.data() + i * page_;
    if (crc32c(reinterpret_cast<const std::uint8_t*>(from), payload()) !=
        boost::endian::big_to_native(loaded<std::uint32_t>(from + payload()))) // nothing else is big-endian
      throw FormatError("is damaged: page " + std::to_string(page + i) + " has another checksum than it says");
    std::memmove(bytes.data() + i * payload(), from, payload());
  }
  bytes.resize(static_cast<std::size_t>(pages * payload()));
  window_ = std::move(bytes);
  window_at_ = page * payload();
}

void E57Pages::read(std::uint64_t at, std::uint8_t* to, std::size_t count)
{
  if (at > size() || count > size() - at) throw FormatError("is truncated: it ends within what it points to");
  while (count > 0) {
    if (at < window_at_ || at - window_at_ >= window_.size()) fillWindow(at / payload());
    const std::uint64_t from = at - window_at_;
    const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(count, window_.size() - from));
    std::memcpy(to, window_.data() + from, bytes);
    at += bytes;
    to += bytes;
    count -= bytes;
  }
}

std::string E57Pages::xml()
{
  if (xml_bytes_ > most_xml)
    throw FormatError("says that its XML has " + std::to_string(xml_bytes_) + " bytes, more than " +
                          std::to_string(most_xml),
                      "export its scans to several files");
  const std::uint64_t at = logical(xml_at_);
  if (xml_bytes_ > size() - at) throw FormatError("is truncated: it ends within its XML");
  std::string text(static_cast<std::size_t>(xml_bytes_), '\0');
  read(at, reinterpret_cast<std::uint8_t*>(text.data()), text.size());
  return text;
}

} // namespace pcl_bsh::io
