// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/pcd/lzf.h>

#include <algorithm>
#include <vector>

namespace pcl_bsh::io {
namespace {

constexpr std::size_t most_literals = 32, least_copied = 3, most_copied = 264, farthest = 8192;
constexpr unsigned longer = 7; ///< the length that another byte goes on

void appendLiterals(std::string& stream, std::span<const std::uint8_t> bytes)
{
  while (!bytes.empty()) {
    const std::span<const std::uint8_t> some = bytes.first(std::min(bytes.size(), most_literals));
    stream.push_back(static_cast<char>(some.size() - 1));
    stream.append(some.begin(), some.end());
    bytes = bytes.subspan(some.size());
  }
}

void appendCopy(std::string& stream, std::size_t length, std::size_t distance)
{
  const std::size_t rest = length - 2, back = distance - 1, upper = std::min<std::size_t>(rest, longer);
  stream.push_back(static_cast<char>(upper << 5 | back >> 8));
  if (upper == longer) stream.push_back(static_cast<char>(rest - longer));
  stream.push_back(static_cast<char>(back));
}

} // namespace

std::string lzfOf(std::span<const std::uint8_t> bytes)
{
  constexpr unsigned bits = 16;
  std::vector<std::uint32_t> last(std::size_t{1} << bits); // where three bytes of a hash were last
  const auto lastOf = [&](std::size_t at) -> std::uint32_t& {
    const std::uint32_t three = bytes[at] | std::uint32_t{bytes[at + 1]} << 8 | std::uint32_t{bytes[at + 2]} << 16;
    return last[three * 2654435761u >> (32 - bits)]; // Fibonacci hashing (Knuth, volume 3, section 6.4)
  };
  std::string stream;
  stream.reserve(bytes.size() + (bytes.size() + most_literals - 1) / most_literals); // all that it can take
  std::size_t at = 0, literals = 0; // from `literals` on nothing is written yet
  while (at + least_copied <= bytes.size()) {
    std::uint32_t& earlier = lastOf(at);
    const std::size_t from = earlier;
    earlier = static_cast<std::uint32_t>(at);
    const std::size_t most = std::min(most_copied, bytes.size() - at);
    std::size_t length = 0;
    if (from < at && at - from <= farthest)
      while (length < most && bytes[from + length] == bytes[at + length]) ++length;
    if (length < least_copied) {
      ++at;
      continue;
    }
    appendLiterals(stream, bytes.subspan(literals, at - literals));
    appendCopy(stream, length, at - from);
    literals = at + length;
    while (++at < literals)
      if (at + least_copied <= bytes.size()) lastOf(at) = static_cast<std::uint32_t>(at);
  }
  appendLiterals(stream, bytes.subspan(literals));
  return stream;
}

bool readLzf(std::string_view stream, std::span<std::uint8_t> bytes)
{
  std::size_t at = 0, filled = 0;
  const auto next = [&] { return static_cast<std::uint8_t>(stream[at++]); };
  while (at < stream.size()) {
    const unsigned control = next();
    if (control < most_literals) {
      const std::size_t count = control + 1;
      if (count > stream.size() - at || count > bytes.size() - filled) return false;
      std::copy_n(stream.data() + at, count, bytes.data() + filled);
      at += count;
      filled += count;
      continue;
    }
    std::size_t length = control >> 5;
    if (stream.size() - at < (length == longer ? 2u : 1u)) return false;
    if (length == longer) length += next();
    length += 2;
    const std::size_t distance = ((control & 31) << 8 | next()) + 1;
    if (distance > filled || length > bytes.size() - filled) return false;
    for (; length != 0; --length, ++filled) bytes[filled] = bytes[filled - distance]; // may copy what it writes
  }
  return filled == bytes.size();
}

} // namespace pcl_bsh::io
