// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/far_places.h>
#include <pcl_bsh/distances/statistics.h>

#include <pcl_bsh/brute_force/brute_force.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>

namespace pcl_bsh {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(DistanceStatistics, OfFiveNumbers)
{
  const DistanceStatistics of = statisticsOf({4, nan, 0, 3, 1, 2, nan});
  EXPECT_EQ(of.count, 5u);
  EXPECT_EQ(of.mean, 2);
  EXPECT_EQ(of.rms, std::sqrt(6.0));
  EXPECT_EQ(of.median, 2);
  EXPECT_EQ(of.maximum, 4);
  const std::array<double, 5> percentiles = {0.2, 1, 3, 3.8, 3.96};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(of.percentiles[i], percentiles[i], 1e-15) << of.percents[i];
}

TEST(DistanceStatistics, OfOneAndOfNone)
{
  const DistanceStatistics one = statisticsOf({0.1});
  for (const double value : {one.mean, one.rms, one.median, one.percentiles[0], one.percentiles[4], one.maximum})
    EXPECT_EQ(value, 0.1);
  for (const std::vector<double>& none : {std::vector<double>{}, {nan, nan}}) {
    const DistanceStatistics of = statisticsOf(none);
    EXPECT_EQ(of.count, 0u);
    for (const double value : {of.mean, of.rms, of.median, of.percentiles[0], of.percentiles[4], of.maximum})
      EXPECT_TRUE(std::isnan(value));
  }
}

TEST(DistanceStatistics, NothingOverflowsOrVanishes)
{
  for (const double unit : {1e308, 1e-310, 5e-324}) {
    const DistanceStatistics of = statisticsOf({unit, unit, unit});
    EXPECT_EQ(of.mean, unit);
    EXPECT_EQ(of.rms, unit);
    EXPECT_EQ(of.median, unit);
  }
  EXPECT_EQ(statisticsOf({0, 0}).rms, 0);
  EXPECT_EQ(statisticsOf({-1, 1}).mean, 0) << "radii make distances negative";
}

TEST(DistanceHistogram, HasRoundIntervalsAndCountsEveryDistanceOnce)
{
  std::mt19937 generator(5);
  std::vector<double> distances = {0, nan, 100, -0.5};
  for (int i = 0; i < 5000; ++i) distances.push_back(std::ldexp(static_cast<double>(generator()), -32));
  for (const double end : {0.9, 1.0, 3.7e-3, 0.25}) {
    const DistanceHistogram histogram = histogramOf(distances, end, 30);
    EXPECT_LE(histogram.counts.size(), 30u);
    EXPECT_GE(histogram.counts.size(), 10u);
    EXPECT_GE(histogram.end(), end);
    EXPECT_LT(histogram.end(), end + histogram.width * 1.001);
    const double digits = histogram.width / std::pow(10, std::floor(std::log10(histogram.width) + 1e-9));
    EXPECT_NEAR(digits * (digits - 1) * (digits - 2) * (digits - 5), 0, 1e-9) << histogram.width;
    std::size_t total = histogram.above;
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
      total += histogram.counts[i];
      const double low = histogram.width * static_cast<double>(i);
      std::size_t expected = 0;
      for (const double d : distances) expected += std::max(d, 0.0) >= low && std::max(d, 0.0) < low + histogram.width;
      EXPECT_NEAR(static_cast<double>(histogram.counts[i]), static_cast<double>(expected), 1) << i;
    }
    EXPECT_EQ(total, distances.size() - 1);
  }
}

TEST(DistanceHistogram, OfClouds)
{
  for (const double end : {0.0, -1.0, nan, 1e-310}) {
    const DistanceHistogram same = histogramOf({0, 0, 2}, end, 20);
    EXPECT_EQ(same.counts, std::vector<std::size_t>{2}) << end;
    EXPECT_EQ(same.above, 1u);
  }
  EXPECT_EQ(histogramOf({1, 2}, 2, 2).counts, (std::vector<std::size_t>{0, 2})) << "the end belongs to the last";
  for (const double end : {infinity, 1e300, std::numeric_limits<double>::max()}) {
    const DistanceHistogram vast = histogramOf({1, 1e308}, end, 30);
    EXPECT_EQ(vast.counts[0], 1u);
    EXPECT_EQ(vast.above, 1u);
    EXPECT_TRUE(std::isfinite(vast.end()));
  }
}

/// A floor, a box on it, a lamp above it, and a floor without both.
class FarPlaces : public testing::Test {
protected:
  FarPlaces()
  {
    for (int x = 0; x < 20; ++x) {
      for (int y = 0; y < 20; ++y) {
        add(after, 0.1 * x, 0.1 * y, 0);
        add(before, 0.1 * x, 0.1 * y, 0);
      }
    }
    for (int z = 1; z <= 5; ++z) add(after, 0.3, 0.3, 0.1 * z);  // records 400 to 404
    for (int x = 0; x < 3; ++x) add(after, 1 + 0.1 * x, 1.5, 2); // 405 to 407
    add(after, nan, 0, 0);                                       // 408
  }

  static void add(std::vector<double>& xyz, double x, double y, double z) { xyz.insert(xyz.end(), {x, y, z}); }

  PointsView view() const { return viewOf(after.data(), after.size() / 3); }

  PointDistances distances(double most = infinity) const
  {
    PointDistancesRequest request;
    request.max_distance = most;
    const SphereHierarchy a(view()), b(viewOf(before.data(), before.size() / 3));
    return brute_force::pointDistances({a}, {b}, request);
  }

  std::vector<double> after, before;
};

TEST_F(FarPlaces, AreClustersOfFarPoints)
{
  const std::vector<FarPlace> places = findFarPlaces(view(), distances(), 0.15, 0.15);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].records, (std::vector<std::uint32_t>{405, 406, 407}));
  EXPECT_NEAR(places[0].distance, 2, 1e-15);
  EXPECT_EQ(places[0].low, (Point3{1, 1.5, 2}));
  EXPECT_EQ(places[0].high, (Point3{1.2, 1.5, 2}));
  EXPECT_EQ(places[1].records, (std::vector<std::uint32_t>{401, 402, 403, 404}));
  EXPECT_EQ(places[1].distance, 0.5);
  EXPECT_EQ(places[1].point, 404u);
  EXPECT_EQ(places[1].closest_point, 63u);
}

TEST_F(FarPlaces, RefuseLengthsThatAreNone)
{
  for (const double length : {0.0, -1.0, infinity, nan})
    EXPECT_THAT([&] { findFarPlaces(view(), distances(), 0.15, length); },
                testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("give a finite length > 0")));
  for (const double beyond : {-1.0, nan})
    EXPECT_THROW(findFarPlaces(view(), distances(), beyond, 0.15), std::invalid_argument) << beyond;
  EXPECT_TRUE(findFarPlaces(view(), distances(), infinity, 0.15).empty());
}

TEST_F(FarPlaces, HoldPointsWithoutADistance)
{
  const std::vector<FarPlace> places = findFarPlaces(view(), distances(0.45), 0.15, 0.15);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].records.size(), 4u) << "of two that are beyond, the one with more points comes first";
  EXPECT_EQ(places[1].records.size(), 3u);
  for (const FarPlace& place : places) {
    EXPECT_EQ(place.distance, infinity);
    EXPECT_EQ(place.closest_point, kNothing);
  }
  EXPECT_EQ(places[0].point, 404u);
}

TEST_F(FarPlaces, OfTheSameDistanceAreThoseOfMorePointsFirst)
{
  for (int x = 3; x < 5; ++x) add(after, 1 + 0.1 * x, 1.5, 2); // records 409 and 410, of the lamp
  const std::vector<FarPlace> places = findFarPlaces(view(), distances(0.45), 0.15, 0.15);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].records, (std::vector<std::uint32_t>{405, 406, 407, 409, 410}));
  EXPECT_EQ(places[1].records, (std::vector<std::uint32_t>{401, 402, 403, 404}));
}

TEST_F(FarPlaces, EveryFarPointIsInOnePlace)
{
  std::mt19937 generator(9);
  const PointDistances all = distances();
  for (int run = 0; run < 50; ++run) {
    const double beyond = 2.0 * static_cast<double>(generator()) / 4294967296.0;
    const double step = 0.01 + static_cast<double>(generator()) / 4294967296.0;
    std::map<std::uint32_t, int> times;
    double worst = infinity;
    for (const FarPlace& place : findFarPlaces(view(), all, beyond, step)) {
      EXPECT_LE(place.distance, worst);
      worst = place.distance;
      for (const std::uint32_t record : place.records) {
        ++times[record];
        EXPECT_LE(all.distance[record], place.distance);
      }
      EXPECT_EQ(all.distance[place.point], place.distance);
    }
    for (std::uint32_t i = 0; i < view().count; ++i) EXPECT_EQ(times[i], all.distance[i] > beyond ? 1 : 0) << i;
  }
}

TEST_F(FarPlaces, RefuseWhatHasNoMeaning)
{
  const PointDistances all = distances();
  EXPECT_TRUE(findFarPlaces(view(), all, infinity, 1).empty());
  EXPECT_THROW(findFarPlaces(view(), all, nan, 1), std::invalid_argument);
  EXPECT_THROW(findFarPlaces(view(), all, -1, 1), std::invalid_argument);
  EXPECT_THROW(findFarPlaces(view(), all, 1, 0), std::invalid_argument);
  EXPECT_THROW(findFarPlaces(view(), all, 1, infinity), std::invalid_argument);
  EXPECT_THROW(findFarPlaces(view(), PointDistances(), 1, 1), std::invalid_argument);
  PointDistances without_points = all, more_points = all;
  without_points.closest_point.clear();
  EXPECT_THROW(findFarPlaces(view(), without_points, 1, 1), std::invalid_argument);
  more_points.closest_point.push_back(0);
  EXPECT_THROW(findFarPlaces(view(), more_points, 1, 1), std::invalid_argument);
  EXPECT_TRUE(findFarPlaces(PointsView{}, PointDistances(), 1, 1).empty());
}

} // namespace
} // namespace pcl_bsh
