// SPDX-License-Identifier: BSD-3-Clause
#include "laz_encoder.h"
#include "laz_sample.h"

#include "io/text/defect.h"

#include <pcl_bsh/io/clouds/las/unpacked_laz.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

#include <filesystem>

namespace pcl_bsh::io {

namespace {

using laz_test::compressed;
using laz_test::LazOptions;

std::string unpacked(const std::string& laz, unsigned threads = 1)
{
  const auto file = unpackedLaz(std::make_unique<HeldBytes>(laz), threads);
  return file->text(0, static_cast<std::size_t>(file->size()));
}

/// Where two texts differ first; none where they are the same.
std::string differenceOf(const std::string& a, const std::string& b)
{
  if (a.size() != b.size()) return std::to_string(a.size()) + " bytes against " + std::to_string(b.size());
  const auto at = std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin();
  return at == static_cast<std::ptrdiff_t>(a.size()) ? std::string() : "byte " + std::to_string(at);
}

/// Why it is refused; empty when it is not.
std::string refusal(const std::string& laz)
{
  try {
    unpacked(laz);
    return "";
  }
  catch (const FormatError& error) {
    return error.what();
  }
}

std::vector<unsigned> versionsOf(unsigned format)
{
  return format < 6 ? std::vector<unsigned>{1, 2} : std::vector<unsigned>{3, 4};
}

LasSample scan(std::uint8_t format, std::size_t points, std::size_t extra = 0, unsigned channels = 1)
{
  LasSample sample(format < 6 ? 2 : 4, format, extra);
  if (format == 4 || format == 5) sample.minor = 3;
  addScan(sample, points, 1, channels);
  return sample;
}

} // namespace

TEST(UnpackedLaz, EveryFormatAndVersionOfItemsIsTheSameByteForByte)
{
  for (std::uint8_t format = 0; format <= 10; ++format) {
    for (const unsigned version : versionsOf(format)) {
      for (const unsigned channels : {1U, 4U}) {
        for (const std::size_t extra : {0u, 1u, 7u}) {
          SCOPED_TRACE("format " + std::to_string(format) + ", version " + std::to_string(version) + ", extra bytes " +
                       std::to_string(extra) + ", channels " + std::to_string(channels));
          LazOptions options;
          options.version = version;
          options.chunk_points = 700;
          const std::string las = scan(format, 2000, extra, channels).text();
          EXPECT_EQ(differenceOf(unpacked(compressed(las, options)), las), "");
          LasSample random(4, format, extra);
          random.addPoints(500, format);
          options.chunk_points = 300;
          EXPECT_EQ(differenceOf(unpacked(compressed(random.text(), options)), random.text()), "");
        }
      }
    }
  }
}

/// With so many points models are halved, and intervals carry.
TEST(UnpackedLaz, ManyPointsOfAChunk)
{
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{3, 6}) {
    LazOptions options;
    options.chunk_points = 60000;
    const std::string las = scan(format, 60000).text();
    EXPECT_EQ(differenceOf(unpacked(compressed(las, options)), las), "") << unsigned{format};
  }
}

TEST(UnpackedLaz, EveryKindOfChunks)
{
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{1, 7}) {
    const std::string las = scan(format, 1000).text();
    for (const bool at_end : {false, true}) {
      LazOptions options;
      options.place_of_table_at_end = at_end;
      for (const std::uint32_t points : {1U, 999U, 1000U, 1001U, 0xfffffffeU}) {
        options.chunk_points = points;
        EXPECT_EQ(differenceOf(unpacked(compressed(las, options)), las), "") << points;
      }
      for (const std::vector<std::uint32_t>& chunks :
           {std::vector<std::uint32_t>{1000}, {1, 1, 998}, {500, 20, 470, 10}, {990, 20}, {0, 600, 0, 400}}) {
        options.chunks = chunks;
        EXPECT_EQ(differenceOf(unpacked(compressed(las, options)), las), "") << chunks.size();
      }
    }
  }
  const std::string las = scan(3, 1000).text();
  LazOptions options;
  options.one_stream = true;
  EXPECT_EQ(differenceOf(unpacked(compressed(las, options)), las), "");
  options.version = 1;
  EXPECT_EQ(differenceOf(unpacked(compressed(las, options)), las), "");
}

TEST(UnpackedLaz, ChunksOfOneSizeNeedNoTable)
{
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{0, 3, 6, 10}) {
    for (const unsigned version : versionsOf(format)) {
      LasSample sample = scan(format, 300, 2, 3);
      if (format >= 6) sample.extended = {LasSample::extendedRecord("somebody", 9, "more")};
      if (format >= 6) sample.minor = 4;
      const std::string las = sample.text();
      LazOptions options;
      options.version = version;
      options.without_table = true;
      for (const std::uint32_t points : {1U, 7U, 299U, 300U, 0xfffffffeU}) {
        options.chunk_points = points;
        EXPECT_EQ(differenceOf(unpacked(compressed(las, options)), las), "") << unsigned{format} << ' ' << points;
      }
    }
  }
  LasSample sample(4, 7, 970); // more than is unpacked at once
  addScan(sample, 9000);
  const std::string las = sample.text();
  LazOptions options;
  options.without_table = true;
  const std::string laz = compressed(las, options);
  const auto file = unpackedLaz(std::make_unique<HeldBytes>(laz), 2);
  for (const std::size_t point : {8999u, 50u, 8800u, 4000u, 3999u, 200u, 8500u, 0u}) {
    const std::size_t at = get<std::uint32_t>(las, 96) + point * sample.length();
    ASSERT_EQ(file->text(at, sample.length()), las.substr(at, sample.length())) << point;
  }
}

TEST(UnpackedLaz, WithoutATableWhatIsMissingIsRefused)
{
  using testing::HasSubstr;
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{1, 8}) {
    const LasSample sample = scan(format, 500);
    LazOptions options;
    options.without_table = true;
    const std::string laz = compressed(sample.text(), options);
    const std::size_t first_chunk = get<std::uint32_t>(laz, 96) + 8;
    for (const std::size_t size :
         {first_chunk, first_chunk + 3, first_chunk + sample.length(), laz.size() / 2, laz.size() - 20}) {
      const std::string text = refusal(laz.substr(0, size));
      EXPECT_TRUE(text.find("ends before its points do") != std::string::npos ||
                  text.find("more bytes than itself") != std::string::npos ||
                  text.find("in 0 bytes") != std::string::npos)
          << size << ": " << text;
    }
    std::string lying = laz;
    put(lying, format < 6 ? 107 : 247, 0x7fffffffU);
    EXPECT_THAT(refusal(lying), HasSubstr("should have 2147483647 points in"));
    put(lying, format < 6 ? 107 : 247, 501U); // one more than there are
    EXPECT_THAT(refusal(lying), HasSubstr("chunk 1 of 1"));
    const std::size_t scheme_at = laz.find("laszip encoded") + 52;
    lying = laz;
    put(lying, scheme_at + 12, 99U); // chunks end where no other begins
    EXPECT_THAT(refusal(lying), HasSubstr("is damaged"));
    options.chunks = {100, 400};
    EXPECT_THAT(refusal(compressed(sample.text(), options)), HasSubstr("chunks of different sizes, and no table"));
    if (format >= 6) {
      lying = laz; // records that begin among the points' first bytes
      put(lying, 235, std::uint64_t{first_chunk - 4});
      put(lying, 243, 1U);
      EXPECT_NE(refusal(lying), "");
    }
  }
}

/// They say where chunks are, which are not there any more.
TEST(UnpackedLaz, LeavesOutWhereThePartsOfCopcAre)
{
  LasSample plain(4, 7, 2);
  plain.records = {LasSample::record("LASF_Projection", 2112, "PROJCS[...]"), LasSample::record("copc", 7, "other")};
  plain.extended = {LasSample::extendedRecord("before", 1, "a"), LasSample::extendedRecord("copc", 1001, "other"),
                    LasSample::extendedRecord("somebody", 1000, "c")};
  addScan(plain, 300);
  LasSample copc = plain;
  copc.records.insert(copc.records.begin(), LasSample::record("copc", 1, std::string(160, 'i')));
  const std::string hierarchy = LasSample::extendedRecord("copc", 1000, std::string(96, 'h'));
  LazOptions options;
  options.chunks = {100, 200};
  for (std::ptrdiff_t at = 0; at <= 3; ++at) {
    LasSample one = copc;
    one.extended.insert(one.extended.begin() + at, hierarchy);
    for (const bool at_end : {false, true}) {
      options.place_of_table_at_end = at_end;
      EXPECT_EQ(differenceOf(unpacked(compressed(one.text(), options)), plain.text()), "") << at;
    }
    one.extended.insert(one.extended.begin(), hierarchy);
    EXPECT_EQ(differenceOf(unpacked(compressed(one.text(), options)), plain.text()), "") << "two, " << at;
  }
  plain.extended.clear();
  copc.extended = {hierarchy};
  options.place_of_table_at_end = false;
  const std::string laz = compressed(copc.text(), options);
  EXPECT_EQ(differenceOf(unpacked(laz), plain.text()), "");
  EXPECT_THAT(refusal(laz.substr(0, laz.size() - 1)), testing::HasSubstr("extended record 1 of 1"));
}

TEST(UnpackedLaz, NoPoints)
{
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{0, 10}) {
    const std::string las = scan(format, 0).text();
    EXPECT_EQ(differenceOf(unpacked(compressed(las)), las), "");
  }
}

TEST(UnpackedLaz, RecordsBeforeAndBehindThePoints)
{
  LasSample sample = scan(9, 300, 3);
  sample.user_bytes = "user data behind the header";
  sample.records = {LasSample::record("LASF_Projection", 2112, "PROJCS[...]"), LasSample::record("nobody", 7, "")};
  sample.padding = "padding";
  sample.extended = {LasSample::extendedRecord("LASF_Spec", 65535, std::string(100, 'w')),
                     LasSample::extendedRecord("somebody", 9, "more")};
  sample.global_encoding = 2 | 16;
  for (const bool at_end : {false, true}) {
    LazOptions options;
    options.place_of_table_at_end = at_end;
    EXPECT_EQ(differenceOf(unpacked(compressed(sample.text(), options)), sample.text()), "");
  }
  sample.global_encoding = 16;
  sample.extended.clear();
  EXPECT_EQ(differenceOf(unpacked(compressed(sample.text())), sample.text()), "");
}

TEST(UnpackedLaz, UncompressedFilesAreThemselves)
{
  const std::string las = scan(3, 10).text();
  EXPECT_EQ(differenceOf(unpacked(las), las), "");
}

TEST(UnpackedLaz, AnyNumberOfThreadsAndAnyOrder)
{
  const std::string las = scan(8, 5000, 2).text();
  const std::string laz = compressed(las);
  for (const unsigned threads : {0U, 1U, 2U, 5U}) EXPECT_EQ(differenceOf(unpacked(laz, threads), las), "") << threads;
  const auto file = unpackedLaz(std::make_unique<HeldBytes>(laz), 2);
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    const std::size_t at = random() % las.size(), count = std::min<std::size_t>(random() % 3000, las.size() - at);
    ASSERT_EQ(file->text(at, count), las.substr(at, count)) << at;
  }
}

/// A chunk of more than 4 MB of points is unpacked in pieces.
TEST(UnpackedLaz, LargeChunksInAnyOrder)
{
  LasSample sample(4, 6, 970);
  addScan(sample, 9000);
  const std::string las = sample.text();
  LazOptions options;
  options.chunks = {100, 8800, 100};
  const std::string laz = compressed(las, options);
  EXPECT_EQ(differenceOf(unpacked(laz, 2), las), "");
  const auto file = unpackedLaz(std::make_unique<HeldBytes>(laz), 2);
  for (const std::size_t point : {8999u, 50u, 8800u, 4000u, 3999u, 200u, 8500u, 8899u, 8900u, 100u}) {
    const std::size_t at = get<std::uint32_t>(las, 96) + point * sample.length();
    ASSERT_EQ(file->text(at, sample.length()), las.substr(at, sample.length())) << point;
  }
}

TEST(UnpackedLaz, WhatIsLeftOutIsRefusedByItsName)
{
  using testing::HasSubstr;
  const std::string of_1 = compressed(scan(1, 20).text()), of_6 = compressed(scan(6, 20, 2).text());
  const auto scheme_at = [](const std::string& laz) { return laz.find("laszip encoded") + 52; };
  const auto with = [&](std::string laz, std::size_t at, std::uint16_t value) {
    put(laz, scheme_at(laz) + at, value);
    return refusal(laz);
  };
  constexpr std::size_t second_item = 34 + 6;
  EXPECT_THAT(with(of_1, 0, 0), HasSubstr("method 0"));
  EXPECT_THAT(with(of_1, 0, 4), HasSubstr("method 4"));
  EXPECT_THAT(with(of_1, 2, 1), HasSubstr("coder 1"));
  EXPECT_THAT(with(of_1, 32, 0), HasSubstr("not complete"));
  EXPECT_THAT(with(of_1, 32, 1000), HasSubstr("not complete"));
  EXPECT_THAT(with(of_1, second_item + 4, 3), HasSubstr("GPSTIME11 in version 3"));
  EXPECT_THAT(with(of_1, second_item + 4, 0), HasSubstr("GPSTIME11 in version 0"));
  EXPECT_THAT(with(of_1, second_item, 2), HasSubstr("type 2"));
  EXPECT_THAT(with(of_1, second_item, 99), HasSubstr("type 99"));
  EXPECT_THAT(with(of_1, second_item, 10), HasSubstr("POINT14"));
  EXPECT_THAT(with(of_1, second_item + 2, 7), HasSubstr("GPSTIME11 of 7 bytes"));
  EXPECT_THAT(with(of_6, second_item + 2, 0), HasSubstr("BYTE14 of 0 bytes"));
  EXPECT_THAT(with(of_6, second_item + 2, 1), HasSubstr("take 32 bytes each, of which 31"));
  EXPECT_THAT(with(of_6, second_item, 0), HasSubstr("BYTE in version 3"));
  EXPECT_THAT(with(of_6, 34 + 4, 5), HasSubstr("POINT14 in version 5"));
  EXPECT_THAT(with(of_6, second_item, 10), HasSubstr("POINT14 of 2 bytes"));

  std::string nameless = of_1;
  nameless[nameless.find("laszip encoded")] = 'L';
  EXPECT_THAT(refusal(nameless), HasSubstr("laszip encoded"));
}

TEST(UnpackedLaz, TablesThatLieAreRefused)
{
  using testing::HasSubstr;
  const LasSample sample = scan(6, 500);
  const std::string laz = compressed(sample.text());
  const std::size_t points_at = get<std::uint32_t>(laz, 96);
  const auto table_at = get<std::uint64_t>(laz, points_at);
  for (const std::uint64_t place : {std::uint64_t{0}, std::uint64_t{points_at}, ~std::uint64_t{1},
                                    std::uint64_t{1} << 63, std::uint64_t{laz.size()}, std::uint64_t{laz.size()} - 7}) {
    std::string lying = laz;
    put(lying, points_at, place);
    EXPECT_THAT(refusal(lying), HasSubstr("no table of its chunks")) << place;
  }
  std::string lying = laz;
  put(lying, table_at + 4, 0xffffffffU);
  EXPECT_THAT(refusal(lying), HasSubstr("4294967295"));
  put(lying, table_at + 4, 3U);
  EXPECT_THAT(refusal(lying), HasSubstr("promises 500 points, its chunks have 300"));
  put(lying, table_at, 1U);
  EXPECT_THAT(refusal(lying), HasSubstr("version 1"));

  lying = laz; // of points beyond all numbers
  put(lying, 247, std::uint64_t{1} << 63);
  EXPECT_THAT(refusal(lying), HasSubstr("promises 9223372036854775808 points, its chunks have 500"));
  const std::size_t scheme_at = laz.find("laszip encoded") + 52;
  put(lying, scheme_at + 12, 0xfffffffeU);
  EXPECT_THAT(refusal(lying), HasSubstr("chunk 1 of 5 should have 4294967294 points in"));
  LazOptions options;
  options.one_stream = true;
  lying = compressed(scan(1, 5).text(), options);
  put(lying, 107, 0xffffffffU);
  EXPECT_THAT(refusal(lying), HasSubstr("only chunk should have 4294967295 points in"));

  LazOptions differing; // sizes of chunks that the file has no room for
  differing.chunks = {250, 250};
  lying = compressed(sample.text(), differing);
  const auto at = get<std::uint64_t>(lying, get<std::uint32_t>(lying, 96));
  for (std::size_t i = at + 8; i < lying.size(); ++i) {
    std::string other = lying;
    other[i] = static_cast<char>(other[i] ^ 0x55);
    const std::string text = refusal(other);
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

TEST(UnpackedLaz, DamagedChunksAreRefusedByTheirNumber)
{
  using testing::HasSubstr;
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{3, 10}) {
    SCOPED_TRACE(unsigned{format});
    const LasSample sample = scan(format, 500, 3);
    LazOptions options;
    options.chunk_points = 400;
    const std::string laz = compressed(sample.text(), options);
    const std::size_t points_at = get<std::uint32_t>(laz, 96);
    std::string cut = laz; // bytes in the middle are gone, but those behind stay where they were
    const std::size_t from = points_at + 8 + sample.length() + 200;
    std::fill(cut.begin() + static_cast<std::ptrdiff_t>(from), cut.begin() + static_cast<std::ptrdiff_t>(from) + 3000,
              '\xff');
    EXPECT_THAT(refusal(cut), HasSubstr("chunk 1 of 2, from byte " + std::to_string(points_at + 8))) << refusal(cut);
    for (const std::size_t size : {points_at + 4, points_at + 100, laz.size() / 2, laz.size() - 12}) {
      const std::string text = refusal(laz.substr(0, size));
      EXPECT_THAT(text, HasSubstr("truncated")) << size;
    }
  }
}

TEST(UnpackedLaz, LayersThatLieAreRefused)
{
  using testing::HasSubstr;
  const LasSample sample = scan(6, 300);
  LazOptions options;
  options.chunk_points = 300;
  const std::string laz = compressed(sample.text(), options);
  const std::size_t sizes_at = get<std::uint32_t>(laz, 96) + 8 + sample.length();
  std::string lying = laz;
  put(lying, sizes_at, 299U);
  EXPECT_THAT(refusal(lying), HasSubstr("has 299 points, not 300"));
  lying = laz;
  put(lying, sizes_at + 4, 0xffffffffU);
  EXPECT_THAT(refusal(lying), HasSubstr("layers of more bytes"));
  lying = laz;
  put(lying, sizes_at + 4, 0U);
  EXPECT_THAT(refusal(lying), HasSubstr("chunk 1 of 1"));
}

/// Whatever a byte says, the answer is points or one line.
TEST(UnpackedLaz, AnyByteMayBeAnother)
{
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{5, 10}) {
    const std::string laz = compressed(scan(format, 30, 2).text());
    std::size_t refused = 0;
    for (std::size_t i = 0; i < laz.size(); ++i) {
      for (const int change : {0xff, 0x01}) {
        std::string other = laz;
        other[i] = static_cast<char>(other[i] ^ change);
        const std::string text = refusal(other);
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        if (!text.empty()) ++refused;
      }
    }
    EXPECT_GT(refused, laz.size() / 10);
  }
}

/// Real files of several programs, and what they were made of.
TEST(UnpackedLaz, RealFiles)
{
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(PCL_BSH_SHARED_DIR) / "data/formats/laz";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  for (const char* name : {"no-points-1.3", "pdrf4-1.3", "pdrf6-1.4", "pdrf8-1.4", "pdrf9-1.4", "point-color.las",
                           "point10.las", "extrabytes"}) {
    const std::string laz = contentOf(folder / (std::string(name) + ".laz"));
    fs::path beside = folder / name; // point-color.las beside point-color.las.laz
    if (!beside.has_extension() || beside.extension() != ".las") beside += ".las";
    if (!fs::exists(beside)) beside = folder.parent_path() / beside.filename();
    const std::string las = contentOf(beside);
    const std::string found = unpacked(laz);
    const auto recordsOf = [](const std::string& file) {
      const std::size_t at = get<std::uint32_t>(file, 96), length = get<std::uint16_t>(file, 105);
      return file.substr(at, get<std::uint32_t>(file, 107) * length);
    };
    ASSERT_FALSE(las.empty()) << name;
    EXPECT_EQ(differenceOf(recordsOf(found), recordsOf(las)), "") << name;
  }
}

/// As encoders write it of what is the same in all points of a chunk.
TEST(UnpackedLaz, LayersInWhichNothingChangesAreLeftOut)
{
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{7, 10}) {
    for (const unsigned version : {3U, 4U}) {
      LazOptions options;
      options.version = version;
      const LasSample scanned = scan(format, 150, 3, 3);
      const std::size_t length = scanned.length();
      for (const auto& [from, to] : {std::pair<std::size_t, std::size_t>{8, 12},
                                     {12, 14},
                                     {14, 15},
                                     {15, 16},
                                     {16, 17},
                                     {17, 18},
                                     {18, 20},
                                     {20, 22},
                                     {22, 30},
                                     {30, 36},
                                     {36, 38},
                                     {30, length},
                                     {0, length}}) {
        LasSample sample = scanned;
        for (std::string& point : sample.points)
          for (std::size_t k = from; k < std::min(to, length); ++k) point[k] = scanned.points.front()[k];
        const std::string las = sample.text();
        ASSERT_EQ(differenceOf(unpacked(compressed(las, options)), las), "")
            << unsigned{format} << ' ' << version << ' ' << from;
      }
    }
  }
}

/// A bit that was always equal may still change.
TEST(UnpackedLaz, LongTheSameAndThenNot)
{
  LasSample sample(2, 0);
  sample.points.assign(9000, std::string(sample.length(), '\1'));
  for (std::size_t i = 8500; i < sample.points.size(); i += 3)
    put(sample.points[i], 0, get<std::int32_t>(sample.points[i], 0) + 1);
  LazOptions options;
  options.chunk_points = 9000;
  const std::string las = sample.text();
  EXPECT_EQ(differenceOf(unpacked(compressed(las, options)), las), "");
}

TEST(UnpackedLaz, NoPointsInOneStream)
{
  LazOptions options;
  options.one_stream = true;
  const std::string las = scan(1, 0).text();
  EXPECT_EQ(differenceOf(unpacked(compressed(las, options)), las), "");
}

TEST(UnpackedLaz, ItemsAreToldInFullAndInOrder)
{
  using testing::HasSubstr;
  const std::string sound = compressed(scan(1, 20).text());
  const std::size_t head = sound.find("laszip encoded") - 2, items = head + 54 + 34;
  for (const std::uint16_t bytes : {std::uint16_t{0}, std::uint16_t{33}, std::uint16_t{34}, std::uint16_t{34 + 11}}) {
    std::string cut = sound;
    put(cut, head + 20, bytes);
    EXPECT_THAT(refusal(cut), HasSubstr("has a record of its compression that is not complete")) << bytes;
  }
  EXPECT_EQ(get<std::uint16_t>(sound, items), 6);

  LasSample sample(4, 6, 30);
  addScan(sample, 20);
  const std::string layered = compressed(sample.text());
  const std::size_t first = layered.find("laszip encoded") - 2 + 54 + 34;
  for (const std::size_t item : {std::size_t{0}, std::size_t{1}}) {
    std::string other = layered;
    put(other, first + 6 * item, static_cast<std::uint16_t>(item == 0 ? 14 : 10));
    EXPECT_THAT(refusal(other), HasSubstr("its points do not begin with the one item POINT14")) << item;
  }
}

/// More small chunks than are unpacked at once, in any order.
TEST(UnpackedLaz, ManySmallChunks)
{
  LasSample sample(4, 6, 970);
  sample.points.assign(2500, std::string(sample.length(), '\0'));
  for (std::size_t i = 0; i < sample.points.size(); ++i) put(sample.points[i], 0, static_cast<std::int32_t>(7 * i));
  const std::string las = sample.text();
  const std::string laz = compressed(las);
  for (const unsigned threads : {1U, 2U}) {
    const auto file = unpackedLaz(std::make_unique<HeldBytes>(laz), threads);
    for (const std::size_t point : {0u, 1040u, 1050u, 1099u, 1100u, 2499u, 2200u, 99u, 100u}) {
      const std::size_t at = get<std::uint32_t>(las, 96) + point * sample.length();
      ASSERT_EQ(file->text(at, sample.length()), las.substr(at, sample.length())) << point;
    }
  }
}

} // namespace pcl_bsh::io
