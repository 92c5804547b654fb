// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/axis.h>

#include <pcl_bsh/base/invalid_input.h>

#include "made_lines.h"
#include "support/random_clouds.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

constexpr AxisStart utm_start{500123.25, 4012345.5, 0.7};

AxisDescription describedAxis(std::vector<PlanElement> plan)
{
  AxisDescription description;
  description.plan = std::move(plan);
  return description;
}

TEST(Axis, PlacesAreThoseOfTheIntegrals)
{
  for (const auto& plan : {test::curve({3, 4, 0.7}), test::sCurve({3, 4, -2.5}), test::hairpin({0, 0, 1})}) {
    const Axis axis(describedAxis(plan));
    for (double at = 0; at <= axis.length(); at += 7.3) {
      const AxisFrame frame = axis.frame(at);
      const test::TrueFrame truth = test::trueFrameAt(plan, at);
      EXPECT_NEAR(frame.origin[0], static_cast<double>(truth.x), 1e-12) << at;
      EXPECT_NEAR(frame.origin[1], static_cast<double>(truth.y), 1e-12) << at;
      EXPECT_NEAR(frame.right[0], static_cast<double>(std::sin(truth.heading)), 1e-13) << at;
      EXPECT_NEAR(frame.along[1], static_cast<double>(std::sin(truth.heading)), 1e-13) << at;
    }
  }
}

TEST(Axis, ALongClothoidKeepsElevenDigits)
{
  const std::vector<PlanElement> plan = {{6000, 1e-4, -3e-3, AxisStart{0, 0, 0}}};
  const Axis axis(describedAxis(plan));
  const test::TrueFrame truth = test::trueFrameAt(plan, 6000);
  EXPECT_NEAR(axis.frame(6000).origin[0], static_cast<double>(truth.x), 2e-11);
  EXPECT_NEAR(axis.frame(6000).origin[1], static_cast<double>(truth.y), 2e-11);
}

/// Places beside the axis that are made from a distance and an offset, and must be found there.
void expectFoundAgain(const std::vector<PlanElement>& plan, std::size_t count, double reach, double doubt)
{
  const Axis axis(describedAxis(plan));
  constexpr std::size_t stations = 250; // whose truth is integrated
  test::Random random(66);
  std::size_t wrong = 0;
  for (std::size_t s = 0; s < stations; ++s) {
    const double at = random.uniform(0, axis.length());
    const test::TrueFrame truth = test::trueFrameAt(plan, at);
    for (std::size_t i = 0; i < count / stations; ++i) {
      const double offset = random.uniform(-reach, reach), height = random.uniform(-4, 14);
      const Point3 point = {static_cast<double>(truth.x + offset * std::sin(truth.heading)),
                            static_cast<double>(truth.y - offset * std::cos(truth.heading)), height};
      const AxisPlaces found = axis.nearest(point, {reach, 5, 15});
      if (found.state != PlaceState::found || std::abs(found.best.distance - at) > doubt ||
          std::abs(found.best.offset - offset) > doubt || found.best.height != height)
        ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(Axis, ARandomPlaceBesideACurveIsFoundAgain)
{
  expectFoundAgain(test::curve({3, 4, 0.7}), 100'000, 10, 2e-12);
}
TEST(Axis, ARandomPlaceBesideAnSIsFoundAgain)
{
  expectFoundAgain(test::sCurve({3, 4, -2.5}), 100'000, 30, 1e-11);
}
TEST(Axis, UtmCoordinatesKeepANanometre)
{
  expectFoundAgain(test::curve(utm_start), 20'000, 10, 1.4e-9); // the points' own last digit is 0.93e-9
}

/// A straight, three quarters of a circle of 40 to the right, and a straight that crosses the first one.
std::vector<PlanElement> loop()
{
  return {{200, 0, 0, AxisStart{0, 0, 0}}, {1.5 * std::numbers::pi * 40, 1.0 / 40, 1.0 / 40}, {200, 0, 0}};
}

TEST(Axis, WhereItCrossesItselfBothPlacesAreTold)
{
  const Axis axis(describedAxis(loop()));
  const double before_second = 200 + 1.5 * std::numbers::pi * 40 + 40;
  const AxisReach reach{12, 5, 15};
  test::Random random(7);
  for (int i = 0; i < 20'000; ++i) {
    const double x = random.uniform(120, 165), y = random.uniform(-5, 40);
    const double first = y, second = x - 160; // to the right of y = 0 is below, and of x = 160 above
    const bool is_first = std::abs(first) <= 12, is_second = std::abs(second) <= 12;
    const AxisPlaces found = axis.nearest({x, y, 0}, reach);
    ASSERT_EQ(found.state, is_first && is_second   ? PlaceState::two_places
                           : is_first || is_second ? PlaceState::found
                                                   : PlaceState::too_far)
        << x << ' ' << y;
    if (!is_first && !is_second) continue;
    const bool first_is_nearer = is_first && (!is_second || std::abs(first) < std::abs(second));
    EXPECT_NEAR(found.best.distance, first_is_nearer ? x : before_second + y, 1e-11);
    EXPECT_NEAR(found.best.offset, first_is_nearer ? -y : second, 1e-11);
    if (is_first && is_second) {
      EXPECT_NEAR(found.second.offset, first_is_nearer ? second : -y, 1e-11);
    }
  }
  const AxisPlaces equal = axis.nearest({156, 4, 0}, reach);
  EXPECT_LT(equal.best.distance, 200) << "of two at one distance the first along the axis";
}

TEST(Axis, OfTwoTracksOneAboveTheOtherOnlyThatWithinReachCounts)
{
  AxisDescription description = describedAxis(loop());
  description.grades = {{0, 0}, {200, 0}, {390, 30}, {500, 30}};
  const Axis axis(description);
  EXPECT_EQ(axis.nearest({158, 1, 3}, {10, 5, 15}).best.offset, -1);
  EXPECT_EQ(axis.nearest({158, 1, 3}, {10, 5, 15}).state, PlaceState::found);
  EXPECT_NEAR(axis.nearest({158, 1, 33}, {10, 5, 15}).best.offset, -2, 1e-12);
  EXPECT_EQ(axis.nearest({158, 1, 20}, {10, 5, 15}).state, PlaceState::too_far);
}

/// The smallest distance of dense samples of the truth, and no place farther from all of them than half a step.
TEST(Axis, NoPlaceIsNearerThanTheOneFound)
{
  const std::vector<PlanElement> plan = test::sCurve({0, 0, 0});
  const Axis axis(describedAxis(plan));
  std::vector<test::TrueFrame> samples;
  constexpr double step = 0.5;
  for (double at = 0; at <= axis.length(); at += step) samples.push_back(test::trueFrameAt(plan, at));
  test::Random random(8);
  std::size_t found_places = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double x = random.uniform(-30, 230), y = random.uniform(-150, 40);
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t at = 0;
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const double apart = std::hypot(x - static_cast<double>(samples[s].x), y - static_cast<double>(samples[s].y));
      if (apart < nearest) at = s;
      nearest = std::min(nearest, apart);
    }
    const AxisPlaces found = axis.nearest({x, y, 0}, {45, 5, 15});
    const bool is_placed = found.state == PlaceState::found || found.state == PlaceState::two_places;
    found_places += is_placed;
    if (is_placed && at > 0 && at + 1 < samples.size()) {
      EXPECT_LE(std::abs(found.best.offset), nearest + 1e-9) << x << ' ' << y;
      EXPECT_GE(std::abs(found.best.offset), nearest - 0.5 * step) << x << ' ' << y;
    }
    else if (!is_placed && at > 0 && at + 1 < samples.size()) {
      EXPECT_GT(nearest, 45 - 1e-9) << x << ' ' << y;
    }
  }
  EXPECT_GT(found_places, 5000u);
}

TEST(Axis, PointsBeyondTheEndsAreNamed)
{
  const Axis axis(describedAxis({{100, 0, 0, AxisStart{0, 0, 0}}}));
  const AxisReach reach;
  EXPECT_EQ(axis.nearest({-1e-9, 3, 0}, reach).state, PlaceState::before);
  EXPECT_EQ(axis.nearest({-50, 3, 0}, reach).state, PlaceState::before);
  EXPECT_EQ(axis.nearest({0, 3, 0}, reach).state, PlaceState::found);
  EXPECT_EQ(axis.nearest({100, 3, 0}, reach).state, PlaceState::found);
  EXPECT_EQ(axis.nearest({100.001, 3, 0}, reach).state, PlaceState::behind);
  EXPECT_EQ(axis.nearest({50, 10, 0}, reach).state, PlaceState::found);
  EXPECT_EQ(axis.nearest({50, 10.001, 0}, reach).state, PlaceState::too_far);
  EXPECT_EQ(axis.nearest({50, 0, -5.001}, reach).state, PlaceState::too_far);
  EXPECT_EQ(axis.nearest({50, 0, 15.001}, reach).state, PlaceState::too_far);
  EXPECT_EQ(axis.nearest({50, std::nan(""), 0}, reach).state, PlaceState::not_finite);
}

TEST(Axis, HeightsAreThoseOfParabolas)
{
  AxisDescription description = describedAxis({{400, 0, 0, AxisStart{0, 0, 0}}});
  description.grades = {{0, 100}, {200, 102, 80}, {400, 98}};
  const Axis axis(description);
  EXPECT_DOUBLE_EQ(axis.frame(100).origin[2], 101);
  EXPECT_DOUBLE_EQ(axis.frame(160).origin[2], 101.6);
  EXPECT_NEAR(axis.frame(200).origin[2], 102 - 0.03 * 80 / 8, 1e-13);
  EXPECT_NEAR(axis.frame(190).origin[2], 101.6 + 0.01 * 30 - 0.03 / 80 * 450, 1e-13);
  EXPECT_NEAR(axis.frame(240).origin[2], 101.2, 1e-13);
  EXPECT_NEAR(axis.nearest({190, -2, 104}, {}).best.height, 104 - axis.frame(190).origin[2], 1e-12);
}

TEST(Axis, CantTurnsAboutTheLowRailOrTheMiddle)
{
  AxisDescription description = describedAxis({{100, 0, 0, AxisStart{0, 0, 0}}});
  description.cants = {{20, 0}, {60, 0.15}, {80, -0.15}};
  for (const CantPivot pivot : {CantPivot::low_rail, CantPivot::centre}) {
    description.pivot = pivot;
    const Axis axis(description);
    EXPECT_DOUBLE_EQ(axis.cant(40), 0.075);
    EXPECT_DOUBLE_EQ(axis.cant(100), -0.15);
    const double sine = 0.1, cosine = std::sqrt(0.99);
    const AxisFrame frame = axis.frame(60); // the left rail is higher: up leans to the right, which is -y
    EXPECT_NEAR(frame.up[1], -sine, 1e-15);
    EXPECT_NEAR(frame.up[2], cosine, 1e-15);
    EXPECT_NEAR(frame.right[2], -sine, 1e-15);
    const Point3 right_rail = {60, frame.origin[1] + 0.75 * frame.right[1], frame.origin[2] + 0.75 * frame.right[2]};
    const bool low = pivot == CantPivot::low_rail;
    EXPECT_NEAR(right_rail[2], low ? 0 : -0.075, 1e-15);
    EXPECT_NEAR(right_rail[1], low ? -0.75 : -0.75 * cosine, 1e-15);
    EXPECT_NEAR(axis.nearest(right_rail, {}).best.offset, 0.75, 1e-15);
    EXPECT_NEAR(axis.nearest(right_rail, {}).best.height, 0, 1e-15);
    const AxisFrame other = axis.frame(90); // now the left rail is the low one
    EXPECT_NEAR(other.origin[2] - 0.75 * other.right[2], low ? 0 : -0.075, 1e-15);
  }
}

TEST(Axis, ChainagesMayJump)
{
  AxisDescription description = describedAxis({{300, 0, 0, AxisStart{0, 0, 0}}});
  description.chainages = {{0, 1000}, {100, 1100}, {100, 1050}, {200, 1150}, {200, 1200}, {300, 1300}};
  const Axis axis(description);
  EXPECT_EQ(axis.chainage(99), 1099);
  EXPECT_EQ(axis.chainage(100), 1050);
  EXPECT_EQ(axis.chainage(250), 1250);
  EXPECT_THAT(axis.distancesAt(1075), testing::ElementsAre(75, 125)) << "it repeats";
  EXPECT_THAT(axis.distancesAt(1175), testing::IsEmpty()) << "it is left out";
  EXPECT_THAT(axis.distancesAt(1300), testing::ElementsAre(300));
  EXPECT_THAT(axis.distancesAt(1000), testing::ElementsAre(0));
}

/// The message of an axis that refuses to be made, or nothing.
std::string refusalOf(const AxisDescription& description)
{
  try {
    const Axis axis(description);
    return {};
  }
  catch (const InvalidInput& error) {
    EXPECT_EQ(error.input(), Input::trajectory);
    return error.what();
  }
}

TEST(Axis, RefusesWhatIsNoAxis)
{
  const AxisStart start{0, 0, 0};
  EXPECT_THAT(refusalOf({}), HasSubstr("has no beginning"));
  EXPECT_THAT(refusalOf(describedAxis({{0, 0, 0, start}})), HasSubstr("length 0"));
  EXPECT_THAT(refusalOf(describedAxis({{10, std::nan(""), 0, start}})), HasSubstr("a curvature is nan"));
  EXPECT_THAT(refusalOf(describedAxis({{1e7, 100, 100, start}})), HasSubstr("too long or too curved"));
  EXPECT_THAT(refusalOf(describedAxis({{10, 0, 0, start}, {10, 0, 0, AxisStart{10, 0.02, 0}}})),
              HasSubstr("distance 10: the next element starts 0.02 away"));
  EXPECT_THAT(refusalOf(describedAxis({{10, 0, 0, start}, {10, 0, 0, AxisStart{10, 0, 0.1}}})),
              HasSubstr("a kink of 0.1"));
  AxisDescription description = describedAxis({{100, 0, 0, start}});
  description.grades = {{0, 0}, {50, 0, 120}, {100, 1}};
  EXPECT_THAT(refusalOf(description), HasSubstr("no room for a vertical curve of length 120"));
  description.grades = {{0, 0}, {50, 0, 60}, {70, 1, 20}, {100, 1}};
  EXPECT_THAT(refusalOf(description), HasSubstr("no room for a vertical curve of length 20"));
  description.grades = {{50, 0}, {0, 1}};
  EXPECT_THAT(refusalOf(description), HasSubstr("in the order of distances"));
  description.grades = {};
  description.cants = {{0, 150}};
  EXPECT_THAT(refusalOf(description), HasSubstr("its cant 150 is more than half the gauge, 1.5"));
  description.cants = {};
  description.chainages = {{0, 100}, {100, 0}};
  EXPECT_THAT(refusalOf(description), HasSubstr("falls from 100 to 0"));
}

TEST(Axis, RefusesAReachThatItsRadiusDoesNotAllow)
{
  const Axis axis(describedAxis({{10, 0, 0, AxisStart{0, 0, 0}}, {10, 0, -0.1}}));
  EXPECT_NO_THROW(axis.requireReach({8, 5, 15}));
  try {
    axis.requireReach({8.1, 5, 15});
    ADD_FAILURE();
  }
  catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("8.1 beside the axis is more than 0.8 of its smallest radius, 10 at chainage 20"));
  }
  EXPECT_THROW(axis.requireReach({8, 0, 15}), InvalidInput);
}

} // namespace
} // namespace pcl_bsh
