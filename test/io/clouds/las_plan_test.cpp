// SPDX-License-Identifier: BSD-3-Clause
#include "las_sample.h"
#include "samples.h"

#include <pcl_bsh/io/clouds/las/las.h>

#include <sstream>

namespace pcl_bsh::io {
namespace {

/// The header of a file with these scales and offsets, in which doubles compute exactly.
LasHeader headerOf(double scale, double offset)
{
  LasSample sample(2, 0);
  sample.scale.fill(scale);
  sample.offset.fill(offset);
  sample.addPoints(1);
  return LasReader(std::make_unique<HeldBytes>(sample.text())).lasHeader();
}

pcl::PCLPointCloud2 alongX(const std::vector<double>& places)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, Field::FLOAT64);
  allocate(cloud, static_cast<std::uint32_t>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    std::memcpy(&cloud.data[i * cloud.point_step], &places[i], sizeof(double));
  return cloud;
}

/// Writes points and compares what is read; the scale must stay, and the offset lie on the grid of the first one.
void expectExact(const LasHeader& header, const std::vector<double>& places)
{
  std::ostringstream out;
  writeLas(out, alongX(places), &header);
  const std::string file = out.str();
  LasReader reader(std::make_unique<HeldBytes>(file));
  const pcl::PCLPointCloud2 read = reader.readAll();
  ASSERT_EQ(read.width, places.size());
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(valueOf(read, i, "x"), places[i]) << i;
  EXPECT_EQ(reader.block().scale, header.block.scale);
  const double steps = (reader.block().offset[0] - header.block.offset[0]) / header.block.scale[0];
  EXPECT_EQ(steps, std::nearbyint(steps));
}

constexpr double scale = 0.25, whole_range = 0x1p32 * scale; ///< of 32 bits

TEST(LasPlan, OneEndAloneLeaves32Bits)
{
  const LasHeader header = headerOf(scale, 0);
  const double lowest = -whole_range / 2, greatest = whole_range / 2 - scale;
  for (const double by : {0.0, scale, 1000 * scale}) {
    expectExact(header, {0, greatest + by});
    expectExact(header, {lowest - by, 0});
    expectExact(header, {lowest + by, greatest + by});
    expectExact(header, {lowest - by, greatest - by});
  }
}

TEST(LasPlan, TheNewOffsetStaysOnTheGrid)
{
  const LasHeader header = headerOf(scale, 100 + scale / 2);
  for (const double far : {100 * whole_range + scale / 2, -100 * whole_range + scale / 2}) {
    expectExact(header, {far, far + scale}); // whose middle is on no grid
    expectExact(header, {far, far + 2 * scale});
    expectExact(header, {far + 3 * scale});
  }
}

/// Doubles that stand for no other stored number stay, though a division takes them beyond the range.
TEST(LasPlan, TheEndOfTheRangeIsInIt)
{
  const LasHeader header = headerOf(0x1p-60, 1);
  expectExact(header, {1 + 0x1p-29});
  expectExact(header, {1 - 0x1p-29, 1 + 0x1p-29});
}

TEST(LasPlan, PointsTooFarApartForTheirScaleGetAnother)
{
  const LasHeader header = headerOf(scale, 0);
  const std::vector<double> places = {0, 4 * whole_range, 8 * whole_range};
  std::ostringstream out;
  writeLas(out, alongX(places), &header);
  const std::string file = out.str();
  LasReader reader(std::make_unique<HeldBytes>(file));
  const pcl::PCLPointCloud2 read = reader.readAll();
  EXPECT_EQ(reader.block().scale[0], 10) << "the least power of ten";
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(valueOf(read, i, "x"), places[i], 5) << i;
}

/// Which readers refuse: all integers must have a place that is a number.
TEST(LasPlan, PointsAsFarApartAsNumbersAreRefused)
{
  std::ostringstream out;
  EXPECT_EQ(defectOf([&] {
              writeLas(out, alongX({-1.7e308, 0, 1.7e308}), nullptr);
            }),
            "its coordinates x are too far apart for LAS");
  EXPECT_EQ(defectOf([&] {
              writeLas(out, alongX({1.7e308, 1.6e308}), nullptr);
            }),
            "its coordinates x are too far apart for LAS");
  const std::vector<double> places = {-1e307, 0, 1e307};
  std::ostringstream nearer;
  writeLas(nearer, alongX(places), nullptr);
  const std::string file = nearer.str();
  LasReader reader(std::make_unique<HeldBytes>(file));
  const pcl::PCLPointCloud2 read = reader.readAll();
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_NEAR(valueOf(read, i, "x"), places[i], 1e298) << i;
}

} // namespace
} // namespace pcl_bsh::io
