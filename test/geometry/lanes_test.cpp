// SPDX-License-Identifier: BSD-3-Clause
// Kernels over lanes, one lane at a time in double arithmetic: what they leave out is out of reach, and little else is.
#include <pcl_bsh/geometry/triangle/flat_triangle.h>
#include <pcl_bsh/geometry/triangle/separation.h>
#include <pcl_bsh/geometry/triangle/vector3.h>

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

#include <pcl_bsh/simd/crossed_lanes-inl.h>
#include <pcl_bsh/simd/point_lanes-inl.h>
#include <pcl_bsh/simd/rank_sort-inl.h>
#include <pcl_bsh/simd/segment_lanes-inl.h>
#include <pcl_bsh/simd/triangle_pair_lanes-inl.h>

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

/// Eight spheres with two slabs each, beside one such, and a leaf's points beside that one.
std::string wrongCrossedSlabs(Random& random)
{
  using Vector = Eigen::Vector3d;
  const Spheres spheres(random);
  alignas(32) float normals[3][kLanes], crosses[3][kLanes], h[kLanes], cross_h[kLanes];
  const auto takeAxes = [&random](Vector& normal, Vector& cross) {
    const Eigen::Matrix3d axes = random.rotation().toRotationMatrix();
    normal = axes.col(0).cast<float>().cast<double>(), cross = axes.col(1).cast<float>().cast<double>();
  };
  Vector normal[kLanes + 1], cross[kLanes + 1]; // the last is the other's
  for (std::size_t i = 0; i <= kLanes; ++i) takeAxes(normal[i], cross[i]);
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      normals[k][i] = static_cast<float>(normal[i][axis]), crosses[k][i] = static_cast<float>(cross[i][axis]);
    }
    h[i] = anyFloat(random, 0, 1), cross_h[i] = anyFloat(random, 0, 1);
  }
  const Vector &n = normal[kLanes], &c = cross[kLanes];
  const auto pointOf = [](const Vector& v) { return Point{float(v[0]), float(v[1]), float(v[2])}; };
  const Vector center = Vector(anyFloat(random, -4, 4), anyFloat(random, -4, 4), anyFloat(random, -4, 4));
  const CrossedSlabs other{
      pointOf(n), pointOf(c), anyFloat(random, 0, 1), anyFloat(random, 0, 1), pointOf(center), anyFloat(random, 0, 4)};
  const float reach = anyFloat(random, 0, 3);
  const std::uint32_t apart = crossedSlabsApart(spheres.lanes(), {normals[0], normals[1], normals[2], h},
                                                {crosses[0], crosses[1], crosses[2], cross_h}, other, reach);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const auto support = [](const Vector& u, const Vector& along, const Vector& across, float of_n, float of_c,
                            double radius) {
      const double on_n = u.dot(along), on_c = u.dot(across);
      return std::abs(on_n) * of_n + std::abs(on_c) * of_c + (u - on_n * along - on_c * across).norm() * radius;
    };
    const Vector between = Vector(spheres.x[i], spheres.y[i], spheres.z[i]) - center;
    const Vector longest = normal[i].cross(cross[i]).cross(n.cross(c));
    double gap = -std::numeric_limits<double>::infinity();
    for (const Vector& u : {n, c, normal[i], cross[i], longest.normalized().eval()})
      gap =
          std::max(gap, std::abs(u.dot(between)) -
                            support(u, normal[i], cross[i], h[i], cross_h[i], double{spheres.r[i]} * spheres.stretch) -
                            support(u, n, c, other.h, other.cross_h, other.radius));
    if (std::abs(gap - reach) > 1e-3 && (apart >> i & 1) != (gap > reach ? 1u : 0u)) return "crossed slabs";
  }
  alignas(64) float x[kLeafPoints], y[kLeafPoints], z[kLeafPoints];
  for (float* const axis : {x, y, z})
    for (std::size_t i = 0; i < kLeafPoints; ++i) axis[i] = anyFloat(random, -4, 4);
  const std::uint32_t near = pointsNearSlabs(x, y, z, kLeafPoints, other, reach);
  for (std::size_t i = 0; i < kLeafPoints; ++i) {
    const Vector way = Vector(x[i], y[i], z[i]) - center;
    const double distance =
        std::hypot(std::max(std::abs(n.dot(way)) - other.h, 0.0), std::max(std::abs(c.dot(way)) - other.cross_h, 0.0));
    if (std::abs(distance - reach) > 1e-3 && (near >> i & 1) != (distance < reach ? 1u : 0u))
      return "points near slabs";
  }
  return "";
}

/// Sixteen triangles and one: which are surely apart along a direction that is tried, and which have a corner within.
std::string wrongTrianglePairs(Random& random)
{
  const auto any = [&random](double low, double high) { return static_cast<double>(anyFloat(random, low, high)); };
  const auto longestOf = [](const Triangle3& t) {
    Point3 longest = {0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k)
      if (const Point3 side = t[(k + 1) % 3] - t[k]; dot(side, side) > dot(longest, longest)) longest = side;
    return longest;
  };
  const auto normalOf = [](const Triangle3& t) { return cross(t[1] - t[0], t[2] - t[0]); };
  Triangle3 laid;
  for (Point3& corner : laid) corner = random.point([&] { return any(-1, 1); });
  Triangle3 others[kLeafPoints];
  LeafCorners leaf;
  const std::uint32_t out_of_range = 1u << random.integer(0, 31);
  for (std::size_t i = 0; i < kLeafPoints; ++i) {
    const double far = (out_of_range >> i & 1) != 0 ? 0x1p44 : 1.0;
    const Point3 middle = far * random.point([&] { return any(-3, 3); });
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3 p = middle + random.point([&] { return any(-1, 1); });
      leaf.corners[k].x[i] = static_cast<float>(p[0]);
      leaf.corners[k].y[i] = static_cast<float>(p[1]);
      leaf.corners[k].z[i] = static_cast<float>(p[2]);
      others[i][k] = {double{leaf.corners[k].x[i]}, double{leaf.corners[k].y[i]}, double{leaf.corners[k].z[i]}};
    }
  }
  const float reach = anyFloat(random, 0, 2);
  constexpr std::uint32_t some[] = {0xffff, 0x00ff, 0xff00, 0x1248};
  const std::uint32_t lanes = random.pick(some);
  const LanesVerdict found = compareWithTriangle(flatten<float>(laid), leaf, lanes, reach, reach * reach);
  if (((found.apart | found.within) & ~lanes) != 0) return "triangles nobody asks for";
  if ((found.apart & out_of_range) != 0) return "triangles out of range";
  for (std::size_t i = 0; i < kLeafPoints; ++i) {
    if ((lanes & ~out_of_range & 1u << i) == 0) continue;
    double of_corners = std::numeric_limits<double>::infinity(), gap = -of_corners;
    const auto tell = [&](const Point3& u) {
      double low[2], high[2];
      for (const Triangle3* t : {&laid, &others[i]}) {
        const auto [least, most] = std::minmax({dot(u, (*t)[0]), dot(u, (*t)[1]), dot(u, (*t)[2])});
        low[t != &laid] = least, high[t != &laid] = most;
      }
      gap = std::max(gap, std::max(low[0] - high[1], low[1] - high[0]) / std::sqrt(dot(u, u)));
    };
    for (const Point3& corner : others[i]) {
      const Separation of_corner = separationOf(Corners::of(corner), Corners::of(laid));
      of_corners = std::min(of_corners, of_corner.high);
      tell(of_corner.place_a - of_corner.place_b);
    }
    for (const Point3& u : {normalOf(laid), normalOf(others[i]), cross(longestOf(laid), longestOf(others[i]))}) tell(u);
    if ((found.apart >> i & 1) != 0 ? separationOf(Corners::of(laid), Corners::of(others[i])).high < reach
                                    : gap > reach + 1e-4)
      return "triangles apart";
    if ((found.within >> i & 1) != 0 ? of_corners > reach + 1e-4 : of_corners < reach - 1e-4) return "triangles within";
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
  for (int i = 0; i < 500; ++i)
    for (const auto& look : {wrongCrossedSlabs, wrongTrianglePairs})
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
