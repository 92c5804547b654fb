// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/pcd/lzf.h>

#include <gmock/gmock.h>
#include <pcl/io/lzf.h>

#include <random>
#include <vector>

namespace pcl_bsh::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Bytes of so many values, and parts that come again from near and far.
Bytes repeating(unsigned seed, std::size_t count, unsigned values)
{
  std::mt19937 random(seed);
  Bytes bytes;
  while (bytes.size() < count) {
    const std::size_t length = random() % 600;
    const std::size_t from = bytes.empty() ? 0 : random() % bytes.size();
    const bool is_new = bytes.empty() || random() % 3 == 0;
    for (std::size_t i = 0; i < length; ++i)
      bytes.push_back(is_new ? static_cast<std::uint8_t>(random() % values) : bytes[from + i]);
  }
  bytes.resize(count);
  return bytes;
}

/// By both readers; tells whether they agree.
bool areReadAlike(const std::string& stream, std::size_t count, Bytes& bytes)
{
  bytes.assign(count, 0xAA);
  Bytes others = bytes;
  const bool is_sound = readLzf(stream, bytes);
  const unsigned read = pcl::lzfDecompress(stream.data(), static_cast<unsigned>(stream.size()), others.data(),
                                           static_cast<unsigned>(count));
  return is_sound ? read == count && bytes == others : read != count;
}

} // namespace

TEST(Lzf, BothReadersReadWhatItWrites)
{
  for (unsigned seed = 0; seed < 2000; ++seed) {
    const Bytes bytes = repeating(seed, seed < 600 ? seed : seed * 37, seed % 7 == 0 ? 256 : 1 + seed % 7);
    const std::string stream = lzfOf(bytes);
    EXPECT_LE(stream.size(), bytes.size() + (bytes.size() + 31) / 32);
    Bytes read;
    if (bytes.empty()) {
      EXPECT_EQ(stream, "");
    }
    else {
      ASSERT_TRUE(areReadAlike(stream, bytes.size(), read)) << seed;
      ASSERT_EQ(read, bytes) << seed;
    }
  }
}

TEST(Lzf, IsAsShortAsThatOfPcl)
{
  for (const std::size_t count : std::vector<std::size_t>{1000, 100'000, 1'000'000}) {
    const Bytes bytes = repeating(7, count, 256);
    Bytes other(2 * count);
    const unsigned length =
        pcl::lzfCompress(bytes.data(), static_cast<unsigned>(count), other.data(), static_cast<unsigned>(other.size()));
    EXPECT_LE(lzfOf(bytes).size(), length * 1.01) << count;
  }
}

TEST(Lzf, ReadsWhatPclWrites)
{
  for (unsigned seed = 1; seed < 200; ++seed) {
    const Bytes bytes = repeating(seed, seed * 300, 1 + seed % 9);
    std::string stream(2 * bytes.size() + 64, ' ');
    stream.resize(pcl::lzfCompress(bytes.data(), static_cast<unsigned>(bytes.size()), stream.data(),
                                   static_cast<unsigned>(stream.size())));
    Bytes read(bytes.size());
    ASSERT_TRUE(readLzf(stream, read)) << seed;
    ASSERT_EQ(read, bytes) << seed;
  }
}

/// Streams cut short, longer, and with bytes that are others.
TEST(Lzf, RefusesWhatPclRefuses)
{
  std::mt19937 random(3);
  int refused = 0;
  for (int round = 0; round < 20'000; ++round) {
    const auto seed = static_cast<unsigned>(random());
    const Bytes bytes = repeating(seed, 1 + seed % 3000, 1 + seed % 5);
    std::string stream = lzfOf(bytes);
    switch (random() % 3) {
    case 0:
      stream.resize(1 + random() % stream.size());
      break;
    case 1:
      stream.push_back(static_cast<char>(random()));
      break;
    default:
      stream[random() % stream.size()] = static_cast<char>(random());
      break;
    }
    Bytes read;
    ASSERT_TRUE(areReadAlike(stream, bytes.size(), read)) << round;
    refused += !readLzf(stream, read);
  }
  EXPECT_GT(refused, 5000);
}

TEST(Lzf, KnowsItsFormat)
{
  const auto read = [](const std::string& stream, std::size_t count) {
    Bytes bytes(count);
    return readLzf(stream, bytes) ? std::string(bytes.begin(), bytes.end()) : "refused";
  };
  using namespace std::string_literals;
  EXPECT_EQ(read("\2abc"s, 3), "abc");
  EXPECT_EQ(read("\2abc\x40\2"s, 7), "abcabca"); // four from three before: what it copies is what it wrote
  EXPECT_EQ(read("\0a\xE0\xFF\0"s, 265), std::string(265, 'a'));
  EXPECT_EQ(read("\2abc\x40\3"s, 7), "refused"); // from before the beginning
  EXPECT_EQ(read("\2abc\x40"s, 7), "refused");
  EXPECT_EQ(read("\0a\xE0\xFF"s, 265), "refused");
  EXPECT_EQ(read("\2abc\x40\2"s, 6), "refused"); // too long
  EXPECT_EQ(read("\2abc\x40\2"s, 8), "refused"); // too short
  EXPECT_EQ(read("\2ab"s, 3), "refused");
}

} // namespace pcl_bsh::io
