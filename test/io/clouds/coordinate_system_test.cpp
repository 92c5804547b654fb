// SPDX-License-Identifier: BSD-3-Clause
#include "coordinate_samples.h"

#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

CoordinateSystem ofCode(const std::string& code)
{
  return {code, code};
}

TEST(CoordinateSystem, WithoutProjTextsAreCompared)
{
  EXPECT_EQ(areOneSystem(ofCode("EPSG:25832"), ofCode("EPSG:25832")), true);
  EXPECT_FALSE(areOneSystem(ofCode("EPSG:25832"), {"a name", ""}));
  EXPECT_FALSE(areOneSystem({"a name", ""}, {"a name", ""}));
  EXPECT_NO_THROW(requireSystem(""));
  EXPECT_NO_THROW(requireSystem(no_system));
  if (hasProj()) return;
  EXPECT_FALSE(areOneSystem(ofCode("EPSG:25832"), ofCode("EPSG:25833")));
  EXPECT_THAT([] { coordinateSystemNamed("EPSG:25832"); },
              ThrowsMessage<FormatError>(HasSubstr("this was built without PROJ")));
}

TEST(CoordinateSystem, CodesAndWktHaveNames)
{
  if (!hasProj()) GTEST_SKIP() << "install libproj-dev";
  EXPECT_EQ(coordinateSystemNamed("EPSG:25832").name, "ETRS89 / UTM zone 32N (EPSG:25832)");
  EXPECT_EQ(coordinateSystemNamed("EPSG:25832+7837").name, "ETRS89 / UTM zone 32N + DHHN2016 height");
  EXPECT_EQ(coordinateSystemNamed(utm_33_wkt).name, "ETRS89 / UTM zone 33N");
  EXPECT_EQ(coordinateSystemNamed(utm_33_wkt).definition, utm_33_wkt);
  for (const char* unknown : {"EPSG:99999", "EPSG:25832+99999", "UTM 32", "+proj=utm +zone=32", "PROJCS[\"a\""})
    EXPECT_THAT([&] { coordinateSystemNamed(unknown); },
                ThrowsMessage<FormatError>(HasSubstr('\'' + std::string(unknown) + "' is no coordinate system")))
        << unknown;
}

TEST(CoordinateSystem, AreOneWhateverTheirText)
{
  if (!hasProj()) GTEST_SKIP() << "install libproj-dev";
  const auto are = [](const std::string& a, const std::string& b) {
    const auto one = areOneSystem(ofCode(a), ofCode(b));
    EXPECT_EQ(areOneSystem(ofCode(b), ofCode(a)), one);
    return one;
  };
  EXPECT_EQ(are(utm_33_wkt, "EPSG:25833"), true);
  EXPECT_EQ(are(utm_33_wkt, "EPSG:25832"), false);
  EXPECT_EQ(are("EPSG:32632", "EPSG:25832"), false) << "of another datum";
  EXPECT_EQ(are("EPSG:2225", "EPSG:26941"), false) << "of another unit";
  EXPECT_EQ(are("EPSG:25832+7837", "EPSG:25832"), true) << "of which one has no heights";
  EXPECT_EQ(are("EPSG:25832+7837", "EPSG:25832+5783"), false) << "of other heights";
  EXPECT_EQ(are("EPSG:25832", "PROJCS[\"a\"]"), std::nullopt);
}

TEST(CoordinateSystem, DifferentOnesAreRefused)
{
  EXPECT_EQ(requireOneSystem("a.las", {"A", "EPSG:25832"}, {}, "do"), std::nullopt);
  EXPECT_EQ(requireOneSystem("a.las", {"A", "EPSG:25832"}, {"B", "EPSG:25832"}, "do"), std::nullopt);
  EXPECT_EQ(requireOneSystem("a.las", {"A", ""}, {"A", "EPSG:25832"}, "do"), std::nullopt) << "by their name";
  EXPECT_THAT(requireOneSystem("a.las", {"A", ""}, {"B", "EPSG:25832"}, "do").value_or(""),
              HasSubstr("is in 'B', and a.las in 'A': whether these are one coordinate system is not known"));
  if (!hasProj()) return;
  EXPECT_THAT(
      [] {
        requireOneSystem("a.las", {"A", "EPSG:25833"}, {"B", "EPSG:25832"}, "do");
      },
      ThrowsMessage<FormatError>(HasSubstr("is in 'B', and a.las in 'A'")));
}

} // namespace
} // namespace pcl_bsh::io
