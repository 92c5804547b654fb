// SPDX-License-Identifier: BSD-3-Clause
#include "las_sample.h"
#include "samples.h"
#include "support/verdicts.h"

#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/las/las.h>
#include <pcl_bsh/search/selected_records.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <tuple>

namespace pcl_bsh::io {

namespace {

struct Las {
  pcl::PCLPointCloud2 cloud;
  LasHeader header;
};

Las readText(std::string_view file)
{
  LasReader reader(std::make_unique<HeldBytes>(file));
  Las las;
  las.cloud = reader.readAll();
  las.header = reader.lasHeader();
  return las;
}

/// All records, and how many points each batch had.
struct LasBatches {
  std::vector<std::uint8_t> data;
  std::vector<std::size_t> points;

  LasBatches(LasReader& reader, std::size_t most)
  {
    const std::size_t step = reader.header().point_step;
    std::vector<std::uint8_t> batch(most * step);
    while (const std::size_t count = reader.read(batch.data(), most)) {
      points.push_back(count);
      data.insert(data.end(), batch.begin(), batch.begin() + static_cast<std::ptrdiff_t>(count * step));
    }
  }
};

std::string written(const pcl::PCLPointCloud2& cloud, const LasHeader* header)
{
  std::ostringstream out;
  writeLas(out, cloud, header);
  return out.str();
}

std::string rewritten(const std::string& file)
{
  const Las las = readText(file);
  return written(las.cloud, &las.header);
}

/// Where two texts differ first; none where they are the same.
std::string difference(const std::string& a, const std::string& b)
{
  if (a.size() != b.size()) return std::to_string(a.size()) + " bytes against " + std::to_string(b.size());
  const auto at = std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin();
  return at == static_cast<std::ptrdiff_t>(a.size()) ? std::string() : "byte " + std::to_string(at);
}

LasSample fullSample()
{
  LasSample sample(4, 10, 4 + 2 + 3 + 6 + 8 + 1);
  sample.user_bytes = "user data behind the header";
  const std::string descriptors =
      LasSample::descriptor(9, "amplitude") + LasSample::descriptor(3, "echo width", 8, 0.1) +
      LasSample::descriptor(0, "opaque", 3) + LasSample::descriptor(23, "colour", 16, 0, 5) +
      LasSample::descriptor(7, "serial") + LasSample::descriptor(1, "quality", 1, 0, 0, 255);
  sample.records = {LasSample::record("LASF_Projection", 2112, "PROJCS[...]"),
                    LasSample::record("LASF_Spec", 4, descriptors), LasSample::record("nobody", 7, "")};
  sample.padding = "padding";
  sample.extended = {LasSample::extendedRecord("LASF_Spec", 65535, std::string(100, 'w')),
                     LasSample::extendedRecord("somebody", 9, "more")};
  sample.global_encoding = 2 | 16;
  sample.addPoints(50);
  return sample;
}

/// A cloud of x y z at 0, and of these fields.
pcl::PCLPointCloud2 cloudOf(const std::vector<std::pair<std::string, std::uint8_t>>& fields, std::uint32_t points = 2)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, Field::FLOAT64);
  for (const auto& [name, type] : fields) addField(cloud, name, type);
  allocate(cloud, points);
  return cloud;
}

template <typename T>
void setValue(pcl::PCLPointCloud2& cloud, std::size_t record, const std::string& name, T value)
{
  for (const Field& field : cloud.fields)
    if (field.name == name) std::memcpy(&cloud.data[record * cloud.point_step + field.offset], &value, sizeof value);
}

bool hasField(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  return std::any_of(cloud.fields.begin(), cloud.fields.end(), [&](const Field& field) { return field.name == name; });
}

/// One value of a described field of a file: written, and read again.
double keptValue(std::uint8_t type, const std::string& descriptor, std::size_t bytes, double value)
{
  LasSample sample(4, 6, bytes);
  sample.records = {LasSample::record("LASF_Spec", 4, descriptor)};
  sample.points.assign(3, std::string(sample.length(), '\0'));
  Las las = readText(sample.text());
  EXPECT_EQ(las.cloud.fields.back().datatype, Field::FLOAT64) << int{type};
  setValue(las.cloud, 1, las.cloud.fields.back().name, value);
  const Las again = readText(written(las.cloud, &las.header));
  EXPECT_EQ(valueOf(again.cloud, 0, "e"), valueOf(las.cloud, 0, "e"));
  return valueOf(again.cloud, 1, "e");
}

} // namespace

TEST(Las, EveryVersionAndFormatIsTheSameByteForByte)
{
  for (std::uint8_t minor = 0; minor <= 4; ++minor) {
    for (std::uint8_t format = 0; format <= 10; ++format) {
      LasSample sample(minor, format);
      if (minor == 0) sample.padding = "\xcc\xdd";
      sample.records = {LasSample::record("LASF_Projection", 34735, std::string(64, '\1'))};
      sample.addPoints(100, 10U * minor + format);
      EXPECT_EQ(difference(rewritten(sample.text()), sample.text()), "") << int{minor} << ' ' << int{format};
    }
  }
}

TEST(Las, CoordinatesAreScaledAndMovedInDouble)
{
  LasSample sample(2, 0);
  sample.scale = {0.01, 1e-7, 0.25};
  sample.offset = {637012.24, -9.5, 0};
  sample.addPoints(200);
  const Las las = readText(sample.text());
  ASSERT_EQ(las.cloud.width, 200U);
  for (std::size_t i = 0; i < 200; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double wanted = get<std::int32_t>(sample.points[i], 4 * k) * sample.scale[k] + sample.offset[k];
      EXPECT_EQ(valueOf(las.cloud, i, std::string(1, "xyz"[k])), wanted);
    }
  }
}

/// An offset that absorbs all stored values absorbs the one for no data, too, which must not be written for another.
TEST(Las, NoDataIsNoNeighbourOfAValue)
{
  LasSample sample(4, 6, 2 + 4);
  const std::string descriptors =
      LasSample::descriptor(3, "far", 1 | 16, 0, 1e300, 0) + LasSample::descriptor(9, "off", 1 | 16, 0, -1e300, 0);
  sample.records = {LasSample::record("LASF_Spec", 4, descriptors)};
  sample.addPoints(2);
  put(sample.points[0], 30, std::uint16_t{0});
  put(sample.points[0], 32, 0.0F);
  put(sample.points[1], 30, std::uint16_t{5});
  put(sample.points[1], 32, 7.0F);
  const Las las = readText(sample.text());
  const Las again = readText(written(las.cloud, &las.header));
  EXPECT_EQ(namesOf(again.cloud), namesOf(las.cloud));
  EXPECT_EQ(again.header.descriptors, descriptors);
  EXPECT_TRUE(std::isnan(valueOf(again.cloud, 0, "far")) && std::isnan(valueOf(again.cloud, 0, "off")));
  EXPECT_EQ(valueOf(again.cloud, 1, "far"), 1e300);
  EXPECT_EQ(valueOf(again.cloud, 1, "off"), -1e300);
}

/// Extra bytes may have the name and the type of PCL's packed colours.
TEST(Las, ExtraBytesAreNoColours)
{
  LasSample sample(4, 6, 4 + 4);
  sample.records = {
      LasSample::record("LASF_Spec", 4, LasSample::descriptor(6, "rgba") + LasSample::descriptor(9, "rgb"))};
  sample.addPoints(3);
  const std::string file = sample.text();
  const Las las = readText(file);
  EXPECT_EQ(difference(written(las.cloud, &las.header), file), "");
}

/// Where doubles do not tell multiples of the scale apart, integers may change, coordinates must not.
TEST(Las, CoordinatesStayWhereDoublesAreCoarse)
{
  for (const double scale : {1e-10, 0.3e-10, 1e-17, 1e-310}) {
    LasSample sample(4, 6, 12);
    sample.scale = {scale, -scale, scale};
    sample.offset = {1e6, 1.1e6, -3e9};
    const std::string descriptors =
        LasSample::descriptor(9, "a", 24, 0.1, 1e5) + LasSample::descriptor(10, "b", 24, 0.3, -7);
    sample.records = {LasSample::record("LASF_Spec", 4, descriptors)};
    sample.addPoints(500);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> usual(-100, 100);
    for (std::string& point : sample.points) {
      put(point, 30, static_cast<float>(usual(random)));
      put(point, 34, usual(random));
    }
    const Las las = readText(sample.text());
    const Las again = readText(written(las.cloud, &las.header));
    EXPECT_EQ(namesOf(again.cloud), namesOf(las.cloud));
    EXPECT_TRUE(again.header.descriptors == descriptors) << scale;
    for (std::size_t i = 0; i < 500; ++i) {
      for (const char* name : {"x", "y", "z", "a", "b"}) {
        const double before = valueOf(las.cloud, i, name), after = valueOf(again.cloud, i, name);
        EXPECT_TRUE(before == after || (before != before && after != after)) << name << ' ' << scale;
      }
    }
  }
}

TEST(Las, FieldsOfOldFormats)
{
  LasSample sample(3, 5);
  std::string point(63, '\0');
  put(point, 12, std::uint16_t{40000});
  point[14] = static_cast<char>(3 | 5 << 3 | 1 << 6);  // return 3 of 5, direction
  point[15] = static_cast<char>(17 | 1 << 5 | 1 << 7); // class 17, synthetic, withheld
  point[16] = static_cast<char>(-90);
  point[17] = 9;
  put(point, 18, std::uint16_t{65535});
  put(point, 20, 123456.789);
  put(point, 28, std::uint16_t{0xffff});
  put(point, 30, std::uint16_t{0x8000});
  put(point, 32, std::uint16_t{0x0100});
  point[34] = 2;
  put(point, 35, std::uint64_t{1} << 40);
  put(point, 43, std::uint32_t{256});
  put(point, 47, 1.5F);
  put(point, 51, 0.1F);
  put(point, 55, 0.2F);
  put(point, 59, 0.3F);
  sample.points = {point};
  const pcl::PCLPointCloud2 cloud = readText(sample.text()).cloud;
  EXPECT_EQ(namesOf(cloud),
            "x y z intensity return_number number_of_returns scan_direction edge_of_flight_line classification "
            "synthetic key_point withheld scan_angle user_data point_source_id gps_time red green blue rgb "
            "wave_descriptor wave_offset wave_size wave_location wave_dx wave_dy wave_dz");
  const std::vector<std::pair<const char*, double>> wanted = {{"intensity", 40000},
                                                              {"return_number", 3},
                                                              {"number_of_returns", 5},
                                                              {"scan_direction", 1},
                                                              {"edge_of_flight_line", 0},
                                                              {"classification", 17},
                                                              {"synthetic", 1},
                                                              {"key_point", 0},
                                                              {"withheld", 1},
                                                              {"scan_angle", -90},
                                                              {"user_data", 9},
                                                              {"point_source_id", 65535},
                                                              {"gps_time", 123456.789},
                                                              {"red", 0xffff},
                                                              {"green", 0x8000},
                                                              {"blue", 0x0100},
                                                              {"wave_descriptor", 2},
                                                              {"wave_offset", 0x1p40},
                                                              {"wave_size", 256},
                                                              {"wave_location", 1.5},
                                                              {"wave_dx", 0.1F},
                                                              {"wave_dy", 0.2F},
                                                              {"wave_dz", 0.3F}};
  for (const auto& [name, value] : wanted) EXPECT_EQ(valueOf(cloud, 0, name), value) << name;
  EXPECT_EQ(colourOf(cloud, 0), 0xff8001U);
}

/// Channels of bytes are told by none that is larger, be it the last of many.
TEST(Las, ColoursOfBytesAreTakenAsTheyAre)
{
  for (const bool wide : {false, true}) {
    LasSample sample(3, 2);
    sample.addPoints(5000);
    for (std::size_t i = 0; i < sample.points.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) put(sample.points[i], 20 + 2 * k, static_cast<std::uint16_t>((i + k) % 256));
    if (wide) put(sample.points.back(), 24, std::uint16_t{0x2000});
    const std::string file = sample.text();
    const pcl::PCLPointCloud2 cloud = readText(file).cloud;
    LasReader reader(std::make_unique<HeldBytes>(file)); // which looks at all before it reads the first
    EXPECT_TRUE(LasBatches(reader, 1000).data == cloud.data);
    const auto rgb =
        std::find_if(cloud.fields.begin(), cloud.fields.end(), [](const Field& f) { return f.name == "rgb"; });
    ASSERT_NE(rgb, cloud.fields.end());
    for (std::size_t i = 0; i < 5000; i += 777)
      for (std::size_t k = 0; k < 3; ++k) {
        const unsigned channel = cloud.data[i * cloud.point_step + rgb->offset + 2 - k];
        EXPECT_EQ(channel, wide ? 0U : (i + k) % 256) << i;
      }
    EXPECT_EQ(cloud.data[4999 * cloud.point_step + rgb->offset], wide ? 0x20 : (4999 + 2) % 256);
  }
}

TEST(Las, FieldsOfNewFormats)
{
  LasSample sample(4, 8);
  std::string point(38, '\0');
  point[14] = static_cast<char>(9 | 15 << 4);
  point[15] = static_cast<char>(1 << 1 | 1 << 3 | 2 << 4 | 1 << 7); // key point, overlap, channel 2, edge
  point[16] = static_cast<char>(200);
  put(point, 18, std::int16_t{-30000});
  put(point, 36, std::uint16_t{777});
  put(point, 30, std::uint16_t{200}); // colours of bytes, as many writers have them
  sample.points = {point};
  const pcl::PCLPointCloud2 cloud = readText(sample.text()).cloud;
  const std::vector<std::pair<const char*, double>> wanted = {{"return_number", 9},
                                                              {"number_of_returns", 15},
                                                              {"synthetic", 0},
                                                              {"key_point", 1},
                                                              {"withheld", 0},
                                                              {"overlap", 1},
                                                              {"scanner_channel", 2},
                                                              {"scan_direction", 0},
                                                              {"edge_of_flight_line", 1},
                                                              {"classification", 200},
                                                              {"scan_angle", -180.0F},
                                                              {"nir", 777},
                                                              {"red", 200}};
  for (const auto& [name, value] : wanted) EXPECT_EQ(valueOf(cloud, 0, name), value) << name;
  EXPECT_EQ(colourOf(cloud, 0), 0xc80000U);
}

TEST(Las, ExtraBytesByTheirDescriptions)
{
  const LasSample sample = fullSample();
  const Las las = readText(sample.text());
  for (std::size_t i = 0; i < sample.points.size(); ++i) {
    const std::string extra = sample.points[i].substr(67);
    EXPECT_EQ(valueOf(las.cloud, i, "echo_width"), get<std::uint16_t>(extra, 4) * 0.1);
    EXPECT_EQ(valueOf(las.cloud, i, "colour"), get<std::uint16_t>(extra, 9) + 5.0);
    const std::uint8_t quality = get<std::uint8_t>(extra, 23);
    const double read = valueOf(las.cloud, i, "quality");
    EXPECT_TRUE(quality == 255 ? std::isnan(read) : read == quality);
  }
  EXPECT_EQ(difference(rewritten(sample.text()), sample.text()), "");
}

/// Coordinates are rounded to the file's steps, other fields not.
TEST(Las, ValuesBetweenTheStepsOfExtraBytesAreKept)
{
  Las las = readText(fullSample().text());
  const auto& fields = las.cloud.fields;
  const auto width = std::find_if(fields.begin(), fields.end(), [](const Field& f) { return f.name == "echo_width"; });
  ASSERT_NE(width, fields.end());
  ASSERT_EQ(width->datatype, Field::FLOAT64);
  for (const double value : {0.2, 0.1234}) {
    std::memcpy(&las.cloud.data[3 * las.cloud.point_step + width->offset], &value, sizeof value);
    const pcl::PCLPointCloud2 again = readText(written(las.cloud, &las.header)).cloud;
    EXPECT_EQ(valueOf(again, 3, "echo_width"), value);
    EXPECT_EQ(valueOf(again, 4, "echo_width"), valueOf(las.cloud, 4, "echo_width"));
  }
}

TEST(Las, EveryTypeOfExtraBytesIsKept)
{
  for (const std::uint8_t options : std::initializer_list<std::uint8_t>{0, 1, 8, 16, 25}) {
    std::string descriptors;
    std::size_t bytes = 0;
    constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    for (std::uint8_t type = 1; type <= 30; ++type) {
      const unsigned kind = (type - 1U) % 10;
      const bool is_float = kind >= 8, wide = kind == 6 || kind == 7;
      if (options > 1 && (is_float || wide)) continue; // scaled, they have more digits than a double
      descriptors += LasSample::descriptor(type, "e" + std::to_string(type), options, 0.01, 1000, 3);
      bytes += sizes[(type - 1U) % 10] * ((type - 1U) / 10 + 1);
    }
    LasSample sample(4, 6, bytes);
    sample.records = {LasSample::record("LASF_Spec", 4, descriptors)};
    sample.addPoints(40);
    if (options != 0) // floats that are numbers
      for (std::string& point : sample.points)
        for (std::size_t at = 30; at < point.size(); ++at) point[at] = static_cast<char>(point[at] & 0x3f);
    EXPECT_EQ(difference(rewritten(sample.text()), sample.text()), "") << int{options};
  }
}

TEST(Las, ExtraBytesWithoutSoundDescriptions)
{
  LasSample sample(2, 1, 5);
  sample.addPoints(3);
  EXPECT_EQ(readText(sample.text()).cloud.fields.back().name, "extra_bytes");
  EXPECT_EQ(readText(sample.text()).cloud.fields.back().count, 5U);
  EXPECT_EQ(difference(rewritten(sample.text()), sample.text()), "");
  // Descriptions of more than there is count for nothing; behind an unknown type no place is known.
  sample.records = {LasSample::record("LASF_Spec", 4, LasSample::descriptor(10, "a"))};
  EXPECT_EQ(readText(sample.text()).cloud.fields.back().name, "extra_bytes");
  sample.records = {LasSample::record("LASF_Spec", 4, LasSample::descriptor(3, "a") + LasSample::descriptor(99, "b"))};
  const pcl::PCLPointCloud2 cloud = readText(sample.text()).cloud;
  EXPECT_EQ(cloud.fields[cloud.fields.size() - 2].name, "a");
  EXPECT_EQ(cloud.fields.back().count, 3U);
  EXPECT_EQ(difference(rewritten(sample.text()), sample.text()), "");
  // Names that are taken, or none.
  sample.records = {
      LasSample::record("LASF_Spec", 4, LasSample::descriptor(3, "intensity") + LasSample::descriptor(3, ""))};
  const std::string names = namesOf(readText(sample.text()).cloud);
  EXPECT_NE(names.find("extra_intensity extra_bytes extra_extra_bytes"), std::string::npos) << names;
  EXPECT_EQ(difference(rewritten(sample.text()), sample.text()), "");
}

TEST(Las, ExtraBytesDescribedBehindThePoints)
{
  LasSample sample(4, 6, 2);
  const std::string other = LasSample::extendedRecord("somebody", 9, "more"), late = LasSample::descriptor(3, "late");
  sample.extended = {other, LasSample::extendedRecord("LASF_Spec", 4, late)};
  sample.addPoints(3);
  const Las las = readText(sample.text());
  EXPECT_EQ(las.cloud.fields.back().name, "late");
  EXPECT_EQ(difference(rewritten(sample.text()), sample.text()), "");
  const Las more = readText(written(withField(las.cloud, "collision", test::verdictsOf({1, 0, 1})), &las.header));
  EXPECT_EQ(namesOf(more.cloud), namesOf(las.cloud) + " collision");
  EXPECT_EQ(valueOf(more.cloud, 2, "late"), valueOf(las.cloud, 2, "late"));
  EXPECT_EQ(difference(more.header.behind_points, other + LasSample::extendedRecord("LASF_Spec", 7, late)), "")
      << "superseded";
}

TEST(Las, ResultsAreExtraBytesWithDescriptions)
{
  for (const bool described : {false, true}) {
    LasSample sample(2, 3, 3);
    if (described) sample.records = {LasSample::record("LASF_Spec", 4, LasSample::descriptor(3, "first"))};
    sample.records.push_back(LasSample::record("Somebody", 4, "something else"));
    sample.records.push_back(LasSample::record("LASF_Projection", 34735, "geo"));
    sample.addPoints(20);
    const Las las = readText(sample.text());
    std::vector<std::uint8_t> flags(20);
    std::vector<float> distances(20, std::nanf(""));
    for (std::size_t i = 0; i < 20; i += 3) flags[i] = 1, distances[i] = 0.1F * static_cast<float>(i);
    const pcl::PCLPointCloud2 cloud = withFields(las.cloud, {{"collision", &flags}, {"distance", &distances}});
    const std::string file = written(cloud, &las.header);
    EXPECT_NE(file.find("1 collides, 2 undecided, 0 free"), std::string::npos);
    EXPECT_NE(file.find("geo"), std::string::npos);
    EXPECT_NE(file.find("something else"), std::string::npos) << "of the same number, but of another user";
    const Las again = readText(file);
    EXPECT_EQ(namesOf(again.cloud), namesOf(cloud));
    for (std::size_t i = 0; i < 20; ++i) {
      EXPECT_EQ(valueOf(again.cloud, i, "collision"), flags[i]);
      const double distance = valueOf(again.cloud, i, "distance");
      EXPECT_TRUE(flags[i] != 0 ? distance == static_cast<double>(distances[i]) : std::isnan(distance));
      EXPECT_EQ(file.substr(again.header.block.points_at + i * again.header.block.record_length, 34),
                sample.points[i].substr(0, 34))
          << "the point itself is as it was";
    }
    EXPECT_EQ(difference(rewritten(file), file), "");
    // Taken away again, the file is as before, except for a description of fields that had none.
    if (described) continue;
    const Las less = readText(written(las.cloud, &again.header));
    EXPECT_EQ(less.header.block.record_length, 37);
  }
}

TEST(Las, FewerPointsKeepEverythingElse)
{
  const LasSample sample = fullSample();
  const Las las = readText(sample.text());
  const std::string file = written(selectedRecords(las.cloud, {7, 3, 40}), &las.header);
  LasSample fewer = sample;
  fewer.points = {sample.points[7], sample.points[3], sample.points[40]};
  EXPECT_EQ(difference(file, fewer.text()), "") << "counts, bounds and places are those of the points left";
  fewer.points.clear();
  const std::string none = written(selectedRecords(las.cloud, {}), &las.header);
  EXPECT_EQ(difference(none, fewer.text()), "");
}

TEST(Las, MovedPointsGetAPlace)
{
  LasSample sample(2, 0);
  sample.addPoints(10);
  const Las las = readText(sample.text());
  for (const double by : {0.004, 1e9, 1e15}) {
    pcl::PCLPointCloud2 moved = las.cloud;
    for (std::size_t i = 0; i < 10; ++i) {
      const double x = valueOf(las.cloud, i, "x") + by;
      std::memcpy(&moved.data[i * moved.point_step], &x, sizeof x);
    }
    const Las again = readText(written(moved, &las.header));
    for (std::size_t i = 0; i < 10; ++i) {
      const double near = std::max(0.00501, 1e-15 * by);
      EXPECT_NEAR(valueOf(again.cloud, i, "x"), valueOf(moved, i, "x"), near) << by;
      if (by < 1e15) {
        EXPECT_EQ(valueOf(again.cloud, i, "y"), valueOf(moved, i, "y"));
      }
    }
  }
}

TEST(Las, OtherTypesTakeThePlaceOfAFieldUpToItsEnds)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, Field::FLOAT32);
  addField(cloud, "intensity", Field::FLOAT32);
  allocate(cloud, 2, 1);
  for (const auto& [greatest, name] : {std::pair(65535.0F, "intensity"), {65536.0F, "extra_intensity"}}) {
    std::memcpy(&cloud.data[cloud.point_step + 12], &greatest, sizeof greatest);
    const pcl::PCLPointCloud2 read = readText(written(cloud, nullptr)).cloud;
    EXPECT_EQ(valueOf(read, 0, name), 0.0);
    EXPECT_EQ(valueOf(read, 1, name), greatest);
    EXPECT_EQ(namesOf(read).find("extra_intensity") == std::string::npos, greatest == 65535.0F);
  }
}

TEST(Las, CloudsOfOtherFormats)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, Field::FLOAT32);
  addField(cloud, "intensity", Field::FLOAT32);
  addField(cloud, "rgb", Field::FLOAT32);
  addField(cloud, "normal_x", Field::FLOAT32);
  addField(cloud, "histogram", Field::UINT16, 2);
  allocate(cloud, 3, 1);
  std::mt19937 random(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<float, 4> values = {float(i) * 17.25F, -3.5F, 1000, i == 1 ? -12.5F : 7.0F};
    std::memcpy(&cloud.data[i * cloud.point_step], values.data(), sizeof values);
    const std::uint32_t colour = 0x123456 * static_cast<std::uint32_t>(i);
    std::memcpy(&cloud.data[i * cloud.point_step + 16], &colour, sizeof colour);
    cloud.data[i * cloud.point_step + 24] = static_cast<std::uint8_t>(i);
  }
  const std::string file = written(cloud, nullptr);
  const Las las = readText(file);
  EXPECT_EQ(las.header.block.minor, 4);
  EXPECT_EQ(las.header.block.format, 7);
  EXPECT_EQ(get<std::uint32_t>(file, 107), 0U) << "formats 6 to 10 have no old counts";
  EXPECT_EQ(get<std::uint64_t>(file, 247), 3U);
  EXPECT_EQ(get<std::uint64_t>(file, 255), 3U) << "one return each";
  EXPECT_EQ(get<double>(file, 179), 34.5);
  EXPECT_EQ(get<double>(file, 187), 0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(valueOf(las.cloud, i, "x"), valueOf(cloud, i, "x"));
    EXPECT_EQ(valueOf(las.cloud, i, "extra_intensity"), valueOf(cloud, i, "intensity")) << "it has no place in 16 bits";
    EXPECT_EQ(colourOf(las.cloud, i), 0x123456 * i);
    EXPECT_EQ(valueOf(las.cloud, i, "histogram[0]"), static_cast<double>(i));
    EXPECT_EQ(valueOf(las.cloud, i, "number_of_returns"), 1);
  }
}

TEST(Las, PointsWithoutCoordinatesAreLeftOut)
{
  pcl::PCLPointCloud2 cloud = randomCloud<double>(5000, 2, {Field::UINT8});
  for (const std::size_t i : {0U, 4095U, 9999U}) {
    const double nan = std::nan("");
    std::memcpy(&cloud.data[i * cloud.point_step + 8], &nan, sizeof nan);
  }
  const Las las = readText(written(cloud, nullptr));
  EXPECT_EQ(las.cloud.width, 9997U);
  EXPECT_EQ(valueOf(las.cloud, 0, "field_2"), valueOf(cloud, 1, "field_2"));
  EXPECT_NEAR(valueOf(las.cloud, 0, "x"), valueOf(cloud, 1, "x"), 2e6 / 0x1p30);
}

TEST(Las, StreamsInBatches)
{
  LasSample sample(4, 3);
  sample.addPoints(1000);
  const std::string file = sample.text();
  const pcl::PCLPointCloud2 whole = readText(file).cloud;
  LasReader reader(std::make_unique<HeldBytes>(file));
  EXPECT_EQ(reader.size(), 1000U);
  const LasBatches read(reader, 300);
  EXPECT_EQ(read.points, (std::vector<std::size_t>{300, 300, 300, 100}));
  EXPECT_TRUE(read.data == whole.data);
}

TEST(Las, HeadersThatLie)
{
  LasSample sample(4, 6);
  sample.records = {LasSample::record("a", 1, "content")};
  sample.extended = {LasSample::extendedRecord("b", 2, "more")};
  sample.addPoints(4);
  const std::string sound = sample.text();
  const auto broken = [&](std::size_t at, auto value) {
    std::string file = sound;
    put(file, at, value);
    return defectOf([&] { readText(file); });
  };
  EXPECT_THAT(broken(0, 'X'), testing::HasSubstr("LASF"));
  EXPECT_THAT(broken(25, char{5}), testing::HasSubstr("1.5"));
  EXPECT_THAT(broken(94, std::uint16_t{200}), testing::HasSubstr("200"));
  EXPECT_THAT(broken(96, std::uint32_t{0xffffffff}), testing::HasSubstr("4294967295"));
  EXPECT_THAT(broken(96, std::uint32_t{3}), testing::HasSubstr("byte 3"));
  EXPECT_THAT(broken(104, char{11}), testing::HasSubstr("11"));
  EXPECT_THAT(broken(104, static_cast<char>(0x86)), testing::HasSubstr("compressed"));
  EXPECT_THAT(broken(105, std::uint16_t{29}), testing::HasSubstr("29"));
  EXPECT_THAT(broken(105, std::uint16_t{0}), testing::HasSubstr("0 bytes"));
  EXPECT_THAT(broken(105, std::uint16_t{65535}), testing::HasSubstr("truncated"));
  EXPECT_THAT(broken(247, ~std::uint64_t{0}), testing::HasSubstr("18446744073709551615"));
  EXPECT_THAT(broken(247, std::uint64_t{1} << 61), testing::HasSubstr("truncated"));
  EXPECT_THAT(broken(107, std::uint32_t{3}), testing::HasSubstr("disagree"));
  for (const double bad : {0.0, -0.0, std::nan(""), HUGE_VAL, 1e308}) {
    EXPECT_THAT(broken(139, bad), testing::HasSubstr("y"));
  }
  EXPECT_THAT(broken(163, std::nan("")), testing::HasSubstr("y"));
  EXPECT_THAT(broken(235, std::uint64_t{10}), testing::HasSubstr("byte 10"));
  EXPECT_THAT(broken(235, ~std::uint64_t{0}), testing::HasSubstr("truncated"));
  EXPECT_THAT(broken(243, std::uint32_t{0xffffffff}), testing::HasSubstr("truncated"));
  EXPECT_THAT(broken(sound.size() - 44, ~std::uint64_t{0}), testing::HasSubstr("truncated")) << "its length";

  // The header's count of records may be wrong: the points are where they are.
  std::string file = sound;
  put(file, 100, std::uint32_t{0xffffffff});
  EXPECT_EQ(readText(file).cloud.width, 4U);
  EXPECT_EQ(difference(rewritten(file), sound), "") << "with the count that is right";
  put(file, 375 + 20, std::uint16_t{65535});
  EXPECT_EQ(readText(file).cloud.width, 4U);
}

TEST(Las, CutAnywhere)
{
  const std::string sound = fullSample().text();
  for (std::size_t size = 0; size < sound.size(); ++size) {
    const std::string file = sound.substr(0, size);
    EXPECT_NE(defectOf([&] { readText(file); }), "") << size;
  }
  LasSample without(3, 4);
  without.addPoints(2);
  without.global_encoding = 2;
  without.extended = {LasSample::extendedRecord("LASF_Spec", 65535, "waves")};
  const std::string waves = without.text();
  EXPECT_EQ(difference(rewritten(waves), waves), "");
  for (std::size_t size = 0; size < waves.size(); ++size) {
    EXPECT_NE(defectOf([&] { readText(waves.substr(0, size)); }), "") << size;
  }
}

TEST(Las, WaveformBitWithoutWaveforms)
{
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{1, 4, 6}) {
    LasSample sample(format == 6 ? 4 : 3, format);
    sample.addPoints(2);
    std::string file = sample.text();
    put(file, 6, std::uint16_t{2}); // inside this file, at byte 0
    EXPECT_EQ(difference(rewritten(file), file), "");
    if (format == 4) continue;
    put(file, 227, std::uint64_t{1} << 50); // no point asks for them
    EXPECT_EQ(readText(file).cloud.width, 2U);
  }
}

TEST(Las, NoScaleForExtraBytes)
{
  for (const double bad : {0.0, std::nan(""), HUGE_VAL}) {
    LasSample sample(4, 6, 2);
    sample.records = {LasSample::record("LASF_Spec", 4, LasSample::descriptor(3, "width", 8, bad))};
    sample.addPoints(1);
    EXPECT_THAT(defectOf([&] { readText(sample.text()); }), testing::HasSubstr("width"));
  }
}

TEST(Las, AsManyFieldsAsARecordHasBytes)
{
  constexpr std::size_t many = 65535 - 30;
  LasSample sample(4, 6, many);
  std::string descriptors;
  for (std::size_t i = 0; i < many; ++i) descriptors += LasSample::descriptor(1, "same");
  sample.extended = {LasSample::extendedRecord("LASF_Spec", 4, descriptors)};
  sample.addPoints(1);
  const Las las = readText(sample.text());
  EXPECT_EQ(las.cloud.fields.back().name, "extra_same_65504");
  EXPECT_EQ(difference(written(las.cloud, &las.header), sample.text()), "");
}

TEST(Las, FilesKeepTheirHeaders)
{
  const TemporaryFolder folder;
  const std::string sound = fullSample().text();
  CloudFacts facts;
  const pcl::PCLPointCloud2 cloud = readCloud(folder.write("a.las", sound), &facts);
  writeCloud(folder / "b.las", cloud, no_viewpoint, facts.las);
  EXPECT_EQ(difference(contentOf(folder / "b.las"), sound), "");
  EXPECT_EQ(readCloudHeader(folder / "a.las").width, 50U);
  readCloud(folder.write("a.xyz", "1 2 3\n"), &facts);
  EXPECT_EQ(facts.las, nullptr);
}

/// Real files of many programs.
TEST(Las, RealFiles)
{
  namespace fs = std::filesystem;
  const fs::path samples = fs::path(PCL_BSH_SHARED_DIR) / "data/formats";
  if (!fs::exists(samples)) GTEST_SKIP() << "no " << samples;
  const std::vector<std::pair<const char*, std::size_t>> points = {{"1.0_0.las", 1},
                                                                   {"1.0_1.las", 1},
                                                                   {"1.1_1.las", 1},
                                                                   {"1.2-with-color.las", 1065},
                                                                   {"1.2_2.las", 1},
                                                                   {"1.2_3.las", 1},
                                                                   {"autzen_trim_7.las", 110000},
                                                                   {"extrabytes.las", 1065},
                                                                   {"interesting.las", 1065},
                                                                   {"no-points.las", 0},
                                                                   {"prec3.las", 110},
                                                                   {"simple.las", 1065},
                                                                   {"spec_3.las", 10},
                                                                   {"test1_4.las", 1000},
                                                                   {"utm15.las", 1}};
  for (const auto& [name, count] : points) {
    const std::string file = contentOf(samples / name);
    const Las las = readText(file);
    EXPECT_EQ(las.cloud.width, count) << name;
    const std::string again = written(las.cloud, &las.header);
    EXPECT_EQ(difference(again.substr(las.header.block.points_at), file.substr(las.header.block.points_at)), "")
        << name;
    EXPECT_EQ(difference(again, file), "") << name;
    if (count == 1) {
      EXPECT_DOUBLE_EQ(valueOf(las.cloud, 0, "x"), 470692.44) << name;
    }
  }
  EXPECT_THAT(defectOf([&] { readText(contentOf(samples / "garbage_nVariableLength.las")); }),
              testing::HasSubstr("truncated"));
  EXPECT_EQ(readText(contentOf(samples / "gps-time-nan.las")).cloud.width, 1U);
  EXPECT_EQ(readText(contentOf(samples / "bad_vlr_count.las")).cloud.width, 10U);
}

TEST(Las, NamesOfExtraBytesAreFreeAndPlain)
{
  const auto namesFrom = [](const std::vector<std::string>& given) {
    LasSample sample(4, 6, given.size());
    std::string descriptors;
    for (const std::string& name : given) descriptors += LasSample::descriptor(1, name);
    sample.records = {LasSample::record("LASF_Spec", 4, descriptors)};
    sample.addPoints(1);
    const std::string names = namesOf(readText(sample.text()).cloud), last = "point_source_id gps_time ";
    return names.substr(names.find(last) + last.size());
  };
  EXPECT_EQ(namesFrom({"a\x7f~ b!", "_"}), "a_~_b! extra__");
  EXPECT_EQ(namesFrom({"extra_a_2", "a", "a", "a", "a"}), "extra_a_2 a extra_a extra_a_3 extra_a_4");
  EXPECT_EQ(namesFrom({"extra_a", "a", "a"}), "extra_a a extra_a_2");
}

/// Records of the specification that describe something else, or bytes that are none.
TEST(Las, OnlyExtraBytesAreDescribed)
{
  LasSample sample(4, 6, 2);
  sample.records = {
      LasSample::record("LASF_Spec", 0, std::string(16, 'c')),
      LasSample::record("LASF_Spec", 4, LasSample::descriptor(0, "nothing") + LasSample::descriptor(3, "a"))};
  sample.addPoints(2);
  const Las las = readText(sample.text());
  EXPECT_EQ(las.cloud.fields.back().name, "a");
  EXPECT_FALSE(hasField(las.cloud, "nothing"));
  const std::string more = written(withField(las.cloud, "collision", test::verdictsOf({1, 0})), &las.header);
  EXPECT_NE(more.find(std::string(16, 'c')), std::string::npos);
  EXPECT_EQ(namesOf(readText(more).cloud), namesOf(las.cloud) + " collision");
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    sample.records = {LasSample::record("LASF_Spec", 4, LasSample::descriptor(3, "width", 16, 1, bad))};
    EXPECT_THAT(defectOf([&] { readText(sample.text()); }),
                testing::HasSubstr("its extra bytes 'width' are scaled by"));
  }
}

/// A value beyond the type of the file's field gives the field another type; other values do not.
TEST(Las, ValuesOfExtraBytesAreNeverChanged)
{
  const double nan = std::nan("");
  EXPECT_TRUE(std::isnan(keptValue(3, LasSample::descriptor(3, "e", 8, 0.5), 2, nan))) << "no value of it is none";
  EXPECT_TRUE(std::isnan(keptValue(3, LasSample::descriptor(3, "e", 9, 0.5, 0, 77), 2, nan))) << "one is";
  EXPECT_TRUE(std::isnan(keptValue(1, LasSample::descriptor(1, "e", 1, 0, 0, 300), 1, nan))) << "none of a byte is";
  EXPECT_TRUE(std::isnan(keptValue(9, LasSample::descriptor(9, "e", 8, 0.5), 4, nan))) << "floats have one";
  EXPECT_EQ(keptValue(1, LasSample::descriptor(1, "e", 1, 0, 0, 255), 1, 255), 255) << "which would be none";
  EXPECT_EQ(keptValue(1, LasSample::descriptor(1, "e", 1, 0, 0, 255), 1, 254), 254);
  EXPECT_EQ(keptValue(1, LasSample::descriptor(1, "e", 8, 2), 1, 510), 510);
  EXPECT_EQ(keptValue(1, LasSample::descriptor(1, "e", 8, 2), 1, 512), 512) << "beyond the range";
  EXPECT_EQ(keptValue(1, LasSample::descriptor(1, "e", 8, 2), 1, -2), -2);
  EXPECT_EQ(keptValue(1, LasSample::descriptor(1, "e", 8, 2), 1, 3), 3) << "between two";
  // 255 stands for none, and 254 for the same double.
  EXPECT_EQ(keptValue(1, LasSample::descriptor(1, "e", 25, 256.0 / 255, 0x1p60, 255), 1, 0x1p60 + 256), 0x1p60 + 256);
}

/// As doubles they are beyond their types.
TEST(Las, TheEndsOfLongIntegersStay)
{
  LasSample sample(4, 6, 16);
  sample.records = {
      LasSample::record("LASF_Spec", 4, LasSample::descriptor(7, "u", 8, 1) + LasSample::descriptor(8, "i", 8, 1))};
  sample.points.assign(2, std::string(sample.length(), '\0'));
  put(sample.points[0], 30, ~std::uint64_t{0});
  put(sample.points[0], 38, std::numeric_limits<std::int64_t>::max());
  put(sample.points[1], 38, std::numeric_limits<std::int64_t>::lowest());
  EXPECT_EQ(difference(rewritten(sample.text()), sample.text()), "");
  Las las = readText(sample.text());
  setValue(las.cloud, 1, "i", -0x1p64);
  EXPECT_EQ(valueOf(readText(written(las.cloud, &las.header)).cloud, 1, "i"), -0x1p64);
}

/// A field of the format is taken where each of its values fits, in whichever batch that is.
TEST(Las, ValuesThatDoNotFitAFieldGetOneOfTheirOwn)
{
  for (const auto& [name, wrong, right] : {std::tuple{"intensity", 0.5F, 3.0F},
                                           {"intensity", -1.0F, 0.0F},
                                           {"return_number", 16.0F, 15.0F},
                                           {"return_number", 0.5F, 1.0F},
                                           {"return_number", 300.0F, 0.0F},
                                           {"edge_of_flight_line", 2.0F, 1.0F}}) {
    for (const std::size_t at : {0U, 4999U})
      for (const bool fits : {false, true}) {
        pcl::PCLPointCloud2 cloud = cloudOf({{name, Field::FLOAT32}}, 5000);
        setValue(cloud, at, name, fits ? right : wrong);
        const pcl::PCLPointCloud2 read = readText(written(cloud, nullptr)).cloud;
        const std::string extra = std::string("extra_") + name;
        EXPECT_EQ(hasField(read, extra), !fits) << name << ' ' << wrong << ' ' << at;
        EXPECT_EQ(valueOf(read, at, fits ? name : extra), fits ? right : wrong);
      }
  }
  pcl::PCLPointCloud2 list = cloudOf({});
  addField(list, "intensity", Field::UINT16, 2);
  allocate(list, 1);
  EXPECT_TRUE(hasField(readText(written(list, nullptr)).cloud, "intensity[1]"));
}

/// The least format that has what the points have, and all that the file had.
TEST(Las, FormatsGrowByWhatIsNew)
{
  const std::vector<std::pair<std::string, std::uint8_t>> time = {{"gps_time", Field::FLOAT64}},
                                                          colour = {{"red", Field::UINT16},
                                                                    {"green", Field::UINT16},
                                                                    {"blue", Field::UINT16}},
                                                          infrared = {{"nir", Field::UINT16}};
  const auto formatOf = [](std::uint8_t minor, std::uint8_t format, auto fields) {
    LasSample sample(minor, format);
    sample.addPoints(1);
    const Las las = readText(sample.text());
    const Las again = readText(written(cloudOf(fields), &las.header));
    for (const auto& [name, type] : fields) EXPECT_EQ(hasField(again.cloud, "extra_" + name), false) << name;
    EXPECT_EQ(again.header.block.minor, std::max<int>(minor, again.header.block.format >= 2 ? 2 : 0)) << int{format};
    return int{again.header.block.format};
  };
  EXPECT_EQ(formatOf(2, 0, time), 1);
  EXPECT_EQ(formatOf(1, 0, colour), 2);
  EXPECT_EQ(formatOf(1, 1, colour), 3);
  EXPECT_EQ(formatOf(2, 2, time), 3);
  EXPECT_EQ(formatOf(3, 4, colour), 5);
  EXPECT_EQ(formatOf(3, 4, time), 4) << "has it";
  EXPECT_EQ(formatOf(4, 6, colour), 7);
  EXPECT_EQ(formatOf(4, 6, infrared), 8);
  EXPECT_EQ(formatOf(4, 7, infrared), 8);
  EXPECT_EQ(formatOf(4, 9, colour), 10);
  EXPECT_EQ(formatOf(4, 9, infrared), 10);
  EXPECT_EQ(formatOf(4, 8, colour), 8);
}

/// Three make one; each of these has two.
TEST(Las, ChannelsAreThree)
{
  for (const std::string left_out : {"red", "green", "blue"}) {
    std::vector<std::pair<std::string, std::uint8_t>> two;
    for (const char* channel : {"red", "green", "blue"})
      if (channel != left_out) two.emplace_back(channel, Field::UINT16);
    const Las las = readText(written(cloudOf(two), nullptr));
    EXPECT_EQ(las.header.block.format, 6) << left_out;
    for (const auto& [name, type] : two) EXPECT_TRUE(hasField(las.cloud, name)) << name;
  }
  // Channels that do not fit leave the packed colour as it is; a field `rgb` of another type stays, too.
  const std::vector<std::pair<std::string, std::uint8_t>> channels = {
      {"red", Field::FLOAT32}, {"green", Field::FLOAT32}, {"blue", Field::FLOAT32}};
  auto fields = channels;
  fields.emplace_back("rgb", Field::FLOAT32);
  pcl::PCLPointCloud2 cloud = cloudOf(fields);
  for (const auto& [name, type] : channels) setValue(cloud, 0, name, 0.5F);
  setValue(cloud, 0, "rgb", 7.0F);
  EXPECT_EQ(valueOf(readText(written(cloud, nullptr)).cloud, 0, "extra_rgb"), 7.0);
  fields.back().second = Field::FLOAT64;
  cloud = cloudOf(fields);
  setValue(cloud, 0, "rgb", 7.0);
  EXPECT_EQ(valueOf(readText(written(cloud, nullptr)).cloud, 0, "extra_rgb"), 7.0);
}

TEST(Las, RefusesWhatPointsOfLasCannotBe)
{
  const auto refusalOf = [](const pcl::PCLPointCloud2& cloud) { return defectOf([&] { written(cloud, nullptr); }); };
  const std::string no_axes = "the cloud has not one each of x, y and z";
  for (std::size_t k = 0; k < 3; ++k) {
    pcl::PCLPointCloud2 cloud = cloudOf({});
    cloud.fields[k].name = "w";
    EXPECT_EQ(refusalOf(cloud), no_axes);
    cloud.fields[k].name = k == 0 ? "y" : "x";
    EXPECT_EQ(refusalOf(cloud), no_axes) << "two of one name";
    cloud = cloudOf({});
    cloud.fields[k].datatype = Field::INT32;
    EXPECT_EQ(refusalOf(cloud), no_axes);
    cloud.fields[k].datatype = Field::FLOAT32;
    EXPECT_NO_THROW(written(cloud, nullptr));
    cloud.fields[k].count = 2;
    EXPECT_EQ(refusalOf(cloud), no_axes);
  }
  EXPECT_NO_THROW(written(cloudOf({{std::string(32, 'n'), Field::UINT8}}), nullptr));
  EXPECT_EQ(refusalOf(cloudOf({{std::string(33, 'n'), Field::UINT8}})),
            "the name of field '" + std::string(33, 'n') + "' is longer than the 32 letters of LAS");
  const auto listed = [](std::uint32_t count) {
    pcl::PCLPointCloud2 cloud;
    for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, Field::FLOAT64);
    addField(cloud, "list", Field::FLOAT64, count);
    allocate(cloud, 1);
    return cloud;
  };
  EXPECT_EQ(readText(written(listed(341), nullptr)).header.block.record_length, 30 + 341 * 8);
  EXPECT_EQ(refusalOf(listed(342)), "the points have more than 341 extra fields");
  EXPECT_EQ(refusalOf(listed(8189)), "a point takes more than 65535 bytes") << "30 and 65512";
  EXPECT_EQ(refusalOf(listed(8188)), "the points have more than 341 extra fields");
}

TEST(Las, ABoolIsAByte)
{
  pcl::PCLPointCloud2 cloud = cloudOf({{"seen", Field::BOOL}});
  setValue(cloud, 1, "seen", std::uint8_t{1});
  const pcl::PCLPointCloud2 read = readText(written(cloud, nullptr)).cloud;
  EXPECT_EQ(read.fields.back().datatype, Field::UINT8);
  EXPECT_EQ(valueOf(read, 0, "seen"), 0);
  EXPECT_EQ(valueOf(read, 1, "seen"), 1);
}

/// Taken away, extra bytes leave no description behind; new ones of LAS 1.0 have its signature.
TEST(Las, DescriptionsComeAndGo)
{
  LasSample sample(2, 0, 2);
  sample.records = {LasSample::record("LASF_Spec", 4, LasSample::descriptor(3, "a")),
                    LasSample::record("somebody", 4, "else")};
  sample.addPoints(2);
  const Las las = readText(sample.text());
  LasSample without = sample;
  without.extra_bytes = 0;
  without.records.erase(without.records.begin());
  for (std::string& point : without.points) point.resize(20);
  pcl::PCLPointCloud2 less = las.cloud;
  less.fields.pop_back();
  EXPECT_EQ(difference(written(less, &las.header), without.text()), "");

  for (const std::uint8_t minor : {std::uint8_t{0}, std::uint8_t{1}}) {
    LasSample old(minor, 0);
    old.padding = "\xcc\xdd";
    old.addPoints(2);
    const Las read = readText(old.text());
    const std::string file = written(withField(read.cloud, "collision", test::verdictsOf({1, 0})), &read.header);
    EXPECT_EQ(get<std::uint16_t>(file, 227), minor == 0 ? 0xaabb : 0);
    EXPECT_EQ(valueOf(readText(file).cloud, 0, "collision"), 1);
  }
}

/// A file without points has no counts to go by.
TEST(Las, CountsForOldReaders)
{
  for (const std::uint8_t format : {std::uint8_t{1}, std::uint8_t{6}}) {
    const LasSample none(4, format);
    const Las las = readText(none.text());
    const std::string file = written(cloudOf({}, 3), &las.header);
    EXPECT_EQ(get<std::uint32_t>(file, 107), format == 1 ? 3U : 0U);
    EXPECT_EQ(get<std::uint64_t>(file, 247), 3U);
    EXPECT_EQ(get<std::uint32_t>(file, 111), format == 1 ? 3U : 0U) << "one return each";
  }
}

/// Where nothing is behind the points, a place is left what it is.
TEST(Las, PlacesBeforeTheEndOfThePointsStay)
{
  LasSample sample(3, 1);
  sample.addPoints(5);
  std::string file = sample.text();
  const std::uint64_t end = file.size();
  for (const auto& [place, moved] :
       {std::pair<std::uint64_t, std::uint64_t>{5, 5}, {end - 1, end - 1}, {end, end - 28}, {end + 9, end - 19}}) {
    put(file, 227, place);
    const Las las = readText(file);
    const std::string fewer = written(selectedRecords(las.cloud, {0, 1, 2, 3}), &las.header);
    EXPECT_EQ(get<std::uint64_t>(fewer, 227), moved) << place - end;
  }
}

TEST(Las, WaveformsOfPointsAreInTheFile)
{
  LasSample sample(3, 4);
  sample.addPoints(2);
  sample.global_encoding = 2;
  const std::string sound = sample.text() + LasSample::extendedRecord("LASF_Spec", 65535, "waves");
  EXPECT_EQ(readText(sound).cloud.width, 2U);
  for (const std::uint64_t place :
       {std::uint64_t{10}, std::uint64_t{234}, std::uint64_t{sound.size() - 59}, std::uint64_t{1} << 50}) {
    std::string file = sound;
    put(file, 227, place);
    EXPECT_EQ(defectOf([&] { readText(file); }),
              "is truncated: its waveforms, from byte " + std::to_string(place) + " on, are not all there");
  }
}

TEST(Las, HeadersAreToldToTheByte)
{
  for (const auto& [minor, bytes] : {std::pair<std::uint8_t, std::size_t>{2, 227}, {4, 375}}) {
    LasSample sample(minor, 1);
    sample.addPoints(1);
    const std::string cut = sample.text().substr(0, bytes - 1);
    EXPECT_EQ(defectOf([&] { readText(cut); }), "is truncated: " + std::to_string(bytes - 1) + " of the " +
                                                    std::to_string(bytes) + " bytes of its header are there");
    const std::string none = LasSample(minor, 1).text();
    ASSERT_EQ(none.size(), bytes);
    EXPECT_EQ(readText(none).cloud.width, 0U);
    std::string nowhere = sample.text();
    put(nowhere, 163, std::nan(""));
    EXPECT_EQ(defectOf([&] { readText(nowhere); }), "its header moves y by no number");
  }
}

TEST(Las, PointsWithoutAnExtentHaveAUsualScale)
{
  EXPECT_EQ(readText(written(cloudOf({}, 0), nullptr)).header.block.scale[1], 0.001);
  EXPECT_EQ(readText(written(cloudOf({}, 3), nullptr)).header.block.scale[1], 1e-6);
}

} // namespace pcl_bsh::io
