// SPDX-License-Identifier: BSD-3-Clause
// Triangles in lanes against one triangle that was laid flat: those that are surely farther apart than a reach, and
// those that surely are not. The rest is for numbers of more digits.

#if defined(PCL_BSH_SIMD_TRIANGLE_PAIR_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_TRIANGLE_PAIR_LANES_INL_H_
#undef PCL_BSH_SIMD_TRIANGLE_PAIR_LANES_INL_H_
#else
#define PCL_BSH_SIMD_TRIANGLE_PAIR_LANES_INL_H_
#endif

#include <pcl_bsh/simd/point_lanes-inl.h>
#include <pcl_bsh/simd/triangle_lanes-inl.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Corners of sixteen triangles in one frame; those past the leaf's count hold anything.
struct LeafCorners {
  LeafPoints corners[3];
};

struct LanesVerdict {
  std::uint32_t apart = 0;  ///< bits of the lanes that are surely farther apart than the reach
  std::uint32_t within = 0; ///< bits of the lanes that surely have a corner within the sure reach
};

/// Compares triangles in lanes with one that was laid flat in their frame.
///
/// Apart: along any direction, the gap between two triangles is no more than their distance. So nothing that led to a
/// direction can make a verdict wrong; it only has to be measured well. Directions are tried from the flat triangle to
/// each corner, across both triangles, and across the longest side of each: of needles, that tells most.
///
/// Rounding bound. Let v be a direction in the frame, w the same turned, C the greatest distance of a lane's corner
/// from the flat triangle's origin, and L its longest side. One of v and w is as computed; the other errs by 3 u of
/// terms that are, as a vector, at most sqrt(3) times as long.
/// - A corner less the origin errs by u C, its product with v by 3 u |v| C more.
/// - The flat triangle's corners along w: 5.2 u |w| L for the turn, 2 u |w| L for two products and their sum.
/// - The difference of both, the squares and their comparison: shares of what is compared, below 16 u, as is what the
///   rows change of a length; of kTrianglePairMargin.
/// Together less than kTrianglePairUnits of (C + L): proved in test/proof/triangle_pairs.g. How far the flat triangle
/// is off as stored is triangle.error.
///
/// Within: some corner is within the sure reach, as squaredToTriangle() tells.
/// @param lanes those asked for. @param reach beyond which a lane is apart, with triangle.error and all that corners
/// may be off. @param sure_square what a corner's squared distance must not exceed (DistanceBand::hit). Negative:
/// `within` is not asked for
HWY_INLINE LanesVerdict compareWithTriangle(const FlatTriangle<float>& triangle, const LeafCorners& leaf,
                                            std::uint32_t lanes, float reach, float sure_square)
{
  const LaneTag d;
  const auto spread = [d](float value) HWY_ATTR { return hn::Set(d, value); };
  const float* rows = triangle.rows;
  const LaneVector zero = hn::Zero(d), length = spread(triangle.length), apex_x = spread(triangle.apex_x),
                   apex_y = spread(triangle.apex_y);
  LanesVerdict found;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
    const std::uint32_t block = firstBits(hn::Lanes(d)) << i;
    if ((lanes & block) == 0) continue;
    LaneVector x[3], y[3], z[3];
    LaneVector farthest = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      const LeafPoints& corner = leaf.corners[k];
      x[k] = hn::Sub(hn::Load(d, corner.x + i), spread(triangle.origin[0]));
      y[k] = hn::Sub(hn::Load(d, corner.y + i), spread(triangle.origin[1]));
      z[k] = hn::Sub(hn::Load(d, corner.z + i), spread(triangle.origin[2]));
      farthest = hn::Max(farthest, hn::Add(hn::Add(hn::Abs(x[k]), hn::Abs(y[k])), hn::Abs(z[k])));
    }
    // The length that a gap must exceed, for each unit of its direction.
    const LaneVector least =
        hn::Mul(hn::Add(hn::Mul(hn::Add(farthest, length), spread(kTrianglePairUnits * 0x1p-24f)), spread(reach)),
                spread(1.0f + kTrianglePairMargin));
    const LaneVector least_square = hn::Mul(least, least);
    auto apart = hn::Lt(zero, zero), within = apart;
    const auto consider = [&](LaneVector gap, LaneVector direction_square) HWY_ATTR {
      const auto beyond =
          hn::Gt(hn::Mul(gap, gap), hn::Add(hn::Mul(least_square, direction_square), spread(kVanishingSquare)));
      apart = hn::Or(apart, hn::And(beyond, hn::Gt(gap, zero)));
    };
    const auto dot = [&](LaneVector u, LaneVector v, LaneVector w, std::size_t k)
                         HWY_ATTR { return turned(u, v, w, x[k], y[k], z[k]); };
    const auto lowest = [&](LaneVector u, LaneVector v, LaneVector w)
                            HWY_ATTR { return hn::Min(hn::Min(dot(u, v, w, 0), dot(u, v, w, 1)), dot(u, v, w, 2)); };

    // Along the normal of the flat triangle: this decides most lanes.
    LaneVector on_z[3];
    for (std::size_t k = 0; k < 3; ++k) on_z[k] = dot(spread(rows[6]), spread(rows[7]), spread(rows[8]), k);
    consider(hn::Max(hn::Min(hn::Min(on_z[0], on_z[1]), on_z[2]), hn::Neg(hn::Max(hn::Max(on_z[0], on_z[1]), on_z[2]))),
             spread(1.0f));
    const auto in_range = hn::Lt(hn::Add(farthest, length), spread(0x1p40f)); // beyond, gaps may leave that of float
    const auto bitsIn = [&](auto mask) HWY_ATTR { return bitsOf(d, mask) << i & block; };
    std::uint32_t open = lanes & block & ~bitsIn(hn::And(apart, in_range));
    if (open == 0) {
      found.apart |= block;
      continue;
    }

    // From the flat triangle to each corner.
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = [&](std::size_t r) HWY_ATTR {
        return dot(spread(rows[3 * r]), spread(rows[3 * r + 1]), spread(rows[3 * r + 2]), k);
      };
      LaneVector best = spread(std::numeric_limits<float>::infinity()), best_x = zero, best_y = zero;
      beyondPlaces(triangle, spread, row(0), row(1), [&](LaneVector dx, LaneVector dy) HWY_ATTR {
        const LaneVector square = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
        const auto better = hn::Lt(square, best);
        best = hn::Min(best, square);
        best_x = hn::IfThenElse(better, dx, best_x);
        best_y = hn::IfThenElse(better, dy, best_y);
      });
      const LaneVector square = hn::Add(best, hn::Mul(on_z[k], on_z[k]));
      within = hn::Or(within, hn::Le(square, spread(sure_square)));
      const auto back = [&](std::size_t axis) HWY_ATTR {
        return turned(spread(rows[axis]), spread(rows[3 + axis]), spread(rows[6 + axis]), best_x, best_y, on_z[k]);
      };
      const LaneVector far_side =
          hn::Max(hn::Max(zero, hn::Mul(best_x, length)), hn::Add(hn::Mul(best_x, apex_x), hn::Mul(best_y, apex_y)));
      consider(hn::Sub(lowest(back(0), back(1), back(2)), far_side), square);
    }

    open &= ~bitsIn(apart) & ~bitsIn(within);
    if (open != 0) {
      const auto considerBoth = [&](LaneVector ux, LaneVector uy, LaneVector uz) HWY_ATTR { // along u, both ways
        const LaneVector on_x = turned(spread(rows[0]), spread(rows[1]), spread(rows[2]), ux, uy, uz),
                         on_y = turned(spread(rows[3]), spread(rows[4]), spread(rows[5]), ux, uy, uz);
        const LaneVector end = hn::Mul(on_x, length), apex = hn::Add(hn::Mul(on_x, apex_x), hn::Mul(on_y, apex_y));
        const LaneVector low = hn::Min(hn::Min(zero, end), apex), high = hn::Max(hn::Max(zero, end), apex);
        const LaneVector at[3] = {dot(ux, uy, uz, 0), dot(ux, uy, uz, 1), dot(ux, uy, uz, 2)};
        const LaneVector own_low = hn::Min(hn::Min(at[0], at[1]), at[2]),
                         own_high = hn::Max(hn::Max(at[0], at[1]), at[2]);
        consider(hn::Max(hn::Sub(own_low, high), hn::Sub(low, own_high)),
                 hn::Add(hn::Add(hn::Mul(ux, ux), hn::Mul(uy, uy)), hn::Mul(uz, uz)));
      };
      const auto considerAcross = [&](LaneVector ux, LaneVector uy, LaneVector uz, LaneVector vx, LaneVector vy,
                                      LaneVector vz) HWY_ATTR {
        considerBoth(hn::Sub(hn::Mul(uy, vz), hn::Mul(uz, vy)), hn::Sub(hn::Mul(uz, vx), hn::Mul(ux, vz)),
                     hn::Sub(hn::Mul(ux, vy), hn::Mul(uy, vx)));
      };
      const LaneVector ux = hn::Sub(x[1], x[0]), uy = hn::Sub(y[1], y[0]), uz = hn::Sub(z[1], z[0]);
      const LaneVector vx = hn::Sub(x[2], x[0]), vy = hn::Sub(y[2], y[0]), vz = hn::Sub(z[2], z[0]);
      considerAcross(ux, uy, uz, vx, vy, vz);
      if ((open & ~bitsIn(apart)) != 0) {
        const LaneVector wx = hn::Sub(x[2], x[1]), wy = hn::Sub(y[2], y[1]), wz = hn::Sub(z[2], z[1]);
        const LaneVector u = squaredNorm(ux, uy, uz), v = squaredNorm(vx, vy, vz), w = squaredNorm(wx, wy, wz);
        const auto longest = [&](LaneVector of_u, LaneVector of_v, LaneVector of_w) HWY_ATTR {
          return hn::IfThenElse(hn::Gt(w, hn::Max(u, v)), of_w, hn::IfThenElse(hn::Gt(v, u), of_v, of_u));
        };
        considerAcross(spread(rows[0]), spread(rows[1]), spread(rows[2]), longest(ux, vx, wx), longest(uy, vy, wy),
                       longest(uz, vz, wz));
      }
    }
    found.apart |= bitsIn(hn::And(apart, in_range));
    found.within |= bitsIn(within);
  }
  found.apart &= lanes;
  found.within &= lanes;
  return found;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
