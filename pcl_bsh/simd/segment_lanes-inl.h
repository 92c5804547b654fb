// SPDX-License-Identifier: BSD-3-Clause
// Points that move along segments, against boxes and points: when they are inside, or near.

#if defined(PCL_BSH_SIMD_SEGMENT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_SEGMENT_LANES_INL_H_
#undef PCL_BSH_SIMD_SEGMENT_LANES_INL_H_
#else
#define PCL_BSH_SIMD_SEGMENT_LANES_INL_H_
#endif

#include <pcl_bsh/simd/sphere_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Segments from start to end, each to be tested against boxes that are widened by a reach of its own. The caller pays
/// for rounding in the reach, also for taking a motion for one of `smallest` that is smaller (kSegmentRounding).
/// @tparam Reaches 3: along each axis another, 1: the same along all.
template <std::size_t Count, std::size_t Reaches = 1>
struct Segments {
  alignas(64) float inverse[3][Count]; ///< of end - start
  alignas(64) float start[3][Count];
  alignas(64) float reach[Reaches][Count];

  HWY_INLINE void set(const float (&from)[3][Count], const float (&to)[3][Count], float smallest)
  {
    const LaneTag d;
    const LaneVector least = hn::Set(d, smallest), one = hn::Set(d, 1.0f);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < Count; i += hn::Lanes(d)) {
        const LaneVector first = hn::Load(d, from[axis] + i);
        const LaneVector motion = hn::Sub(hn::Load(d, to[axis] + i), first);
        hn::Store(first, d, start[axis] + i);
        hn::Store(hn::Div(one, hn::CopySign(hn::Max(hn::Abs(motion), least), motion)), d, inverse[axis] + i);
      }
  }
};

static_assert(2 * kCarriedProductError + (2 + 2 + 2 * 6) * kFloatUnit < kSegmentRounding);

/// When a segment is in a box: a part of [0, 1].
template <std::size_t Count>
struct ClippedSegments {
  alignas(64) float from[Count];
  alignas(64) float to[Count];
};

struct ClippedLanes {
  LaneVector from, to;
};

HWY_INLINE void clipAxis(LaneVector start, LaneVector inverse, LaneVector reach, LaneVector low, LaneVector high,
                         ClippedLanes& clip)
{
  const LaneVector at_low = hn::Mul(hn::Sub(low, hn::Add(start, reach)), inverse);
  const LaneVector at_high = hn::Mul(hn::Sub(high, hn::Sub(start, reach)), inverse);
  clip.from = hn::Max(clip.from, hn::Min(at_low, at_high));
  clip.to = hn::Min(clip.to, hn::Max(at_low, at_high));
}

/// Whether a clipped part contains one of the instants i / steps; always where steps are too many for floats to tell.
HWY_INLINE std::uint32_t isInsideAtStep(LaneTag d, const ClippedLanes& clip, float steps)
{
  const LaneVector scale = hn::Set(d, steps), slack = hn::Set(d, steps * kStepRounding);
  const LaneVector first = hn::Ceil(hn::Sub(hn::Mul(clip.from, scale), slack));
  const LaneVector last = hn::Floor(hn::Add(hn::Mul(clip.to, scale), slack));
  return bitsOf(d, hn::And(hn::Le(clip.from, clip.to), hn::Le(first, last)));
}

/// Bit i: segment i may be in the box at an instant j / steps; at any instant when steps is 0.
template <std::size_t Count, std::size_t Reaches>
HWY_INLINE std::uint32_t segmentsInBox(const Segments<Count, Reaches>& segments, const float* low, const float* high,
                                       float steps, ClippedSegments<Count>* clipped)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < Count; i += hn::Lanes(d)) {
    ClippedLanes clip{hn::Zero(d), hn::Set(d, 1.0f)};
    for (std::size_t axis = 0; axis < 3; ++axis)
      clipAxis(hn::Load(d, segments.start[axis] + i), hn::Load(d, segments.inverse[axis] + i),
               hn::Load(d, segments.reach[axis % Reaches] + i), hn::Set(d, low[axis]), hn::Set(d, high[axis]), clip);
    bits |= isInsideAtStep(d, clip, steps) << i;
    if (clipped) {
      hn::Store(clip.from, d, clipped->from + i);
      hn::Store(clip.to, d, clipped->to + i);
    }
  }
  return bits;
}

/// One segment, with a reach along each axis.
struct Segment {
  float start[3], inverse[3], reach[3];
};

/// Bit i: the segment may be in box i of eight at an instant j / steps. @param low, high 3 x 8 floats.
HWY_INLINE std::uint32_t boxesOnSegment(const Segment& segment, const float (*low)[kLanes], const float (*high)[kLanes],
                                        float steps)
{
  const LaneTag d;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    ClippedLanes clip{hn::Zero(d), hn::Set(d, 1.0f)};
    for (std::size_t axis = 0; axis < 3; ++axis)
      clipAxis(hn::Set(d, segment.start[axis]), hn::Set(d, segment.inverse[axis]), hn::Set(d, segment.reach[axis]),
               hn::Load(d, low[axis] + i), hn::Load(d, high[axis] + i), clip);
    bits |= isInsideAtStep(d, clip, steps) << i;
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

/// Of eight points, the squared distance to the farthest corner of a box, where that is less than `least`.
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

/// The motions of the same segments, for tests against points.
template <std::size_t Count>
struct SegmentMotions {
  alignas(64) float motion[3][Count];
  alignas(64) float inverse_length[Count]; ///< of the motion, or of `smallest` where that is longer
  float rounding; ///< in lengths: what it may amount to, at least 64 u of the largest coordinate

  HWY_INLINE void set(const float (&from)[3][Count], const float (&to)[3][Count], float smallest, float rounded)
  {
    const LaneTag d;
    rounding = rounded;
    for (std::size_t i = 0; i < Count; i += hn::Lanes(d)) {
      const LaneVector x = hn::Sub(hn::Load(d, to[0] + i), hn::Load(d, from[0] + i));
      const LaneVector y = hn::Sub(hn::Load(d, to[1] + i), hn::Load(d, from[1] + i));
      const LaneVector z = hn::Sub(hn::Load(d, to[2] + i), hn::Load(d, from[2] + i));
      const LaneVector length = hn::Sqrt(squaredNorm(x, y, z)), least = hn::Set(d, smallest);
      const auto moves = hn::Gt(length, least);
      hn::Store(hn::IfThenElseZero(moves, x), d, motion[0] + i);
      hn::Store(hn::IfThenElseZero(moves, y), d, motion[1] + i);
      hn::Store(hn::IfThenElseZero(moves, z), d, motion[2] + i);
      hn::Store(hn::Div(hn::Set(d, 1.0f), hn::Max(length, least)), d, inverse_length + i);
    }
  }
};

/// Bit i: segment i may come within its reach of one of `count` points, at (x, y, z) + shift.
/// @param clipped when that is: from the first instant for any of the points to the last; of lanes whose bit is set.
template <std::size_t Count>
HWY_INLINE std::uint32_t segmentsNearPoints(const Segments<Count>& segments, const SegmentMotions<Count>& motions,
                                            const float* x, const float* y, const float* z, std::size_t count,
                                            const float* shift, ClippedSegments<Count>& clipped)
{
  const LaneTag d;
  const LaneVector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < Count; i += hn::Lanes(d)) {
    const LaneVector mx = hn::Load(d, motions.motion[0] + i), my = hn::Load(d, motions.motion[1] + i),
                     mz = hn::Load(d, motions.motion[2] + i), inverse = hn::Load(d, motions.inverse_length + i);
    const LaneVector sx = hn::Sub(hn::Load(d, segments.start[0] + i), hn::Set(d, shift[0]));
    const LaneVector sy = hn::Sub(hn::Load(d, segments.start[1] + i), hn::Set(d, shift[1]));
    const LaneVector sz = hn::Sub(hn::Load(d, segments.start[2] + i), hn::Set(d, shift[2]));
    const LaneVector reach = hn::Add(hn::Load(d, segments.reach[0] + i), hn::Set(d, motions.rounding));
    const LaneVector limit = hn::Mul(reach, reach);
    const LaneVector slack = hn::Mul(hn::Set(d, motions.rounding), inverse);
    LaneVector from = one, to = zero;
    for (std::size_t j = 0; j < count; ++j) {
      const LaneVector wx = hn::Sub(hn::Set(d, x[j]), sx), wy = hn::Sub(hn::Set(d, y[j]), sy),
                       wz = hn::Sub(hn::Set(d, z[j]), sz);
      const LaneVector along = hn::Add(hn::Add(hn::Mul(wx, mx), hn::Mul(wy, my)), hn::Mul(wz, mz));
      const LaneVector at = hn::Mul(hn::Mul(along, inverse), inverse);
      const LaneVector left = hn::Sub(
          limit, squaredNorm(hn::Sub(wx, hn::Mul(at, mx)), hn::Sub(wy, hn::Mul(at, my)), hn::Sub(wz, hn::Mul(at, mz))));
      const LaneVector half = hn::Add(hn::Mul(hn::Sqrt(hn::Max(left, zero)), inverse), slack);
      const auto near = hn::Ge(left, zero);
      from = hn::Min(from, hn::IfThenElse(near, hn::Sub(at, half), one));
      to = hn::Max(to, hn::IfThenElse(near, hn::Add(at, half), zero));
    }
    from = hn::Max(from, zero);
    to = hn::Min(to, one);
    hn::Store(from, d, clipped.from + i);
    hn::Store(to, d, clipped.to + i);
    bits |= bitsOf(d, hn::Le(from, to)) << i;
  }
  return bits;
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
