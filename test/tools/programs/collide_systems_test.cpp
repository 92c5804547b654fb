// SPDX-License-Identifier: BSD-3-Clause
// A scan and a machine in two coordinate systems.
#include "io/clouds/coordinate_samples.h"
#include "io/clouds/las_sample.h"
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

/// One place, 12 degrees east and 50 north, in two zones: a point of each file.
class CollideSystems : public testing::Test {
protected:
  void SetUp() override
  {
    if (!io::hasProj()) GTEST_SKIP() << "install libproj-dev";
    write("zone32.las", io::utmOf(12, 50, 9, 298.257222101), 25832);
    write("zone33.las", io::utmOf(12, 50, 15, 298.257222101), 25833);
    folder.write("machine.xyz", "0 0 0\n");
  }

  void write(const std::string& name, const std::array<double, 2>& place, int code) const
  {
    io::LasSample sample(4, 6);
    sample.scale = {1e-4, 1e-4, 1e-4};
    sample.offset = {std::round(place[0]), std::round(place[1]), 100};
    std::string point(sample.length(), '\0');
    for (std::size_t k = 0; k < 2; ++k)
      io::put(point, 4 * k, static_cast<std::int32_t>(std::lround((place[k] - sample.offset[k]) * 1e4)));
    sample.points = {point};
    std::string keys(8, '\0');
    io::put(keys, 0, std::uint16_t{1});
    io::put(keys, 6, std::uint16_t{2});
    for (const int number : {3072, 0, 1, code, 3076, 0, 1, 9001})
      io::put(keys, keys.size(), static_cast<std::uint16_t>(number));
    sample.records = {io::LasSample::record("LASF_Projection", 34735, keys)};
    folder.write(name, sample.text());
  }

  Outcome collide(const std::string& arguments) const
  {
    return run("pcl_bsh_collide", arguments + " --clearance 0.01 --report report.json", folder.path());
  }

  /// The one line of what was refused.
  std::string refused(const std::string& arguments, int exit_code = 1) const
  {
    const Outcome outcome = collide(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.las")) << arguments;
    return outcome.err;
  }

  nlohmann::json done(const std::string& arguments) const
  {
    const Outcome outcome = collide(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << '\n' << outcome.err;
    return nlohmann::json::parse(io::contentOf(folder / "report.json"));
  }

  io::TemporaryFolder folder;
};

TEST_F(CollideSystems, DifferentOnesAreRefused)
{
  const std::string line = refused("zone32.las zone33.las out.las");
  for (const char* told : {"zone33.las: is in 'EPSG:25833', and zone32.las in 'EPSG:25832': ", "--to-crs EPSG:25832"})
    EXPECT_THAT(line, HasSubstr(told));
  EXPECT_EQ(done("zone32.las zone32.las out.las")["colliding"], 1);
  EXPECT_EQ(done("zone32.las zone33.las apart.las --obstacle-crs none")["colliding"], 0);
  EXPECT_EQ(done("zone32.las machine.xyz apart.las")["colliding"], 0) << "which names none";
}

TEST_F(CollideSystems, AreTransformedWhereThatIsAsked)
{
  for (const char* to : {"EPSG:25832", "EPSG:25833", "EPSG:3035"}) {
    const auto found = done("zone32.las zone33.las out.las --clashes list.json --to-crs " + std::string(to));
    EXPECT_EQ(found["colliding"], 1) << to;
    const auto list = nlohmann::json::parse(io::contentOf(folder / "list.json"));
    const std::string system = list["coordinate_system"];
    EXPECT_THAT(to == std::string("EPSG:25832") ? "(" + system + ")" : system, HasSubstr("(" + std::string(to) + ")"));
    EXPECT_EQ(list["unit"], "m") << "by the coordinate system";
    const bool is_other = to != std::string("EPSG:25833"); // than the obstacle's
    EXPECT_THAT(found["warnings"].dump(),
                HasSubstr(is_other ? "zone33.las: its coordinates are transformed from 'EPSG:25833'"
                                   : "zone32.las: its coordinates are transformed from 'EPSG:25832'"));
    EXPECT_THAT(found["warnings"].dump(), HasSubstr("the grid scale of its middle is "));
  }
}

TEST_F(CollideSystems, WhatIsNotSureIsRefused)
{
  EXPECT_THAT(refused("zone32.las machine.xyz out.las --to-crs EPSG:25832"),
              HasSubstr("machine.xyz: names no coordinate system, and is wanted in EPSG:25832: name its system"));
  EXPECT_EQ(done("zone32.las machine.xyz apart.las --to-crs EPSG:25833 --obstacle-crs none")["colliding"], 0);
  EXPECT_THAT(refused("zone32.las zone33.las out.las --to-crs EPSG:99999", 2),
              HasSubstr("--to-crs: 'EPSG:99999' is no coordinate system that PROJ knows"));
  EXPECT_THAT(refused("zone32.las zone33.las out.las --to-crs none", 2), HasSubstr("--to-crs: 'none' is no system"));
  EXPECT_THAT(refused("zone32.las zone33.las out.las --to-crs EPSG:25832 --input-unit m"),
              HasSubstr("zone32.las: is wanted in the coordinate system EPSG:25832 and in units, too"));
}

TEST_F(CollideSystems, GaugingTransformsItsScan)
{
  const auto [east, north] = io::utmOf(12, 50, 9, 298.257222101);
  std::ostringstream axis;
  axis.precision(12);
  for (const double along : {-50.0, 0.0, 50.0}) axis << 50 + along << ',' << east + along << ',' << north << ",98\n";
  folder.write("axis.csv", "chainage,x,y,z\n" + axis.str());
  folder.write("gauge.csv", "offset,height\n-3,0\n3,0\n3,5\n-3,5\n");
  const Outcome outcome =
      run("pcl_bsh_gauge", "zone33.las --axis axis.csv --profile gauge.csv --report gauge.json --to-crs EPSG:25832",
          folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(io::contentOf(folder / "gauge.json"));
  EXPECT_EQ(report["coordinate_system"], "ETRS89 / UTM zone 32N (EPSG:25832)");
  EXPECT_EQ(report["unit"], "m");
  EXPECT_EQ(report["infringements"].size(), 1U);
}

} // namespace
} // namespace pcl_bsh
