// SPDX-License-Identifier: BSD-3-Clause
// Points in lanes against one triangle. A leaf's points are in lanes already, and a triangle's numbers are read from
// one place. All points near a triangle share the cost of laying it flat.

#if defined(PCL_BSH_SIMD_TRIANGLE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_TRIANGLE_LANES_INL_H_
#undef PCL_BSH_SIMD_TRIANGLE_LANES_INL_H_
#else
#define PCL_BSH_SIMD_TRIANGLE_LANES_INL_H_
#endif

#include <pcl_bsh/simd/sphere_lanes-inl.h>

#include <pcl_bsh/simd/flattened_triangle.h>

#include <cstddef>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The operations of vectors, for one number.
HWY_INLINE double Add(double a, double b)
{
  return a + b;
}
HWY_INLINE double Mul(double a, double b)
{
  return a * b;
}
HWY_INLINE double Sub(double a, double b)
{
  return a - b;
}
HWY_INLINE double Min(double a, double b)
{
  return a < b ? a : b;
}
HWY_INLINE double Max(double a, double b)
{
  return a > b ? a : b;
}

/// One coordinate of a point turned into another frame.
template <class Number>
HWY_INLINE constexpr Number turned(Number rx, Number ry, Number rz, Number x, Number y, Number z)
{
  return Add(Add(Mul(rx, x), Mul(ry, y)), Mul(rz, z));
}

/// Where (x, y) falls on the side (side_x, side_y) from the origin, as a share of it.
template <class Number>
HWY_INLINE constexpr Number along(Number side_x, Number side_y, Number inverse, Number x, Number y)
{
  return Mul(Add(Mul(x, side_x), Mul(y, side_y)), inverse);
}

static_assert(turned(Roundings{}, Roundings{}, Roundings{}, Roundings{1}, Roundings{1}, Roundings{1}) ==
                  Roundings{kFlatTurnRoundings},
              "of differences from the origin, rounded once, by rows as they are stored");
static_assert(along(Roundings{}, Roundings{}, Roundings{1}, Roundings{}, Roundings{}) == Roundings{kFlatAlongRoundings},
              "with an inverse that was rounded once");
static_assert(Mul(Roundings{1}, Roundings{1}) == Roundings{kFlatUnderRoundings},
              "the end less x, times a slope that was rounded once");

/// A point of some frame, turned into the triangle's. @param spread makes a vector of a number. @param take called with
/// its coordinates
template <class Number, class Vector, class Spread, class Take>
HWY_INLINE void turnToTriangle(const FlatTriangle<Number>& triangle, const Spread& spread, Vector px, Vector py,
                               Vector pz, const Take& take)
{
  px = Sub(px, spread(triangle.origin[0]));
  py = Sub(py, spread(triangle.origin[1]));
  pz = Sub(pz, spread(triangle.origin[2]));
  const auto row = [&](std::size_t k) HWY_ATTR {
    const Number* r = triangle.rows + 3 * k;
    return turned(spread(r[0]), spread(r[1]), spread(r[2]), px, py, pz);
  };
  take(row(0), row(1), row(2));
}

/// Calls candidate(dx, dy) with the vectors, in the triangle's plane, from three places of the triangle to (x, y).
///
/// Why it holds for any shape: no angle, normal or area is divided by. In its plane the nearest place of the triangle
/// is on one of the two sides at the apex, or it is found as follows. The x is clamped to the longest side, and y to
/// the range above that x under both other sides. A place inside is itself the nearest. Otherwise the nearest is on the
/// longest side or at one of its ends; for both its angles are acute. Each of the three candidates is a place of the
/// triangle, within rounding, and one of them is within rounding of the nearest. So the least of the three distances is
/// as near to the true one as its candidates are, from above and below.
///
/// Rounding bound. Let D be the distance from the triangle as it is stored, L its longest side and u the unit. A point
/// is at most D + L from the origin and from each end of a side.
/// - Turned: each coordinate errs by 4 u of the terms it adds up, which are at most |x - origin| together; as a vector
/// by
///   4 sqrt(3) u (D + L).
/// - Under the sides: 3 u of the height there, at most sqrt(3)/2 L: less than 2.6 u L.
/// - The side from the origin: the share along it errs by 4 u |p| / side. Clamped to the side, and multiplied, the
/// place is off by 4 u (D + L) + u L. It lies on the side, so it is nearer than the nearest by at most that last u
/// L.
/// - The side from the far end: as much, and u (D + L) for the point less that end, u L for the apex less it.
/// The worst of the three is 5 u (D + L) + 2 u L; with the turn less than 11.93 u D + 13.93 u L, of kFlatTriangleUnits.
/// - The sum of three squares of rounded differences: kSquaredDistanceError.
/// Sides whose square is too small for its inverse are taken for points (flatten() counts their length).
template <class Number, class Vector, class Spread, class Candidate>
HWY_INLINE void beyondPlaces(const FlatTriangle<Number>& triangle, const Spread& spread, Vector x, Vector y,
                             const Candidate& candidate)
{
  const Vector zero = spread(Number{0}), one = spread(Number{1});
  const Vector length = spread(triangle.length), height = spread(triangle.apex_y);
  const Vector on_longest = Min(Max(x, zero), length);
  const Vector top = Min(Mul(on_longest, spread(triangle.rise)), Mul(Sub(length, on_longest), spread(triangle.fall)));
  candidate(Sub(x, on_longest), Sub(y, Max(Min(y, top), zero)));
  const auto beyondSide = [&](Vector side_x, Number inverse, Vector from) HWY_ATTR { // a side to the apex
    const Vector t = Min(Max(along(side_x, height, spread(inverse), from, y), zero), one);
    candidate(Sub(from, Mul(t, side_x)), Sub(y, Mul(t, height)));
  };
  beyondSide(spread(triangle.apex_x), triangle.to_start, x);
  beyondSide(spread(static_cast<Number>(triangle.apex_x - triangle.length)), triangle.to_end, Sub(x, length));
}

/// The squared distance of (x, y, z) from the triangle.
template <class Number, class Vector, class Spread>
HWY_INLINE Vector squaredToTriangle(const FlatTriangle<Number>& triangle, const Spread& spread, Vector px, Vector py,
                                    Vector pz)
{
  Vector squared = spread(std::numeric_limits<Number>::infinity());
  turnToTriangle(triangle, spread, px, py, pz, [&](Vector x, Vector y, Vector z) HWY_ATTR {
    beyondPlaces(triangle, spread, x, y,
                 [&](Vector dx, Vector dy) HWY_ATTR { squared = Min(squared, Add(Mul(dx, dx), Mul(dy, dy))); });
    squared = Add(squared, Mul(z, z));
  });
  return squared;
}

/// Squared distances of `count` points (rounded up to whole vectors; the arrays reach that far) to a triangle in their
/// frame; within triangle.error and the shares of flat_triangle.h.
HWY_INLINE void squaredToTriangle(const FlatTriangle<float>& triangle, const float* x, const float* y, const float* z,
                                  std::size_t count, float* squared)
{
  const LaneTag d;
  const auto spread = [d](float value) HWY_ATTR { return hn::Set(d, value); };
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    hn::StoreU(squaredToTriangle(triangle, spread, hn::LoadU(d, x + i), hn::LoadU(d, y + i), hn::LoadU(d, z + i)), d,
               squared + i);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
