// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/origin_path.h>

#include <pcl_bsh/base/invalid_input.h>

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl_bsh {
namespace {

TEST(OriginPath, IsStraightAndEvenBetweenTimes)
{
  const OriginPath path({{10, {0, 0, 0}}, {12, {4, -2, 1}}, {13, {4, 0, 1}}});
  EXPECT_EQ(path.at(10), (Point3{0, 0, 0}));
  EXPECT_EQ(path.at(10.5), (Point3{1, -0.5, 0.25}));
  EXPECT_EQ(path.at(12), (Point3{4, -2, 1}));
  EXPECT_EQ(path.at(12.25), (Point3{4, -1.5, 1}));
  EXPECT_EQ(path.at(13), (Point3{4, 0, 1}));
  for (const double outside : {9.99, 13.01, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_EQ(path.at(outside), std::nullopt) << outside;
}

TEST(OriginPath, TellsTheOriginOfEachPointByItsTime)
{
  struct Record {
    float x, y, z;
    double time;
  };
  const std::vector<Record> records = {{0, 0, 0, 11}, {0, 0, 0, 9}, {0, 0, 0, 12}, {0, 0, 0, 12.5}};
  PointsView view;
  view.data = records.data();
  view.count = records.size();
  view.stride = sizeof(Record);
  view.offset = {0, 4, 8};
  const OriginPath path({{10, {0, 0, 0}}, {12, {4, -2, 1}}});
  OutsidePath outside;
  const std::vector<Point3> origins = originsOf(view, {offsetof(Record, time), Scalar::float64}, path, 100, outside);
  EXPECT_EQ(origins[0], (Point3{2, -1, 0.5}));
  EXPECT_TRUE(std::isnan(origins[1][0]));
  EXPECT_EQ(origins[2], (Point3{4, -2, 1}));
  EXPECT_EQ(outside.points, 2u);
  EXPECT_EQ(outside.first, 101u);
  EXPECT_EQ(outside.time, 9);
}

TEST(OriginPath, RefusesWhatIsNoPath)
{
  const auto refusal = [](std::vector<TimedOrigin> places) -> std::string {
    try {
      const OriginPath path(std::move(places));
      return {};
    }
    catch (const InvalidInput& error) {
      return error.what();
    }
  };
  using testing::HasSubstr;
  EXPECT_THAT(refusal({{1, {0, 0, 0}}}), HasSubstr("has 1 of the two places it needs"));
  EXPECT_THAT(refusal({{1, {0, 0, 0}}, {1, {1, 0, 0}}}),
              HasSubstr("place 1: its time 1 does not exceed the one before"));
  EXPECT_THAT(refusal({{1, {0, 0, 0}}, {2, {1, std::nan(""), 0}}}),
              HasSubstr("place 1: has a value that is not finite"));
  EXPECT_THAT(refusal({{std::nan(""), {0, 0, 0}}, {2, {1, 0, 0}}}),
              HasSubstr("place 0: has a value that is not finite"));
}

} // namespace
} // namespace pcl_bsh
