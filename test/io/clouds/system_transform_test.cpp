// SPDX-License-Identifier: BSD-3-Clause
#include "coordinate_samples.h"

#include <pcl_bsh/io/clouds/systems/system_transform.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class SystemTransformTest : public testing::Test {
protected:
  void SetUp() override
  {
    if (!hasProj()) GTEST_SKIP() << "install libproj-dev";
  }

  static Eigen::AlignedBox3d boxOf(const std::vector<Point3>& places)
  {
    Eigen::AlignedBox3d box;
    for (const Point3& p : places)
      if (std::isfinite(p[0])) box.extend(Eigen::Vector3d(p[0], p[1], p[2]));
    return box;
  }

  std::vector<Point3> transformed(const std::string& from, const std::string& to, std::vector<Point3> places,
                                  std::optional<LengthUnit> told = {})
  {
    const SystemTransform transform({from, from}, to, boxOf(places), told);
    remarks = transform.remarks();
    unit = transform.unit();
    transform(places, 0);
    return places;
  }

  std::string refusal(const std::string& from, const std::string& to, const std::vector<Point3>& places = {},
                      std::optional<LengthUnit> told = {})
  {
    try {
      transformed(from, to, places, told);
    }
    catch (const FormatError& error) {
      return std::string(error.what()) + ": " + error.remedy();
    }
    return {};
  }

  std::vector<std::string> remarks;
  LengthUnit unit = LengthUnit::mm;
};

TEST_F(SystemTransformTest, PlacesAreThoseOfTheSeries)
{
  std::vector<Point3> degrees;
  for (const double longitude : {6.0, 8.5, 9.0, 11.999})
    for (const double latitude : {0.5, 48.0, 71.25}) degrees.push_back({longitude, latitude, longitude * 10});
  const std::vector<Point3> found = transformed("EPSG:4326", "EPSG:32632", degrees);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto expected = utmOf(degrees[i][0], degrees[i][1], 9, 298.257223563);
    EXPECT_NEAR(found[i][0], expected[0], 1e-6);
    EXPECT_NEAR(found[i][1], expected[1], 1e-6);
    EXPECT_EQ(found[i][2], degrees[i][2]) << "heights stay";
  }
  EXPECT_EQ(unit, LengthUnit::m);
  EXPECT_THAT(remarks, Contains("its heights are taken for metres"));
  EXPECT_THAT(remarks, Contains("its coordinates are transformed from 'EPSG:4326' to 'WGS 84 / UTM zone 32N "
                                "(EPSG:32632)' by 'UTM zone 32N', exact"));
}

TEST_F(SystemTransformTest, ThereAndBackIsLessThanAMillimetre)
{
  const std::vector<Point3> places = {{500000, 5400000, 12.5}, {561234.567, 5312345.678, -3}, {650000, 5900000, 1e4}};
  for (const char* other : {"EPSG:25833", "EPSG:31467", "EPSG:32632"}) {
    const std::vector<Point3> there = transformed("EPSG:25832", other, places),
                              back = transformed(other, "EPSG:25832", there);
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(back[i][k], places[i][k], 1e-3) << other;
      EXPECT_EQ(back[i][2], places[i][2]) << other;
    }
  }
  transformed("EPSG:25832", "EPSG:31467", places);
  EXPECT_THAT(remarks, Contains(HasSubstr(", accurate to "))) << "the operation is of measured datums";
}

TEST_F(SystemTransformTest, WhatIsNotFiniteStays)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Point3> found =
      transformed("EPSG:25833", "EPSG:25832", {{nan, 1, 2}, {500000, 5400000, 3}, {1, 2, HUGE_VAL}});
  EXPECT_TRUE(std::isnan(found[0][0]));
  EXPECT_EQ(found[0][1], 1);
  EXPECT_EQ(found[1][2], 3);
  EXPECT_GT(found[1][0], 900000) << "six degrees to the east";
  EXPECT_EQ(found[2], (Point3{1, 2, HUGE_VAL}));
  EXPECT_TRUE(transformed("EPSG:25833", "EPSG:25832", {}).empty());
}

TEST_F(SystemTransformTest, ARecordThatCannotBeTransformedIsNamed)
{
  std::vector<Point3> places(10, Point3{500000, 5400000, 0});
  const SystemTransform transform({"EPSG:25833", "EPSG:25833"}, "EPSG:25832", boxOf(places), {});
  const std::vector<Point3> before = places;
  places[7] = {1e12, 1e12, 0};
  try {
    transform(places, 4096);
    ADD_FAILURE() << "was transformed";
  }
  catch (const FormatError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has record 4103 at (1e+12, 1e+12, 0), which PROJ cannot transform to "
                                        "'ETRS89 / UTM zone 32N (EPSG:25832)'"));
  }
  EXPECT_EQ(places[0], before[0]) << "nothing is half done";
}

TEST_F(SystemTransformTest, HeightsHaveTheUnitOfPlaces)
{
  const Point3 place = {500000, 4000000, 100};
  const std::vector<Point3> feet = transformed("EPSG:26911", "EPSG:2229", {place});
  EXPECT_EQ(unit, LengthUnit::us_ft);
  EXPECT_NEAR(feet[0][2], 100.0 * 3937 / 1200, 1e-9);
  EXPECT_THAT(remarks, Contains(HasSubstr("its heights are multiplied by 3.28083333")));
  const std::vector<Point3> back = transformed("EPSG:2229", "EPSG:26911", feet, LengthUnit::us_ft);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back[0][k], place[k], 1e-3);
  EXPECT_THAT(refusal("EPSG:2229", "EPSG:26911", feet, LengthUnit::m),
              HasSubstr("has lengths in m, which is not the unit of 'EPSG:2229'"));
}

TEST_F(SystemTransformTest, HeightsAreTransformedWhereBothSystemsHaveSome)
{
  const Point3 place = {500000, 5400000, 100};
  EXPECT_EQ(transformed("EPSG:25832+7837", "EPSG:25833", {place})[0][2], 100);
  EXPECT_THAT(remarks, Contains(HasSubstr("its heights stay what they are: 'ETRS89 / UTM zone 33N (EPSG:25833)' has "
                                          "no system of heights")));
  EXPECT_NEAR(transformed("EPSG:25832+7837", "EPSG:25833+7837", {place})[0][2], 100, 1e-9);
  EXPECT_THAT(remarks, Not(Contains(HasSubstr("heights"))));
  const double between = transformed("EPSG:25832+7837", "EPSG:25832+5783", {place})[0][2] - 100;
  EXPECT_NE(between, 0) << "DHHN2016 to DHHN92";
  EXPECT_LT(std::abs(between), 0.5);
}

TEST_F(SystemTransformTest, TheGridScaleIsThatOfTheProjection)
{
  const std::vector<Point3> middle = transformed("EPSG:4258", "EPSG:25832", {{9, 48, 0}});
  EXPECT_NEAR(middle[0][0], 500000, 1e-6);
  EXPECT_THAT(remarks, Contains("the grid scale of its middle is -400.0 ppm: lengths differ by so much from those on "
                                "the ellipsoid"));
  transformed("EPSG:4269", "EPSG:2229", {{-118, 34 + 2.0 / 60, 0}});
  EXPECT_THAT(remarks, Contains(HasSubstr("the grid scale of its middle is 0.0 ppm")))
      << "a standard parallel, in feet";
  transformed("EPSG:4258", "EPSG:3035", {{25, 52, 0}});
  EXPECT_THAT(remarks, Contains(testing::ContainsRegex("is [0-9.]+ \\(to the north\\) and -[0-9.]+ \\(to the east")))
      << "of equal areas";
  const Point3 east = transformed("EPSG:4258", "EPSG:25832", {{9.001, 48, 0}})[0];
  const double radius = 6378137 / std::sqrt(1 - 0.00669438002290 * std::pow(std::sin(48 * std::acos(-1.0) / 180), 2));
  const double truly = 0.001 * std::acos(-1.0) / 180 * radius * std::cos(48 * std::acos(-1.0) / 180);
  EXPECT_NEAR((east[0] - 500000) / truly, 1 - 400e-6, 1e-7) << "by the length of a parallel";
}

TEST_F(SystemTransformTest, NothingChangesWithinOneSystem)
{
  const SystemTransform same({"UTM", utm_33_wkt}, "EPSG:25833", {}, LengthUnit::m);
  EXPECT_TRUE(same.isIdentity());
  EXPECT_TRUE(same.remarks().empty());
  std::vector<Point3> places = {{0.1, 0.2, 0.3}};
  same(places, 0);
  EXPECT_EQ(places[0], (Point3{0.1, 0.2, 0.3}));
}

TEST_F(SystemTransformTest, WhatIsNotSureIsRefused)
{
  EXPECT_THAT(refusal("EPSG:25832", "EPSG:99999"), HasSubstr("'EPSG:99999' is no coordinate system that PROJ knows"));
  EXPECT_THAT(refusal("UTM of ours", "EPSG:25832"),
              HasSubstr("has the coordinate system 'UTM of ours', which PROJ does not know"));
  for (const char* none : {"EPSG:4326", "EPSG:4978", "EPSG:7837"})
    EXPECT_THAT(refusal("EPSG:25832", none), HasSubstr("which has no plane with lengths in mm, cm, m, ft or us-ft"));
  EXPECT_THAT(refusal("EPSG:4978", "EPSG:25832"), HasSubstr("which is neither projected nor of longitudes"));
  const std::string bessel = "+proj=utm +zone=32 +ellps=bessel +type=crs";
  EXPECT_THAT(refusal(bessel, "EPSG:25832", {{500000, 5400000, 0}}),
              HasSubstr("PROJ knows no way there, or none but a rough one (a ballpark transformation)"));
  EXPECT_THAT(refusal("+proj=utm +zone=32 +ellps=bessel +nadgrids=none_such.gsb +type=crs", "EPSG:32632",
                      {{500000, 5400000, 0}}),
              HasSubstr("the way there needs the grid none_such.gsb, which is not there"));
}

TEST_F(SystemTransformTest, APlaceOutsideOfTheTargetsAreaIsTold)
{
  transformed("EPSG:4326", "EPSG:32632", {{30, 48, 0}});
  EXPECT_THAT(remarks,
              Contains("its middle, at longitude 30 and latitude 48, is outside of the area that 'WGS 84 / UTM "
                       "zone 32N (EPSG:32632)' is made for"));
}

} // namespace
} // namespace pcl_bsh::io
