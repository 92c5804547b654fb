// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/section_polygon.h>

#include <pcl_bsh/base/invalid_input.h>

#include "support/random_clouds.h"

#include <gmock/gmock.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <cmath>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using Long = boost::multiprecision::cpp_bin_float_100;

const std::vector<SectionPoint> notched = {{-1.6, 0.1}, {1.6, 0.1},  {1.7, 3.1}, {0.9, 4.3},
                                           {0, 3.6},    {-0.9, 4.3}, {-1.7, 3.1}};

/// Distance with a hundred digits.
Long longDistance(const std::vector<SectionPoint>& outline, const SectionPoint& point)
{
  Long least = 1e300;
  bool inside = false;
  const Long x = point.offset, y = point.height;
  for (std::size_t i = 0, last = outline.size() - 1; i < outline.size(); last = i++) {
    const Long ax = outline[last].offset, ay = outline[last].height, bx = outline[i].offset, by = outline[i].height;
    const Long ex = bx - ax, ey = by - ay;
    Long foot = (ex * (x - ax) + ey * (y - ay)) / (ex * ex + ey * ey);
    foot = foot < 0 ? Long(0) : foot > 1 ? Long(1) : foot;
    const Long dx = x - ax - foot * ex, dy = y - ay - foot * ey;
    least = std::min(least, Long(sqrt(dx * dx + dy * dy)));
    if ((ay <= y) != (by <= y) && (x < ax + (y - ay) / ey * ex)) inside = !inside;
  }
  return inside ? Long(-least) : least;
}

TEST(SectionPolygon, DistancesAreThoseOfLongNumbers)
{
  test::Random random(3);
  for (int i = 0; i < 100'000; ++i) {
    SectionPoint p{random.uniform(-3, 3), random.uniform(-1, 6)};
    if (i % 4 == 0) { // next to an edge
      const std::size_t edge = static_cast<std::size_t>(i / 4) % notched.size();
      const SectionPoint &a = notched[edge], &b = notched[(edge + 1) % notched.size()];
      const double t = random.uniform(0, 1);
      p = {a.offset + t * (b.offset - a.offset), a.height + t * (b.height - a.height)};
    }
    if (i % 100 != 0 && i % 4 != 0) continue; // a hundred digits take long
    const double found = signedDistance(notched, p);
    const Long truth = longDistance(notched, p);
    ASSERT_EQ(found < 0, truth < -1e-60) << p.offset << ' ' << p.height;
    ASSERT_EQ(found == 0, truth < 1e-60 && truth > -1e-60) << p.offset << ' ' << p.height;
    ASSERT_LE(abs(Long(found) - truth), section_distance_error * (6 + std::abs(found)));
  }
}

TEST(SectionPolygon, OnTheOutlineIsZero)
{
  EXPECT_EQ(signedDistance(notched, {0.25, 0.1}), 0);
  EXPECT_EQ(signedDistance(notched, {1.6, 0.1}), 0);
  const std::vector<SectionPoint> thirds = {{0, 0}, {3, 1}, {0, 1}};
  EXPECT_EQ(signedDistance(thirds, {1.5, 0.5}), 0);
  EXPECT_LT(signedDistance(thirds, {std::nextafter(1.5, 0), 0.5}), 0);
  EXPECT_GT(signedDistance(thirds, {std::nextafter(1.5, 2), 0.5}), 0);
}

TEST(SectionPolygon, AThinSliceIsAsDeepAsItsNearestEdge)
{
  const std::vector<SectionPoint> box = {{-1.5, 0}, {1.5, 0}, {1.5, 4}, {-1.5, 4}};
  OutlinePlace nearest;
  EXPECT_DOUBLE_EQ(signedDistance(box, {1.397, 2}, &nearest), -0.103);
  EXPECT_EQ(nearest.at, (SectionPoint{1.5, 2}));
  EXPECT_EQ(nearest.edge, 1u);
  EXPECT_EQ(nearest.share, 0.5);
  EXPECT_DOUBLE_EQ(signedDistance(box, {4.5, 8}, &nearest), 5);
  EXPECT_EQ(nearest.at, (SectionPoint{1.5, 4}));
  EXPECT_EQ(signedDistance(box, {0.75, 4}, &nearest), 0);
  EXPECT_EQ(nearest.edge, 2u);
  EXPECT_EQ(nearest.share, 0.25);
}

TEST(SectionPolygon, CornersMayGoEitherWay)
{
  std::vector<SectionPoint> reversed(notched.rbegin(), notched.rend());
  for (const SectionPoint p : {SectionPoint{0, 3}, {0, 3.9}, {2, 2}})
    EXPECT_EQ(signedDistance(notched, p), signedDistance(reversed, p));
  EXPECT_GT(signedDistance(notched, {0, 3.9}), 0) << "in the notch";
}

std::string polygonRefusal(const std::vector<SectionPoint>& corners)
{
  try {
    simplePolygon(corners);
    return {};
  }
  catch (const InvalidInput& error) {
    return error.what();
  }
}

TEST(SectionPolygon, RefusesWhatIsNoPolygon)
{
  EXPECT_EQ(polygonRefusal(notched), "");
  EXPECT_THAT(polygonRefusal({{0, 0}, {1, 0}}), HasSubstr("has 2 different corners"));
  EXPECT_THAT(polygonRefusal({{0, 0}, {1, 0}, {0, 0}}), HasSubstr("has 2 different corners"));
  EXPECT_THAT(polygonRefusal({{0, 0}, {1, 0}, {std::nan(""), 0}}), HasSubstr("corner 3 (nan, 0) is not finite"));
  EXPECT_THAT(polygonRefusal({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), HasSubstr("its edges from (0, 0) to (1, 1) and"));
  EXPECT_THAT(polygonRefusal({{0, 0}, {2, 0}, {1, 0}, {1, 1}}), HasSubstr("folds back onto itself"));
  EXPECT_THAT(polygonRefusal({{0, 0}, {2, 0}, {2, 2}, {1, 0}}), HasSubstr("meet")) << "a corner on another edge";
  EXPECT_EQ(simplePolygon({{0, 0}, {0, 0}, {1, 0}, {1, 1}, {0, 0}}).size(), 3u);
}

} // namespace
} // namespace pcl_bsh
