// SPDX-License-Identifier: BSD-3-Clause
// Gaps of triangles whose planes face each other against distances in rationals: each that is given is exact, and none
// is given in the states in which the planes do not tell the distance.
#include <pcl_bsh/geometry/triangle/plane_overlap.h>

#include "geometry/triangle_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace pcl_bsh {
namespace {

using test::Random;
using test::Rational;
using test::RationalTriangle;

/// A place in long numbers: the sum of two doubles.
Vector3<LongNumber> placeOf(const Point3& p, const Point3& shift)
{
  return {LongNumber(p[0]) + LongNumber(shift[0]), LongNumber(p[1]) + LongNumber(shift[1]),
          LongNumber(p[2]) + LongNumber(shift[2])};
}

LongCorners cornersOf(const Triangle3& t, const Point3& shift = {0, 0, 0})
{
  return {placeOf(t[0], shift), placeOf(t[1], shift), placeOf(t[2], shift)};
}

Rational rational(const LongNumber& x)
{
  return Rational(x.value()) + Rational(x.tail());
}

RationalTriangle rational(const LongCorners& t)
{
  RationalTriangle exact;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) exact[i][k] = rational(t[i][k]);
  return exact;
}

/// Triangles across z, u and v in the plane; axes are turned by a number of places.
struct Flat {
  double u[3], v[3], height;

  Triangle3 turned(std::size_t axis) const
  {
    Triangle3 t;
    for (std::size_t i = 0; i < 3; ++i) {
      t[i][axis] = height;
      t[i][(axis + 1) % 3] = u[i];
      t[i][(axis + 2) % 3] = v[i];
    }
    return t;
  }
};

/// Fat ones, needles, those on a lattice, segments and points.
Flat anyFlat(Random& random, double size)
{
  Flat flat{{}, {}, size * random.uniform(-1, 1)};
  const int kind = random.integer(0, 5);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto anywhere = [&] { return kind < 3 ? size * random.uniform(-1, 1) : size * random.integer(-2, 2) / 2; };
    flat.u[i] = anywhere();
    flat.v[i] = anywhere();
  }
  if (kind == 1) {
    flat.u[2] = flat.u[0] + 1e-9 * flat.u[2];
    flat.v[2] = flat.v[0] + 1e-9 * flat.v[2];
  }
  if (kind == 5) flat.u[2] = flat.u[1], flat.v[2] = flat.v[1];
  return flat;
}

/// The count of answers for many pairs.
struct Told {
  int gaps = 0, none = 0;
};

void check(const LongCorners& a, const LongCorners& b, Told& told)
{
  const std::optional<LongNumber> gaps[] = {gapOfFacing(a, b), gapOfFacing(b, a)};
  told.none += !gaps[0] + !gaps[1];
  if (!gaps[0] && !gaps[1]) return;
  const Rational squared = test::squaredDistance(rational(a), rational(b));
  for (const auto& gap : gaps) {
    if (!gap) continue;
    ++told.gaps;
    ASSERT_EQ(gap->error(), 0.0);
    ASSERT_GE(gap->value(), 0.0);
    ASSERT_EQ(rational(*gap) * rational(*gap), squared);
  }
}

TEST(GapOfFacing, IsTheDistance)
{
  Random random(41);
  for (const double far : {0.0, 3.7, 5402650.25, 1e15}) {
    Told told;
    for (int i = 0; i < 500; ++i) {
      const double size = std::exp2(random.integer(-30, 3));
      const auto axis = static_cast<std::size_t>(i % 3);
      const Point3 shift = random.point([&] { return far * random.uniform(-1, 1); });
      Flat a = anyFlat(random, size), b = anyFlat(random, size);
      if (i % 4 == 0) b.height = a.height; // they meet, or lie beside each other
      if (i % 5 == 0) b.u[1] = a.u[2], b.v[1] = a.v[2];
      if (i % 5 == 1) // along an edge of a, as far as doubles can: on one side of it or the other
        for (std::size_t j = 0; j < 2; ++j) {
          const double share = random.uniform(0, 1);
          b.u[j] = a.u[0] + share * (a.u[1] - a.u[0]);
          b.v[j] = a.v[0] + share * (a.v[1] - a.v[0]);
        }
      ASSERT_NO_FATAL_FAILURE(check(cornersOf(a.turned(axis), shift), cornersOf(b.turned(axis), shift), told))
          << i << " far " << far;
    }
    EXPECT_GT(told.gaps, 250) << far;
    EXPECT_GT(told.none, 150) << far;
  }
}

/// A grid's cells, one of them bent at a corner by the last bit: no plane holds it.
TEST(GapOfFacing, NeedsBothAcrossOneAxis)
{
  const Triangle3 floor = {{{0, 0, 1}, {8, 0, 1}, {0, 8, 1}}};
  const Triangle3 roof = {{{0, 0, 4}, {8, 0, 4}, {0, 8, 4}}};
  ASSERT_TRUE(gapOfFacing(cornersOf(floor), cornersOf(roof)));
  EXPECT_EQ(gapOfFacing(cornersOf(floor), cornersOf(roof))->value(), 3.0);
  for (std::size_t i = 0; i < 3; ++i)
    for (const double bent : {std::nextafter(4.0, 0.0), std::nextafter(4.0, 9.0), 5.0}) {
      Triangle3 other = roof;
      other[i][2] = bent;
      EXPECT_FALSE(gapOfFacing(cornersOf(floor), cornersOf(other))) << i;
      EXPECT_FALSE(gapOfFacing(cornersOf(other), cornersOf(floor))) << i;
      LongCorners by_tail = cornersOf(roof); // by less than a double has
      by_tail[i][2] = LongNumber(4.0) + LongNumber(std::ldexp(bent - 4.0, -60));
      EXPECT_FALSE(gapOfFacing(cornersOf(floor), by_tail)) << i;
    }
  const Triangle3 wall = {{{1, 0, 0}, {1, 8, 0}, {1, 0, 8}}}; // across another axis
  EXPECT_FALSE(gapOfFacing(cornersOf(floor), cornersOf(wall)));
  const Triangle3 mast = {{{0, 0, 4}, {0, 0, 5}, {0, 0, 6}}}; // a segment along the axis, across two others
  EXPECT_FALSE(gapOfFacing(cornersOf(floor), cornersOf(mast)));
}

/// Side by side, and one place apart from being so: by doubles, by their tails, along edges and at a corner; whichever
/// corner is the first, and whichever way they turn.
TEST(GapOfFacing, NeedsAPlaceOfOneAboveOneOfTheOther)
{
  const Triangle3 floor = {{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}};
  const auto roofAt = [](double x, double y) { return Triangle3{{{x, y, 3}, {x + 4, y, 3}, {x, y + 4, 3}}}; };
  const double beside = std::nextafter(4.0, 9.0);
  const struct {
    Triangle3 roof;
    Point3 shift;
    bool is_above;
  } cases[] = {
      {roofAt(1, 1), {}, true},                          // inside
      {roofAt(-1, 2), {}, true},                         // across an edge
      {roofAt(4, 4), {}, true},                          // a corner above an edge
      {roofAt(8, 0), {}, true},                          // above a corner
      {roofAt(2, -4), {}, true},                         // a corner of it below an edge
      {{{{-1, 1, 3}, {9, 2, 3}, {-1, 3, 3}}}, {}, true}, // no corner above any place
      {{{{4, 5, 3}, {5, 4, 3}, {9, 9, 3}}}, {}, false},
      {{{{4, 4, 3}, {4, 4, 3}, {9, 9, 3}}}, {}, true}, // a segment
      {roofAt(beside, 4), {}, false},
      {roofAt(std::nextafter(8.0, 9.0), 0), {}, false},
      {roofAt(4, 4), {1e-30, 0, 0}, false}, // by the tail alone
      {roofAt(8, 0), {1e-30, 0, 0}, false},
      {roofAt(-4, -4), {-1e-30, -1e-30, 0}, false},
      {{{{-2, 0, 3}, {-2, 8, 3}, {0, 4, 3}}}, {-1e-30, 0, 0}, false},
      {{{{2, -2, 3}, {6, -2, 3}, {4, 0, 3}}}, {0, -1e-30, 0}, false},
      {{{{9, -1, 3}, {-1, 9, 3}, {9, 9, 3}}}, {1e-30, 0, 0}, false}, // along all of an edge
      {{{{0, -1, 3}, {0, 9, 3}, {-9, 4, 3}}}, {-1e-30, 0, 0}, false},
      {{{{-1, 0, 3}, {9, 0, 3}, {4, -9, 3}}}, {0, -1e-30, 0}, false},
      {roofAt(5, 5), {}, false},
  };
  const auto ordered = [](const Triangle3& t, std::size_t order) {
    const std::size_t first = order % 3, step = order < 3 ? 1 : 2;
    return Triangle3{t[first], t[(first + step) % 3], t[(first + 2 * step) % 3]};
  };
  for (const auto& one : cases)
    for (std::size_t order = 0; order < 36; ++order) {
      const LongCorners a = cornersOf(ordered(floor, order / 6)),
                        b = cornersOf(ordered(one.roof, order % 6), one.shift);
      const std::optional<LongNumber> there = gapOfFacing(a, b), back = gapOfFacing(b, a);
      EXPECT_EQ(there.has_value(), one.is_above) << &one - cases << " in order " << order;
      EXPECT_EQ(back.has_value(), one.is_above) << &one - cases << " in order " << order;
      if (there && back) {
        EXPECT_EQ(there->value(), 3.0);
        EXPECT_EQ(back->value(), 3.0);
      }
    }
}

/// Coordinates are known within an error. Along the axis they give the gap. Across it a place must be surely above
/// another, wherever they are.
TEST(GapOfFacing, NeedsNumbersThatAreKnown)
{
  const Triangle3 floor = {{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}}, across = {{{-1, 1, 3}, {9, 2, 3}, {-1, 3, 3}}};
  const Triangle3 beside = {{{4.5, 4.5, 3}, {8, 4.5, 3}, {4.5, 8, 3}}};
  const auto offBy = [](const Triangle3& t, std::size_t i, std::size_t k, double error) {
    LongCorners off = cornersOf(t);
    off[i][k] = {off[i][k].value(), 0.0, error};
    return off;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    for (const auto& [off, other] : {std::pair{offBy(across, i, 2, 1e-300), floor},
                                     {offBy(floor, i, 2, 1e-300), across},
                                     {offBy(across, i, 0, 4.0), floor},
                                     {offBy(floor, i, 1, 4.0), across}}) {
      EXPECT_FALSE(gapOfFacing(cornersOf(other), off)) << i;
      EXPECT_FALSE(gapOfFacing(off, cornersOf(other))) << i;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(gapOfFacing(cornersOf(floor), offBy(across, i, k, 1e-20))) << i << k;
      EXPECT_FALSE(gapOfFacing(cornersOf(floor), offBy(beside, i, k, 1e-20))) << i << k;
      EXPECT_FALSE(gapOfFacing(cornersOf(floor), offBy(across, i, k, std::nan("")))) << i << k;
    }
  }
  LongCorners high = cornersOf(floor, {0, 0, 1e40}), low = cornersOf(across, {0, 0, 1e-40});
  EXPECT_FALSE(gapOfFacing(high, low)); // whose gap is no long number
  for (auto& corner : high) corner[2] = LongNumber(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(gapOfFacing(high, cornersOf(across)));
}

/// Triangles a few last bits of their long coordinates in size: differences are rounded by as much as they are.
TEST(GapOfFacing, TakesTrianglesAsSmallAsLongNumbersAreCoarse)
{
  Random random(42);
  for (const double far : {1.0, 1.0 + 0x1p-52, 3.0}) {
    Told told;
    for (int i = 0; i < 1000; ++i) {
      const auto corners = [&](double height) {
        Triangle3 t;
        for (Point3& corner : t)
          corner = {0x1p-53 + std::ldexp(random.integer(-6, 6), -106),
                    0x1p-53 + std::ldexp(random.integer(-6, 6), -106), height};
        return cornersOf(t, {far, far, 0.0});
      };
      ASSERT_NO_FATAL_FAILURE(check(corners(0.0), corners(0x1p-104), told)) << i << " far " << far;
    }
    EXPECT_GT(told.gaps, 50) << far;
  }
}

/// The squares of these have few digits left, or none.
TEST(GapOfFacing, TakesTrianglesWhoseSquaresVanish)
{
  Random random(45);
  Told told;
  for (int i = 0; i < 400; ++i) {
    const auto corners = [&](double height) {
      Triangle3 t;
      for (Point3& corner : t)
        corner = {std::ldexp(random.uniform(-1, 1), -537), std::ldexp(random.uniform(-1, 1), -537), height};
      return cornersOf(t);
    };
    ASSERT_NO_FATAL_FAILURE(check(corners(0.0), corners(0x1p-537), told)) << i;
  }
}

/// Far beyond what squares of doubles hold, or below: given only where exact.
TEST(GapOfFacing, TakesNumbersOfAnyMagnitude)
{
  Random random(43);
  for (const int exponent : {-1074, -1040, -500, -390, 390, 500, 1000}) {
    Told told;
    for (int i = 0; i < 100; ++i) {
      const auto corners = [&](double height) {
        Triangle3 t;
        for (Point3& corner : t)
          corner = {std::ldexp(random.integer(-6, 6), exponent), std::ldexp(random.integer(-6, 6), exponent),
                    std::ldexp(height, exponent)};
        return cornersOf(t);
      };
      ASSERT_NO_FATAL_FAILURE(check(corners(0.0), corners(random.integer(0, 3)), told)) << i << " of " << exponent;
    }
    EXPECT_GT(told.gaps, 0) << exponent; // corners above each other need no products
  }
}

Rational squaredBeyond(const LongNumber& length)
{
  return rational(length) * rational(length);
}

/// Beyond a length; asked for as a fraction that is not a whole number, too.
bool areBeyond(const LongCorners& a, const LongCorners& b, const LongNumber& length)
{
  const LongNumber square = length * length, three(3.0);
  const bool beyond = areFacesBeyond(a, b, square, LongNumber(1.0));
  EXPECT_EQ(areFacesBeyond(a, b, three * square, three), beyond);
  return beyond;
}

TEST(FacesBeyond, AreBeyond)
{
  Random random(44);
  int beyond = 0, within = 0, undecided = 0;
  for (int i = 0; i < 700; ++i) {
    const test::TriangleShape shape = random.pick(test::kTriangleShapes);
    const double size = std::exp2(random.integer(-8, 2));
    const Point3 shift = random.point([&] { return i % 3 == 0 ? 5402650.25 * random.uniform(-1, 1) : 0.0; });
    Triangle3 a = test::triangleOf(shape, size, random), b = test::triangleOf(shape, size, random);
    const bool is_parallel = random.chance(0.3);
    if (is_parallel) { // b lies in a plane beside that of a, about a length away
      const Point3 u = a[1] - a[0], v = a[2] - a[0], normal = cross(u, v);
      const double off = size * random.uniform(-1, 1) / (std::sqrt(dot(normal, normal)) + 1e-300);
      for (Point3& corner : b) corner = a[0] + random.uniform(-1, 2) * u + random.uniform(-1, 2) * v + off * normal;
    }
    const LongCorners long_a = cornersOf(a, shift), long_b = cornersOf(b, shift);
    const Rational squared = test::squaredDistance(rational(long_a), rational(long_b));
    const double root = std::sqrt(squared.convert_to<double>());
    for (const double length : {0.0, root * random.uniform(0.2, 1.2), root * (1.0 - 1e-14), root,
                                std::nextafter(root, 0.0), std::nextafter(root, 9.0)}) {
      const bool is_beyond = squared > squaredBeyond(LongNumber(length));
      const bool told = areBeyond(long_a, long_b, LongNumber(length));
      ASSERT_EQ(told, areBeyond(long_b, long_a, LongNumber(length)));
      ASSERT_FALSE(told && !is_beyond) << i << ", length " << length;
      ++(told ? beyond : is_beyond ? undecided : within);
    }
  }
  EXPECT_GT(beyond, 500);
  EXPECT_GT(within, 500);
  EXPECT_GT(undecided, 60);
}

TEST(FacesBeyond, AreToldByTheFaceOfEither)
{
  const LongNumber three(3.0), less(std::nextafter(3.0, 0.0));
  const LongCorners floor = cornersOf({{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}});
  const LongCorners tip = cornersOf({{{1, 1, 3}, {1, 4, 9}, {1, 4, 12}}}); // above it, its plane through it
  EXPECT_TRUE(areBeyond(floor, tip, less));
  EXPECT_TRUE(areBeyond(tip, floor, less));
  EXPECT_FALSE(areBeyond(floor, tip, three)); // at just the length
  const LongCorners below = cornersOf({{{1, 1, -3}, {1, 4, -9}, {1, 4, -12}}});
  EXPECT_TRUE(areBeyond(floor, below, less));
  const LongCorners through = cornersOf({{{1, 1, -9}, {2, 1, 9}, {1, 2, 9}}}); // on both sides, far from the plane
  EXPECT_FALSE(areBeyond(floor, through, less));
  EXPECT_FALSE(areBeyond(through, floor, less));
  const LongCorners segment = cornersOf({{{0, 0, 9}, {8, 8, 9}, {4, 4, 9}}}); // which has no normal; the floor has
  EXPECT_TRUE(areBeyond(floor, segment, less));
  EXPECT_FALSE(areBeyond(segment, cornersOf({{{0, 0, 3}, {0, 0, 2}, {0, 0, 1}}}), less));
  LongCorners unsure = tip; // one corner may be as near
  unsure[0][2] = {3.0, 0.0, 1e-3};
  EXPECT_FALSE(areBeyond(floor, unsure, less));
  EXPECT_TRUE(areBeyond(floor, unsure, LongNumber(2.9)));
}

/// A lattice of whole numbers in a plane at any slant, and planes beside it.
struct Lattice {
  Point3 u, v, normal;

  explicit Lattice(Random& random)
  {
    do {
      u = random.point([&] { return random.integer(-4, 4); });
      v = random.point([&] { return random.integer(-4, 4); });
      normal = cross(u, v);
    } while (dot(normal, normal) == 0.0);
  }

  Triangle3 triangle(Random& random, int height) const
  {
    Triangle3 t;
    for (Point3& corner : t)
      corner = static_cast<double>(random.integer(-3, 3)) * u + static_cast<double>(random.integer(-3, 3)) * v +
               static_cast<double>(height) * normal;
    return t;
  }
};

TEST(FacingOf, SaysHowTheDistanceIsToThatOfThePlanes)
{
  Random random(45);
  int over = 0, beside = 0, unknown = 0;
  for (int i = 0; i < 2000; ++i) {
    const Lattice lattice(random);
    const int height = random.integer(1, 3);
    const Triangle3 a = lattice.triangle(random, 0), b = lattice.triangle(random, height);
    const Point3 shift = random.point([&] { return i % 2 == 0 ? 0.0 : random.uniform(-1, 1); });
    const LongCorners long_a = cornersOf(a, shift), long_b = cornersOf(b, shift);
    ASSERT_NE(areParallel(long_a, long_b), false);
    const Rational squared = test::squaredDistance(rational(long_a), rational(long_b));
    const Rational of_planes = Rational(height * height) * Rational(dot(lattice.normal, lattice.normal));
    for (const PlaneOverlap overlap : {overlapOf(long_a, long_b), overlapOf(long_b, long_a)}) {
      ASSERT_TRUE(overlap != PlaneOverlap::over || squared == of_planes) << i;
      ASSERT_TRUE(overlap != PlaneOverlap::beside || squared > of_planes) << i;
      ++(overlap == PlaneOverlap::over ? over : overlap == PlaneOverlap::beside ? beside : unknown);
    }
  }
  EXPECT_GT(over, 1000);
  EXPECT_GT(beside, 1000);
  EXPECT_LT(unknown, 1000); // segments, mostly
}

TEST(FacingOf, TakesParallelPlanesAlone)
{
  Random random(46);
  for (int i = 0; i < 300; ++i) {
    const Lattice lattice(random);
    const Triangle3 a = lattice.triangle(random, 0);
    Triangle3 b = lattice.triangle(random, 2);
    const Point3 normal = cross(a[1] - a[0], a[2] - a[0]);
    if (dot(normal, normal) == 0.0) continue;
    EXPECT_EQ(areParallel(cornersOf(a), cornersOf(b)), true);
    b[1] = b[1] + 0x1p-45 * lattice.normal;
    EXPECT_EQ(areParallel(cornersOf(a), cornersOf(b)), false);
    LongCorners unsure = cornersOf(a); // of the height, whichever it is
    for (std::size_t k = 0; k < 3; ++k)
      if (lattice.normal[k] != 0.0) unsure[0][k] = {unsure[0][k].value(), 0.0, 1e-3};
    const Triangle3 c = lattice.triangle(random, 1);
    const Point3 other = cross(c[1] - c[0], c[2] - c[0]);
    EXPECT_TRUE(dot(other, other) == 0.0 || areParallel(unsure, cornersOf(c)) != true);
  }
}

} // namespace
} // namespace pcl_bsh
