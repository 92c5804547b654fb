// SPDX-License-Identifier: BSD-3-Clause
// The catalogue: inputs that other tools are known to answer wrongly, or not at all, with the answer of exact
// arithmetic.
#pragma once

#include "random_clouds.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh::hard_cases {

using Points = std::vector<Point3>;

inline const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double denormal = std::numeric_limits<double>::denorm_min();
inline constexpr std::size_t unknown = ~std::size_t{0};

inline float f(double x)
{
  return static_cast<float>(x);
}

struct HardCase {
  std::string name;
  Points a, b;
  double clearance;
  std::size_t colliding_pairs = unknown; ///< ordered pairs, in exact arithmetic
  Scalar scalar = Scalar::float32;
  Eigen::Isometry3d pose_a = identity, pose_b = identity;
};

inline std::size_t countPairs(const HardCase& c)
{
  const ExactDistance distance(c.pose_a, c.pose_b);
  const test::Cloud a(c.a, {c.scalar}), b(c.b, {c.scalar});
  const auto finite = [](const Point3& p) { return std::isfinite(p[0] + p[1] + p[2]); };
  std::size_t pairs = 0;
  for (std::uint32_t i = 0; i < c.a.size(); ++i) {
    const Point3 p = a.view().point(i);
    for (std::uint32_t j = 0; finite(p) && j < c.b.size(); ++j) {
      const Point3 q = b.view().point(j);
      pairs += finite(q) && distance.compare(p, q, c.clearance) <= 0;
    }
  }
  return pairs;
}

inline Points listOf(int count, const std::function<Point3(int)>& point)
{
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(point(i));
  return points;
}

inline Points gridOf(int side, double start, double step)
{
  return listOf(side * side * side, [=](int i) {
    return Point3{start + step * (i % side), start + step * (i / side % side), start + step * (i / side / side)};
  });
}

inline HardCase pairOf(const std::string& name, const Point3& p, const Point3& q, double clearance, bool hit,
                       Scalar scalar = Scalar::float32)
{
  return {name, {p}, {q}, clearance, hit ? 1u : 0u, scalar};
}

inline HardCase selfOf(const std::string& name, const Points& points, double clearance, std::size_t pairs,
                       Scalar scalar = Scalar::float32)
{
  return {name, points, points, clearance, pairs, scalar};
}

inline Points rowAt(double y)
{
  return listOf(1000, [y](int i) { return Point3{500000.003 + .01 * i, y, 100}; });
}

inline Points lineWith(const std::function<bool(int)>& is_bad)
{
  return listOf(1000, [&](int i) { return Point3{is_bad(i) ? (i % 2 ? infinity : nan) : f(.001 * i), 0, 0}; });
}

inline std::vector<HardCase> smallCases()
{
  constexpr double d = 5 * denormal;
  const Points full_line = lineWith([](int) { return false; });
  std::vector<HardCase> cases = {
      pairOf("H1", {0, 0, 0}, {3, 4, 0}, 5, true),
      pairOf("H2", {1, 2, 3}, {1, 2, 3}, 0, true),
      pairOf("H3", {0, 0, 0}, {f(.1), 0, 0}, .1, false),
      selfOf("H5", gridOf(12, 0, 1.0 / 16), 3.0 / 16, 157240),
      selfOf("H5b", gridOf(12, 0, .01), .03, 141232),
      selfOf("H5c", gridOf(12, 1000, .01), .03, 144280),
      {"H6", rowAt(5400000.26), rowAt(5400000.34), .05, 0, Scalar::float64},
      {"H6b", rowAt(5400000.24), rowAt(5400000.26), .05, 8980, Scalar::float64},
      pairOf("H8", {0, 0, 0}, {f(3e-40), f(4e-40), 0}, 5.1e-40, true),
      pairOf("H8b", {0, 0, 0}, {f(1e-40), 0, 0}, 5e-41, false),
      pairOf("H8c", {0, 0, 0}, {f(1e-23), 0, 0}, 5e-24, false),
      pairOf("H8 double", {0, 0, 0}, {3 * denormal, 4 * denormal, 0}, d, true, Scalar::float64),
      pairOf("H8 double miss", {0, 0, 0}, {3 * denormal, 4 * denormal, denormal}, d, false, Scalar::float64),
      pairOf("H9", {0, 0, 0}, {f(1e30), 0, 0}, 2e30, true),
      pairOf("H9 miss", {0, 0, 0}, {f(1e30), 0, 0}, .9e30, false),
      selfOf("H10",
             listOf(1000,
                    [](int i) {
                      return Point3{1000 + 1e-7 * i, 0, 0};
                    }),
             1e-6, 20846, Scalar::float64),
      selfOf("H11",
             listOf(64,
                    [](int i) {
                      return Point3{1000 + i * 0x1p-14, 0, 0};
                    }),
             0x1p-14, 190),
      {"H12", full_line, lineWith([](int i) { return i == 0; }), f(.0105), 20879},
      {"H12 every third", full_line, lineWith([](int i) { return i % 3 == 0; }), f(.0105), 13920},
      {"H12 two", lineWith([](int i) { return i == 500 || i == 999; }), full_line, f(.0105), 20890 - 21 - 11},
      {"H13", {{nan, 0, 0}, {0, infinity, 0}, {0, 0, -infinity}}, gridOf(3, 0, 1), 1e30, 0},
      {"H14", {}, gridOf(3, 0, 1), 1e30, 0},
      {"H14 both", {}, {}, 1e30, 0},
      pairOf("H18", {3e38, 0, 0}, {2e38, 0, 0}, 1.1e38, true),
      pairOf("H18 miss", {3e38, 0, 0}, {2e38, 0, 0}, .9e38, false),
      pairOf("H18 double", {1e308, 0, 0}, {-1e308, 0, 0}, 1.7e308, false, Scalar::float64),
      {"H22",
       {{0, 0, 0}, {0x1.1eb852p-4, 0, 0}},
       {{0x1.eb852p-4, 0, 0}, {0x1.851eb8p-3, 0, 0}},
       0x1.99999cp-5,
       unknown},
  };
  for (const double length : {400.0, 430.0, 1e3, 1e10, 1e30}) // H15: an octree would have to be deep
    cases.push_back({"H15 " + std::to_string(length), {{0, 0, 0}, {length, 0, 0}}, {{length, 0, 0}}, .5, 1});
  for (int k = 1; k <= 10000; k += 333) {
    const double clearance = k / 1000.0;
    cases.push_back(pairOf("H4 " + std::to_string(k), {0, 0, 0}, {f(clearance), 0, 0}, clearance,
                           static_cast<double>(f(clearance)) <= clearance));
  }
  for (const double radius : {0.0, 0.25, 0.5}) // every shape of H16 and H17, small enough for brute force
    for (const double shift : {0.0, 0.25}) {
      const auto add = [&](const std::string& name, const Points& points) {
        Points shifted = points;
        for (Point3& p : shifted) p[0] += shift;
        cases.push_back({name + " shifted by " + std::to_string(shift), points, shifted, radius, unknown});
      };
      const auto power = [](int i) { return std::exp2(-(i % 149)); };
      add("H16", Points(300, {1.25, 2.5, 3.75}));
      add("H17 collinear", listOf(300, [](int i) { return Point3{i * 1e-3, 0, 0}; }));
      add("H17 powers", listOf(300, [&](int i) { return Point3{power(i), 0, 0}; }));
      add("H17 powers in space", listOf(343, [&](int i) {
            return Point3{power(20 * (i % 7)), power(20 * (i / 7 % 7)), power(20 * (i / 49))};
          }));
      add("H17 one ulp apart", gridOf(6, 1, 0x1p-23));
    }
  return cases;
}

} // namespace pcl_bsh::hard_cases
