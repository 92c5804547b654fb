// SPDX-License-Identifier: BSD-3-Clause
// How often the float kernels round, and what that amounts to. The kernels' own headers, named -inl.h, count it: each
// operation tree stands there once, is evaluated with Roundings while it is compiled, and must give the number named
// here. The scripts of test/proof prove what follows from these numbers.
#pragma once

#include <algorithm>

namespace pcl_bsh {

inline constexpr double kFloatUnit = 0x1p-24; ///< u: unit roundoff of float

/// The largest number of roundings among the terms that an expression adds up. A term that is not there, or is exactly
/// 0, is kNoTerm.
struct Roundings {
  int most = 0;

  friend constexpr Roundings Add(Roundings a, Roundings b) { return {std::max(a.most, b.most) + 1}; }
  friend constexpr Roundings Sub(Roundings a, Roundings b) { return Add(a, b); }
  friend constexpr Roundings Mul(Roundings a, Roundings b) { return {a.most + b.most + 1}; }
  friend constexpr bool operator==(Roundings a, Roundings b) { return a.most == b.most; }
};

inline constexpr Roundings kNoTerm{-1000};

/// Relative error of `count` roundings to float, one to eight of them: at least (1 + u)^count - 1 and (1 - u)^-count -
/// 1. Both are below count u (1 + count u) <= count u (1 + 2^-21); the other half of 2^-20 pays for a few roundings of
/// double arithmetic on the way to a threshold.
constexpr double relativeError(int count)
{
  return count * kFloatUnit * (1.0 + 0x1p-20);
}

/// carry(), carryPoint(): a product's matrix entry was rounded to float, then come the product and up to three sums.
/// The shift was rounded to float, then come three sums. Products are not fused into sums.
inline constexpr int kCarriedProductRoundings = 5;
inline constexpr int kCarriedShiftRoundings = 4;
inline constexpr double kCarriedProductError = relativeError(kCarriedProductRoundings);
inline constexpr double kCarriedShiftError = relativeError(kCarriedShiftRoundings);

/// Carried coordinates whose terms add up to less than this do not overflow on the way.
inline constexpr double kLargestCarried = 0x1p126;

/// Squared distances: a difference counts twice in its square, then come the product and up to two sums.
inline constexpr int kSquaredDistanceRoundings = 5;
inline constexpr double kSquaredDistanceError = relativeError(kSquaredDistanceRoundings);

/// Relative error of a root of a squared distance, in double: (1 - u)^-(5/2), and the root's own rounding.
inline constexpr double kLengthError = kSquaredDistanceError / 2;

/// The smallest length that floats are trusted with: what underflows in a kernel, of products below 2^-126 or of
/// squares of lengths below 2^-63, is less than this together, as a length. Radii and reaches of spheres are never
/// less.
inline constexpr double kSmallestLength = 0x1p-60;
/// The smallest squared distance that bands need: squares and their sums err by less than 2^-147 in all.
inline constexpr double kSmallestSquare = 0x1p-124;

/// Relative margin of squared comparisons of spheres: squared distances against sums of radii and a reach. The distance
/// has 5 roundings. The limit has 8 at most: two products, and three of each factor (a stretched radius, two sums). The
/// reach was rounded outward by more than it loses, kReachMargin. 2^-20 = 16 u is above the 13 u of both.
inline constexpr int kSphereLimitRoundings = 8;
inline constexpr float kSphereMargin = 0x1p-20f;

/// Relative margin of radii measured in float: above kLengthError and the roundings of a root, a product and a sum.
inline constexpr float kRadiusMargin = 0x1p-20f;

/// Pays for underflow of squares of lengths; lengths that matter are at least kSmallestLength.
inline constexpr float kVanishingSquare = 0x1p-120f;

/// Relative margin of slabs: normals may be off their length by 2^-19 each, and so may the rotation that carries them.
/// The float arithmetic of a dot product is below 8 u = 2^-21.
inline constexpr float kSlabMargin = 0x1p-16f;

/// Relative margin of a reach that was rounded from double to float: a cast and a product round it by 2 u, and three
/// sums follow; it is good for 6 u.
inline constexpr float kReachMargin = 0x1p-21f;

/// Segments against boxes: rounding relative to the largest coordinate of starts, ends and widened boxes. Starts take 5
/// u, carried ends 5 u, their difference 2 u, the gap to a box 2 u. The error of the time shifts a place by 6 u of the
/// motion, which is at most two such coordinates. Together less than 40 u of the 64.
inline constexpr float kSegmentRounding = 0x1p-18f;

/// Error of an instant i / steps, in steps: two roundings of up to `steps`, and those of the stay's ends.
inline constexpr float kStepRounding = 0x1p-21f;

/// Neighbours: the share e in (sqrt(s) + rho)^2 <= s (1 + e) + rho^2 (1 + 1/e), which splits a squared distance s from
/// an error rho. Then the margin of float lengths after a cast, a root, a product and a sum.
inline constexpr float kNeighborShare = 0x1p-20f;
inline constexpr float kNeighborMargin = 0x1p-20f;

} // namespace pcl_bsh
