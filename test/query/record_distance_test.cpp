// SPDX-License-Identifier: BSD-3-Clause
// Points, balls and triangles on either side, against the definition in rational numbers.
#include <pcl_bsh/query/record_distance.h>

#include <pcl_bsh/geometry/exact/exact_plane.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/query/pair_reach.h>

#include "geometry/triangle_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;
using test::Rational;

enum class Kind { points, balls, triangles };
constexpr Kind kKinds[] = {Kind::points, Kind::balls, Kind::triangles};

/// A few records of one kind.
struct Records {
  Kind kind;
  std::vector<Triangle3> given; ///< of points, the first corner counts
  std::vector<float> radii;
  std::vector<double> xyz;
  std::vector<std::uint32_t> corners;
  PointsView view;

  Records(Kind of, test::TriangleShape shape, Random& random) : kind(of)
  {
    for (int i = 0; i < 8; ++i) {
      given.push_back(test::triangleOf(shape, 1.0, random));
      radii.push_back(static_cast<float>(std::ldexp(random.integer(0, 8), -10)));
      for (std::size_t corner = 0; corner < (kind == Kind::triangles ? 3 : 1); ++corner)
        xyz.insert(xyz.end(), given.back()[corner].begin(), given.back()[corner].end());
    }
    corners.resize(3 * given.size());
    std::iota(corners.begin(), corners.end(), 0u);
    view = viewOf(xyz.data(), xyz.size() / 3);
    if (kind == Kind::balls) view.radii = radii.data();
    if (kind == Kind::triangles) view = viewOf(TrianglesView{view, corners.data(), given.size()});
  }

  double radius(std::uint32_t i) const { return kind == Kind::balls ? double{radii[i]} : 0.0; }
};

Rational squaredBetween(const Records& a, const Eigen::Isometry3d& pose_a, std::uint32_t i, const Records& b,
                        const Eigen::Isometry3d& pose_b, std::uint32_t j)
{
  using test::posed;
  if (a.kind == Kind::triangles && b.kind == Kind::triangles)
    return test::squaredDistance(posed(pose_a, a.given[i]), posed(pose_b, b.given[j]));
  if (a.kind == Kind::triangles) return test::squaredDistance(posed(pose_b, b.given[j][0]), posed(pose_a, a.given[i]));
  if (b.kind == Kind::triangles) return test::squaredDistance(posed(pose_a, a.given[i][0]), posed(pose_b, b.given[j]));
  return test::squaredLength(posed(pose_a, a.given[i][0]) - posed(pose_b, b.given[j][0]));
}

/// Sign of the root of a square less a length.
int side(const Rational& squared, const Rational& length)
{
  return length < 0 ? 1 : (squared - length * length).sign();
}

TEST(RecordDistance, OfEveryKindEqualsTheDefinition)
{
  Random random(41);
  int ties = 0;
  for (const Kind kind_a : kKinds)
    for (const Kind kind_b : kKinds)
      for (const test::TriangleShape shape : test::kTriangleShapes) {
        const Records a(kind_a, shape, random), b(kind_b, shape, random);
        const Eigen::Isometry3d pose_a = random.chance(0.5) ? Eigen::Isometry3d::Identity() : random.pose(1.0);
        const Eigen::Isometry3d pose_b = random.chance(0.5) ? pose_a : random.pose(0.1);
        const RecordDistance distance(a.view, pose_a, b.view, pose_b);
        const RecordDistance turned(a.view, pose_b, b.view, pose_a);
        EXPECT_EQ(distance.ofTriangles(), kind_a == Kind::triangles || kind_b == Kind::triangles);
        for (std::uint32_t i = 0; i < 8; ++i)
          for (std::uint32_t j = i % 2; j < 8; j += 2) {
            const PointPair pair{i, j};
            const Rational squared = squaredBetween(a, pose_a, i, b, pose_b, j);
            const Rational radii = Rational(a.radius(i)) + Rational(b.radius(j));
            const double gap = distance.gap(pair);
            EXPECT_EQ(gap, distance.gap(distance.pair(pair)));
            EXPECT_LE(side(squared, radii + Rational(std::nextafter(gap, 1e300))), 0);
            EXPECT_GE(side(squared, radii + Rational(std::nextafter(gap, -1e300))), 0);
            for (const double clearance : {gap, std::nextafter(gap, 9.0), std::nextafter(gap, -9.0), 0.25}) {
              const int sign = side(squared, radii + Rational(clearance));
              ties += sign == 0;
              EXPECT_EQ(distance.compare(pair, clearance), sign);
              EXPECT_EQ(distance.compare(distance.pair(pair), clearance), sign);
              EXPECT_EQ(distance.compare(pair, RecordDistance::Sum{clearance, a.radius(i), 0.5, b.radius(j), -0.5}),
                        sign);
              const PairReach reach(a.view, b.view, clearance, MeantPlaces::measured);
              if (clearance >= 0.0) {
                EXPECT_EQ(reach.holds(distance, pair), sign <= 0);
              }
            }
            const RecordDistance::Enclosure enclosure = distance.enclose(distance.pair(pair));
            EXPECT_GE(side(squared, Rational(std::min(enclosure.low, 1e300))), 0);
            EXPECT_LE(side(squared, Rational(std::min(enclosure.high, 1e300))), 0);
            const PointPair next{(i + 1) % 8, j};
            const int order = distance.compareGaps(pair, turned, next);
            EXPECT_EQ(turned.compareGaps(next, distance, pair), -order);
            const double other = turned.gap(next);
            if (gap != other) {
              EXPECT_EQ(order, gap < other ? -1 : 1);
            }
            EXPECT_EQ(distance.compareGaps(pair, pair), 0);
          }
      }
  EXPECT_GT(ties, 20);
}

TEST(RecordDistance, NothingBehindThePlanesIsNearer)
{
  Random random(43);
  int found = 0, touching = 0;
  for (const Kind kind_a : kKinds)
    for (const Kind kind_b : kKinds)
      for (const test::TriangleShape shape : test::kTriangleShapes) {
        const Records a(kind_a, shape, random), b(kind_b, shape, random);
        Eigen::Isometry3d pose_a = random.chance(0.5) ? Eigen::Isometry3d::Identity() : random.pose(1.0);
        Eigen::Isometry3d pose_b = random.chance(0.5) ? pose_a : random.pose(0.1);
        pose_a.translation().x() += random.integer(0, 1); // so that records of lattices do not meet
        const RecordDistance distance(a.view, pose_a, b.view, pose_b);
        const auto cornersOf = [](const Records& records, std::uint32_t i) {
          return std::vector<Point3>(records.given[i].begin(),
                                     records.given[i].begin() + (records.kind == Kind::triangles ? 3 : 1));
        };
        for (std::uint32_t i = 0; i < 8; ++i)
          for (std::uint32_t j = 0; j < 8; ++j) {
            const auto planes = distance.planesBetween({i, j});
            const Rational squared = squaredBetween(a, pose_a, i, b, pose_b, j);
            const bool have_planes = kind_a != Kind::balls && kind_b != Kind::balls &&
                                     (kind_a == Kind::triangles || kind_b == Kind::triangles) && squared != 0;
            ASSERT_EQ(planes.has_value(), have_planes);
            if (!planes) continue;
            ++found;
            const auto farthest = [](const ExactPlane& plane, const std::vector<Point3>& corners) {
              int side = -1;
              for (const Point3& corner : corners) side = std::max(side, plane.side(corner));
              return side;
            };
            EXPECT_EQ(farthest((*planes)[0], cornersOf(a, i)), 0);
            EXPECT_EQ(farthest((*planes)[1], cornersOf(b, j)), 0);
            for (int k = 0; k < 10; ++k) { // beside the corners that touch
              const auto beside = [&](const ExactPlane& plane, const std::vector<Point3>& corners) {
                Point3 at = corners[static_cast<std::size_t>(random.integer(0, static_cast<int>(corners.size()) - 1))];
                const double size = std::ldexp(1.0, random.integer(-30, -8));
                for (double& x : at) x += size * random.uniform(-1, 1);
                return std::pair(at, plane.side(at) <= 0);
              };
              const auto [x, x_is_behind] = beside((*planes)[0], cornersOf(a, i));
              const auto [y, y_is_behind] = beside((*planes)[1], cornersOf(b, j));
              if (!x_is_behind || !y_is_behind) continue;
              ++touching;
              EXPECT_GE(test::squaredLength(test::posed(pose_a, x) - test::posed(pose_b, y)), squared);
            }
          }
      }
  EXPECT_GT(found, 500);
  EXPECT_GT(touching, 500);
}

} // namespace
} // namespace pcl_bsh
