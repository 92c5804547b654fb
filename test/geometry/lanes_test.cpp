// SPDX-License-Identifier: BSD-3-Clause
// Kernels over lanes, one lane at a time in double arithmetic: what they leave out is out of reach, and little else is.
#include "support/attack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "test/geometry/lanes_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/simd/point_lanes-inl.h>
#include <pcl_bsh/simd/rank_sort-inl.h>
#include <pcl_bsh/simd/segment_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

using test::Random;

inline float anyFloat(Random& random, double low, double high)
{
  return static_cast<float>(random.uniform(low, high));
}

/// Numbers of wrong answers, by name.
std::string wrongSmallestLanes(Random& random)
{
  alignas(32) float values[kLanes];
  for (float& x : values) x = static_cast<float>(random.integer(0, 9));
  const auto among = static_cast<std::uint32_t>(random.integer(1, 255));
  std::uint32_t expected = kLanes;
  for (std::uint32_t i = 0; i < kLanes; ++i)
    if ((among >> i & 1) != 0 && (expected == kLanes || values[i] < values[expected])) expected = i;
  if (smallestLane(values, among) != expected) return "smallest lane";
  std::uint32_t all = 0, below = 0, low = 0;
  for (std::uint32_t i = 0; i < kLanes; ++i) {
    if ((among >> i & 1) != 0 && values[i] == values[expected]) all |= 1u << i;
    if (values[i] < 5) below |= 1u << i;
    if (values[i] <= 6) low |= 1u << i;
  }
  if (smallestLanes(values, among) != all) return "lanes of the smallest";
  if (lanesBelow(values, 5) != below) return "lanes below a limit";
  alignas(32) float raised[kLanes];
  std::copy_n(values, kLanes, raised);
  if (raiseLanes(raised, 4, 6) != low) return "raised lanes that are low";
  for (std::uint32_t i = 0; i < kLanes; ++i)
    if (raised[i] != std::max(values[i], 4.0f)) return "raised lanes";
  for (std::uint32_t i = 0; i < kLanes; ++i)
    values[i] = random.chance(0.5) ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  const std::uint32_t any = smallestLane(values, among);
  return any < kLanes && (among >> any & 1) != 0 ? "" : "smallest lane of no numbers";
}

std::string wrongSorting(Random& random)
{
  const auto count = static_cast<std::size_t>(random.integer(0, 40));
  std::vector<float> values(count + kLanes), sorted(count + kLanes);
  std::vector<std::uint32_t> records(count + kLanes), sorted_records(count + kLanes), order(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<float>(random.integer(-3, 12));
    records[i] = static_cast<std::uint32_t>(100 + i);
    order[i] = static_cast<std::uint32_t>(i);
  }
  const std::vector<float> given = values;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return given[a] < given[b]; });
  rankSort(values.data(), records.data(), count, sorted.data(), sorted_records.data());
  for (std::size_t i = 0; i < count; ++i)
    if (sorted_records[i] != 100 + order[i] || sorted[i] != given[order[i]]) return "sorting by rank";
  return "";
}

struct Spheres {
  explicit Spheres(Random& random) : stretch(anyFloat(random, 0.5, 2))
  {
    for (std::size_t i = 0; i < kLanes; ++i) {
      for (float* const axis : {x, y, z}) axis[i] = anyFloat(random, -4, 4);
      r[i] = anyFloat(random, 0, 1);
    }
  }
  SphereLanes lanes() const { return {x, y, z, r, stretch}; }
  alignas(32) float x[kLanes], y[kLanes], z[kLanes], r[kLanes];
  float stretch;
};

/// Whether a bit is what two lengths say: it may be either where they are alike.
inline bool isRight(std::uint32_t bits, std::size_t i, double length, double limit)
{
  const bool within = (bits >> i & 1) != 0;
  return within ? length <= limit * (1 + 1e-5) + 1e-6 : length >= limit;
}

std::string wrongSpheres(Random& random)
{
  const Spheres spheres(random);
  const Point center{anyFloat(random, -4, 4), anyFloat(random, -4, 4), anyFloat(random, -4, 4)};
  const QueryBox box{center, {anyFloat(random, 0, 1), anyFloat(random, 0, 1), anyFloat(random, 0, 1)}};
  const float reach = anyFloat(random, 0, 2), radius = anyFloat(random, 0, 1);
  const std::uint32_t near_box = spheresNearBox(spheres.lanes(), box, reach);
  const QueryBall ball{center.x, center.y, center.z, radius + reach, reach + 2 - radius};
  alignas(32) float gap[kLanes], each[kLanes];
  const std::uint32_t near = spheresNear(spheres.lanes(), ball, gap), inside = spheresInside(spheres.lanes(), ball);
  for (std::size_t i = 0; i < kLanes; ++i) each[i] = anyFloat(random, -1, 2);
  const std::uint32_t near_each = spheresNearEach(spheres.lanes(), each, center, reach - 0.5f, nullptr);
  const std::uint32_t far = spheresFar(gap, spheres.r, spheres.stretch, radius, 3.0f);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double away[3] = {std::abs(double{spheres.x[i]} - center.x), std::abs(double{spheres.y[i]} - center.y),
                            std::abs(double{spheres.z[i]} - center.z)};
    double beside[3];
    for (std::size_t k = 0; k < 3; ++k) beside[k] = std::max(0.0, away[k] - box.half[k]);
    const double own = double{spheres.r[i]} * spheres.stretch, distance = std::hypot(away[0], away[1], away[2]);
    if (!isRight(near_box, i, std::hypot(beside[0], beside[1], beside[2]), own + reach)) return "spheres near a box";
    if (!isRight(near, i, distance, own + ball.near_reach)) return "spheres near";
    if (std::abs(gap[i] - (distance - own)) > 1e-5) return "gaps of spheres";
    if (!isRight(~inside, i, ball.inside_reach - own, distance)) return "spheres inside";
    const double sum = double{each[i]} + (double{reach} - 0.5);
    if ((near_each >> i & 1) != 0 ? sum < -1e-6 || distance > sum * (1 + 1e-5) + 1e-6 : sum > 0 && distance < sum)
      return "spheres near each";
    const double beyond = distance - 3.0 * (own + radius);
    if (std::abs(beyond) > 1e-4 && (far >> i & 1) != (beyond > 0 ? 1u : 0u)) return "far spheres";
  }
  return "";
}

std::string wrongBoxes(Random& random)
{
  alignas(64) float places[3][kLeafPoints], lows[3][kLanes], highs[3][kLanes], limits[kLeafPoints], least[kLanes];
  float low[3], high[3];
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = anyFloat(random, -2, 2);
    high[k] = low[k] + anyFloat(random, 0, 2);
    for (float& x : places[k]) x = anyFloat(random, -5, 5);
    for (std::size_t i = 0; i < kLanes; ++i) {
      lows[k][i] = anyFloat(random, -5, 5);
      highs[k][i] = lows[k][i] + anyFloat(random, 0, 2);
    }
  }
  for (float& x : limits) x = anyFloat(random, 0, 20);
  const float reach = anyFloat(random, 0, 3);
  const std::uint32_t points = pointsNearBox(places[0], places[1], places[2], kLeafPoints, low, high, limits);
  const std::uint32_t leaf = pointsNearBox(places[0], places[1], places[2], low, high, reach, 1e-6f);
  const std::uint32_t boxes = boxesNearBox(lows, highs, low, high, limits);
  std::fill(least, least + kLanes, 30.0f);
  float corner_places[3][kLanes];
  for (std::size_t k = 0; k < 3; ++k) std::copy(places[k], places[k] + kLanes, corner_places[k]);
  alignas(64) float aligned[3][kLanes];
  std::copy(&corner_places[0][0], &corner_places[0][0] + 3 * kLanes, &aligned[0][0]);
  lowerToFarthestCorner(aligned, low, high, least);
  for (std::size_t i = 0; i < kLeafPoints; ++i) {
    double squared = 0.0, of_boxes = 0.0, farthest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = places[k][i], off = std::max({low[k] - at, at - high[k], 0.0});
      squared += off * off;
      const double corner = std::max(at - low[k], high[k] - at);
      farthest += corner * corner;
      if (i >= kLanes) continue;
      const double apart = std::max({double{low[k]} - highs[k][i], double{lows[k][i]} - high[k], 0.0});
      of_boxes += apart * apart;
    }
    if (std::abs(squared - limits[i]) > 1e-4 && (points >> i & 1) != (squared < limits[i] ? 1u : 0u))
      return "points near a box, each to its limit";
    if (!isRight(leaf, i, std::sqrt(squared), reach)) return "points near a box";
    if (i >= kLanes) continue;
    if (std::abs(of_boxes - limits[i]) > 1e-4 && (boxes >> i & 1) != (of_boxes < limits[i] ? 1u : 0u))
      return "boxes near a box";
    if (std::abs(least[i] - std::min(30.0, farthest)) > 1e-4) return "the farthest corner";
  }
  return "";
}

/// The nearest two of some points of another leaf, of each of sixteen, and which the nearest is; less radii, or not.
template <bool kBalls>
std::string wrongNearestTwo(Random& random)
{
  LeafPoints points;
  alignas(64) float x[kLeafPoints], y[kLeafPoints], z[kLeafPoints], radii[kLeafPoints];
  for (float* const axis : {points.x, points.y, points.z, x, y, z})
    for (std::size_t i = 0; i < kLeafPoints; ++i) axis[i] = anyFloat(random, -1, 1);
  for (float& radius : radii) radius = anyFloat(random, 0, 1);
  const float scale = anyFloat(random, 0.125, 0.5);
  NearestTwo nearest;
  nearest.clear();
  float first[kLeafPoints], second[kLeafPoints];
  std::fill(first, first + kLeafPoints, std::numeric_limits<float>::infinity());
  std::fill(second, second + kLeafPoints, std::numeric_limits<float>::infinity());
  std::int32_t name[kLeafPoints];
  std::fill(name, name + kLeafPoints, -1);
  for (std::int32_t leaf = 0; leaf < 2; ++leaf) { // the second one beside what the first has left
    const auto others = static_cast<std::uint32_t>(random.integer(0, 0xffff));
    constexpr std::uint32_t halves[] = {0xffff, 0x00ff, 0xff00}; // of whole vectors
    const std::uint32_t near = halves[random.integer(0, 2)];
    takeNearestTwo<kBalls>(points, near, x, y, z, radii, scale, others, 100 * leaf, nearest);
    for (std::size_t i = 0; i < kLeafPoints; ++i)
      for (std::size_t j = 0; j < kLeafPoints; ++j) {
        if ((others >> j & near >> i & 1) == 0) continue;
        const double dx = double{points.x[i]} - x[j], dy = double{points.y[i]} - y[j], dz = double{points.z[i]} - z[j];
        const double squared = dx * dx + dy * dy + dz * dz;
        const auto value = static_cast<float>(kBalls ? std::sqrt(squared) - double{radii[j]} * scale : squared);
        if (value < first[i]) name[i] = 100 * leaf + static_cast<std::int32_t>(j);
        second[i] = std::min(second[i], std::max(first[i], value));
        first[i] = std::min(first[i], value);
      }
    for (float& at : x) at = anyFloat(random, -1, 1);
  }
  const auto differ = [](float a, float b) { return a != b && !(std::abs(a - b) < 1e-5f); };
  for (std::size_t i = 0; i < kLeafPoints; ++i) {
    if (differ(nearest.first[i], first[i])) return "the nearest";
    if (differ(nearest.second[i], second[i])) return "the second nearest";
    if (differ(first[i], second[i]) && nearest.name[i] != name[i]) return "the name of the nearest";
  }
  return "";
}

std::string wrongExtremes(Random& random)
{
  std::vector<float> values(static_cast<std::size_t>(random.integer(1, 40)));
  for (float& x : values) x = anyFloat(random, -4, 4);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (largestOf(values.data(), values.size()) != *most) return "the largest";
  return smallestOf(values.data(), values.size()) == *least ? "" : "the smallest";
}

std::string wrongLanesOnTarget()
{
  Random random(31);
  for (int i = 0; i < 3000; ++i)
    for (const auto& look : {wrongSmallestLanes, wrongSorting, wrongSpheres, wrongBoxes, wrongNearestTwo<false>,
                             wrongNearestTwo<true>, wrongExtremes})
      if (const std::string wrong = look(random); !wrong.empty()) return wrong;
  return "none";
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {
HWY_EXPORT(wrongLanesOnTarget);

TEST(Lanes, AnswerAsDoublesDo)
{
  test::onEveryTarget(
      [](const std::string& target) { EXPECT_EQ(HWY_DYNAMIC_DISPATCH(wrongLanesOnTarget)(), "none") << target; });
}

} // namespace
} // namespace pcl_bsh
#endif
