// SPDX-License-Identifier: BSD-3-Clause
// Points that move along segments, against boxes: when they are inside.

#if defined(PCL_BSH_SIMD_SEGMENT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_SEGMENT_LANES_INL_H_
#undef PCL_BSH_SIMD_SEGMENT_LANES_INL_H_
#else
#define PCL_BSH_SIMD_SEGMENT_LANES_INL_H_
#endif

#include <pcl_bsh/simd/sphere_lanes-inl.h>

#include <algorithm>
#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Arcs from start to end: at t from 0 to 1 on the parabola start + t motion + 4 t (1 - t) bow. Each is tested against
/// boxes widened by a reach of its own. The caller adds rounding (kSegmentRounding) to the reach, which also covers
/// that a motion below `smallest` is taken for one of `smallest`.
/// @tparam Reaches 3: along each axis another, 1: the same along all.
template <std::size_t Count, std::size_t Reaches = 1>
struct Segments {
  alignas(64) float inverse[3][Count]; ///< of the motion
  alignas(64) float start[3][Count];
  alignas(64) float motion[3][Count]; ///< end - start
  alignas(64) float bow[3][Count];
  alignas(64) float reach[Reaches][Count];
  float ball = 0.0f; ///< with three reaches: what they have in common, a distance in all directions

  HWY_INLINE void set(const float (&from)[3][Count], const float (&to)[3][Count], const float (&bows)[3][Count],
                      float smallest)
  {
    const LaneTag d;
    const LaneVector least = hn::Set(d, smallest), one = hn::Set(d, 1.0f);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < Count; i += hn::Lanes(d)) {
        const LaneVector first = hn::Load(d, from[axis] + i);
        const LaneVector way = hn::Sub(hn::Load(d, to[axis] + i), first);
        hn::Store(first, d, start[axis] + i);
        hn::Store(way, d, motion[axis] + i);
        hn::Store(hn::Load(d, bows[axis] + i), d, bow[axis] + i);
        hn::Store(hn::Div(one, hn::CopySign(hn::Max(hn::Abs(way), least), way)), d, inverse[axis] + i);
      }
  }
};

static_assert(2 * kCarriedProductError + (2 + 2 + 2 * 6) * kFloatUnit < kSegmentRounding);

// A place on the parabola: 8 u of the largest coordinate for its start, middle and end carried. The parabola's products
// and sums take 7 u, the gap to a box 4 u, on each of three axes: less than 40 u of the 64. The bow has less than 32 u
// on each axis; the caller counts it eightfold.
static_assert(1.7321 * (8 + 7 + 4) * kFloatUnit < kSegmentRounding && 1.7321 * 32 * kFloatUnit < 8 * kSegmentRounding);

/// When a segment is in a box: a part of [0, 1].
template <std::size_t Count>
struct ClippedSegments {
  alignas(64) float from[Count];
  alignas(64) float to[Count];
};

struct ClippedLanes {
  LaneVector from, to;
};

/// Some arcs along one axis.
struct ArcLanes {
  LaneVector start, motion, inverse, bow, reach;
};

/// Clips an arc by its chord: where the arc is in the widened box, the chord is in that box widened by the bow, too.
HWY_INLINE void clipAxis(const ArcLanes& arc, LaneVector low, LaneVector high, ClippedLanes& clip)
{
  const LaneTag d;
  const LaneVector zero = hn::Zero(d);
  const LaneVector under = hn::Add(arc.reach, hn::Max(arc.bow, zero)),
                   over = hn::Sub(arc.reach, hn::Min(arc.bow, zero));
  const LaneVector at_low = hn::Mul(hn::Sub(low, hn::Add(arc.start, under)), arc.inverse);
  const LaneVector at_high = hn::Mul(hn::Sub(high, hn::Sub(arc.start, over)), arc.inverse);
  clip.from = hn::Max(clip.from, hn::Min(at_low, at_high));
  clip.to = hn::Min(clip.to, hn::Max(at_low, at_high));
}

HWY_INLINE LaneVector placeOn(const ArcLanes& arc, LaneVector t)
{
  const LaneTag d;
  const LaneVector bent = hn::Mul(hn::Mul(hn::Set(d, 4.0f), arc.bow), hn::Sub(hn::Set(d, 1.0f), t));
  return hn::Add(arc.start, hn::Mul(t, hn::Add(arc.motion, bent)));
}

/// A lower bound of the distance of an arc's clipped part from a box along an axis, less (reach - ball). The bow of the
/// part is the arc's bow times the square of the part's share.
HWY_INLINE LaneVector gapToBox(const ArcLanes& arc, LaneVector ball, LaneVector low, LaneVector high,
                               const ClippedLanes& clip)
{
  const LaneTag d;
  const LaneVector zero = hn::Zero(d), extent = hn::Sub(arc.reach, ball);
  const LaneVector first = placeOn(arc, clip.from), last = placeOn(arc, clip.to), part = hn::Sub(clip.to, clip.from);
  const LaneVector bow = hn::Mul(arc.bow, hn::Mul(part, part));
  const LaneVector least = hn::Add(hn::Min(first, last), hn::Sub(hn::Min(bow, zero), extent));
  const LaneVector most = hn::Add(hn::Max(first, last), hn::Add(hn::Max(bow, zero), extent));
  return hn::Max(hn::Max(hn::Sub(low, most), hn::Sub(least, high)), zero);
}

/// Whether a clipped part contains one of the instants i / steps; always where steps are too many for floats to tell.
HWY_INLINE auto isInsideAtStep(LaneTag d, const ClippedLanes& clip, float steps)
{
  const LaneVector scale = hn::Set(d, steps), slack = hn::Set(d, steps * kStepRounding);
  const LaneVector first = hn::Ceil(hn::Sub(hn::Mul(clip.from, scale), slack));
  const LaneVector last = hn::Floor(hn::Add(hn::Mul(clip.to, scale), slack));
  return hn::And(hn::Le(clip.from, clip.to), hn::Le(first, last));
}

/// Bits of the lanes of arcs that may be in boxes at an instant j / steps; at any instant when steps is 0.
template <class ArcAt, class LowAt, class HighAt>
HWY_INLINE std::uint32_t arcsInBoxes(const ArcAt& arc, LaneVector ball, const LowAt& low, const HighAt& high,
                                     float steps, ClippedLanes& clip)
{
  const LaneTag d;
  clip = {hn::Zero(d), hn::Set(d, 1.0f)};
  for (std::size_t axis = 0; axis < 3; ++axis) clipAxis(arc(axis), low(axis), high(axis), clip);
  const std::uint32_t bits = bitsOf(d, isInsideAtStep(d, clip, steps));
  if (bits == 0) return 0;
  const LaneVector squared =
      squaredNorm(gapToBox(arc(0), ball, low(0), high(0), clip), gapToBox(arc(1), ball, low(1), high(1), clip),
                  gapToBox(arc(2), ball, low(2), high(2), clip));
  return bits & bitsOf(d, hn::Le(squared, hn::Add(hn::Mul(ball, ball), hn::Set(d, kVanishingSquare))));
}

/// Bit i: segment i may be in the box at an instant j / steps; at any instant when steps is 0.
template <std::size_t Count, std::size_t Reaches>
HWY_INLINE std::uint32_t segmentsInBox(const Segments<Count, Reaches>& segments, const float* low, const float* high,
                                       float steps, ClippedSegments<Count>* clipped)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < Count; i += hn::Lanes(d)) {
    ClippedLanes clip;
    bits |= arcsInBoxes(
                [&](std::size_t axis) HWY_ATTR {
                  return ArcLanes{hn::Load(d, segments.start[axis] + i), hn::Load(d, segments.motion[axis] + i),
                                  hn::Load(d, segments.inverse[axis] + i), hn::Load(d, segments.bow[axis] + i),
                                  hn::Load(d, segments.reach[axis % Reaches] + i)};
                },
                Reaches == 1 ? hn::Load(d, segments.reach[0] + i) : hn::Set(d, segments.ball),
                [&](std::size_t axis) HWY_ATTR { return hn::Set(d, low[axis]); },
                [&](std::size_t axis) HWY_ATTR { return hn::Set(d, high[axis]); }, steps, clip)
            << i;
    if (clipped) {
      hn::Store(clip.from, d, clipped->from + i);
      hn::Store(clip.to, d, clipped->to + i);
    }
  }
  return bits;
}

/// One segment, with a reach along each axis.
struct Segment {
  float start[3], motion[3], inverse[3], bow[3], reach[3], ball;
};

/// Bit i: the segment may be in box i of eight at an instant j / steps. @param low, high 3 x 8 floats.
HWY_INLINE std::uint32_t boxesOnSegment(const Segment& segment, const float (*low)[kLanes], const float (*high)[kLanes],
                                        float steps)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    ClippedLanes clip;
    bits |= arcsInBoxes(
                [&](std::size_t axis) HWY_ATTR {
                  return ArcLanes{hn::Set(d, segment.start[axis]), hn::Set(d, segment.motion[axis]),
                                  hn::Set(d, segment.inverse[axis]), hn::Set(d, segment.bow[axis]),
                                  hn::Set(d, segment.reach[axis])};
                },
                hn::Set(d, segment.ball), [&](std::size_t axis) HWY_ATTR { return hn::Load(d, low[axis] + i); },
                [&](std::size_t axis) HWY_ATTR { return hn::Load(d, high[axis] + i); }, steps, clip)
            << i;
  }
  return bits;
}

/// Bit j: arc i may be in box j of eight at an instant k / steps, during the clipped part. @param low, high 3 x 8
/// floats.
template <std::size_t Count>
HWY_INLINE std::uint32_t boxesOnArc(const Segments<Count>& segments, std::uint32_t i, const float (*low)[kLanes],
                                    const float (*high)[kLanes], float steps, ClippedSegments<kLanes>& clipped)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t j = 0; j < kLanes; j += hn::Lanes(d)) {
    ClippedLanes clip;
    const LaneVector reach = hn::Set(d, segments.reach[0][i]);
    bits |= arcsInBoxes(
                [&](std::size_t axis) HWY_ATTR {
                  return ArcLanes{hn::Set(d, segments.start[axis][i]), hn::Set(d, segments.motion[axis][i]),
                                  hn::Set(d, segments.inverse[axis][i]), hn::Set(d, segments.bow[axis][i]), reach};
                },
                reach, [&](std::size_t axis) HWY_ATTR { return hn::Load(d, low[axis] + j); },
                [&](std::size_t axis) HWY_ATTR { return hn::Load(d, high[axis] + j); }, steps, clip)
            << j;
    hn::Store(clip.from, d, clipped.from + j);
    hn::Store(clip.to, d, clipped.to + j);
  }
  return bits;
}

/// Bit i: point i of `count`, a multiple of the lanes, is within its limit of the box, in squared distances.
HWY_INLINE std::uint32_t pointsNearBox(const float* x, const float* y, const float* z, std::size_t count,
                                       const float* low, const float* high, const float* squared_limits)
{
  const LaneTag d;
  const auto beside = [&](const float* at, std::size_t axis) {
    const LaneVector place = hn::Load(d, at);
    const LaneVector under = hn::Sub(hn::Set(d, low[axis]), place), over = hn::Sub(place, hn::Set(d, high[axis]));
    return hn::Max(hn::Max(under, over), hn::Zero(d));
  };
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    bits |= bitsOf(d, hn::Le(squaredNorm(beside(x + i, 0), beside(y + i, 1), beside(z + i, 2)),
                             hn::Load(d, squared_limits + i)))
            << i;
  return bits;
}

/// Bit i: box i of eight comes within its limit of the box [low, high], in squared distances.
HWY_INLINE std::uint32_t boxesNearBox(const float (*lows)[kLanes], const float (*highs)[kLanes], const float* low,
                                      const float* high, const float* squared_limits)
{
  const LaneTag d;
  const auto apart = [&](std::size_t axis, std::size_t i) {
    const LaneVector under = hn::Sub(hn::Set(d, low[axis]), hn::Load(d, highs[axis] + i));
    const LaneVector over = hn::Sub(hn::Load(d, lows[axis] + i), hn::Set(d, high[axis]));
    return hn::Max(hn::Max(under, over), hn::Zero(d));
  };
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
    bits |= bitsOf(d, hn::Le(squaredNorm(apart(0, i), apart(1, i), apart(2, i)), hn::Load(d, squared_limits + i))) << i;
  return bits;
}

/// Lowers `least` of eight points to the squared distance to the farthest corner of a box, where that is less.
HWY_INLINE void lowerToFarthestCorner(const float (*places)[kLanes], const float* low, const float* high, float* least)
{
  const LaneTag d;
  const auto away = [&](std::size_t axis, std::size_t i) {
    const LaneVector at = hn::Load(d, places[axis] + i);
    return hn::Max(hn::Sub(at, hn::Set(d, low[axis])), hn::Sub(hn::Set(d, high[axis]), at));
  };
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
    hn::Store(hn::Min(hn::Load(d, least + i), squaredNorm(away(0, i), away(1, i), away(2, i))), d, least + i);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
