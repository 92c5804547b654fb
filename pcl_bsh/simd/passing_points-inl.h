// SPDX-License-Identifier: BSD-3-Clause
// Points that move along segments, against points: when they are near, and how far away.

#if defined(PCL_BSH_SIMD_PASSING_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_PASSING_POINTS_INL_H_
#undef PCL_BSH_SIMD_PASSING_POINTS_INL_H_
#else
#define PCL_BSH_SIMD_PASSING_POINTS_INL_H_
#endif

#include <pcl_bsh/simd/segment_lanes-inl.h>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

// A rounded place at an instant: beside the 8 + 7 u of segment_lanes-inl.h, 3 u of twice the largest coordinate and of
// four times the bow. A point's shift and the gap to it have 3 u.
static_assert(1.7321 * (8 + 7 + 6 + 3) * kFloatUnit < kSegmentRounding);

/// Where an arc is at as many instants as there are lanes: step / steps, (step + 1) / steps, ...
struct PlacesOnArc {
  LaneVector x, y, z;

  /// @param steps 2^22 at most
  template <std::size_t Count>
  HWY_INLINE PlacesOnArc(const Segments<Count>& segments, std::uint32_t i, std::uint32_t step, float steps)
  {
    const LaneTag d;
    const LaneVector t = hn::Mul(hn::Iota(d, static_cast<float>(step)), hn::Set(d, steps > 0.0f ? 1.0f / steps : 0.0f));
    const auto along = [&](std::size_t axis) HWY_ATTR {
      const LaneVector none = hn::Zero(d);
      return placeOn(ArcLanes{hn::Set(d, segments.start[axis][i]), hn::Set(d, segments.motion[axis][i]), none,
                              hn::Set(d, segments.bow[axis][i]), none},
                     t);
    };
    x = along(0);
    y = along(1);
    z = along(2);
  }

  /// The squared distances from a box.
  HWY_INLINE LaneVector squaredDistance(const float* low, const float* high) const
  {
    const LaneTag d;
    const auto beside = [&](LaneVector place, std::size_t axis) HWY_ATTR {
      const LaneVector under = hn::Sub(hn::Set(d, low[axis]), place), over = hn::Sub(place, hn::Set(d, high[axis]));
      return hn::Max(hn::Max(under, over), hn::Zero(d));
    };
    return squaredNorm(beside(x, 0), beside(y, 1), beside(z, 2));
  }

  /// The squared distances from the nearest of `count` points, which are at (others + shift).
  HWY_INLINE LaneVector nearestSquared(const float* others_x, const float* others_y, const float* others_z,
                                       std::size_t count, const float* shift) const
  {
    const LaneTag d;
    const LaneVector from_x = hn::Sub(x, hn::Set(d, shift[0])), from_y = hn::Sub(y, hn::Set(d, shift[1])),
                     from_z = hn::Sub(z, hn::Set(d, shift[2]));
    LaneVector nearest = hn::Set(d, std::numeric_limits<float>::infinity());
    for (std::size_t j = 0; j < count; ++j)
      nearest = hn::Min(nearest,
                        squaredNorm(hn::Sub(from_x, hn::Set(d, others_x[j])), hn::Sub(from_y, hn::Set(d, others_y[j])),
                                    hn::Sub(from_z, hn::Set(d, others_z[j]))));
    return nearest;
  }
};

/// How a line passes points, one in each lane.
struct Passage {
  LaneVector at;      ///< the foot of the perpendicular, as a share of the way
  LaneVector squared; ///< squared distance from the line
  LaneVector left;    ///< the squared reach less `squared`

  auto isWithin() const { return hn::Ge(left, hn::Zero(LaneTag())); }
};

/// The line of a moving point, which may pass within a reach of other points.
class LineLanes {
public:
  /// @param smallest a shorter way is taken for rest. @param rounding in lengths
  HWY_INLINE LineLanes(const float (&first)[3], const float (&way)[3], float reach, float smallest, float rounding)
  {
    const LaneTag d;
    float length = std::sqrt((way[0] * way[0] + way[1] * way[1]) + way[2] * way[2]);
    const bool moves = length > smallest;
    if (!moves) length = smallest;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first_[axis] = hn::Set(d, first[axis]);
      way_[axis] = hn::Set(d, moves ? way[axis] : 0.0f);
    }
    inverse_ = hn::Set(d, 1.0f / length);
    slack_ = hn::Set(d, rounding / length);
    limit_ = hn::Set(d, reach * reach);
  }

  HWY_INLINE Passage past(LaneVector x, LaneVector y, LaneVector z) const
  {
    x = hn::Sub(x, first_[0]);
    y = hn::Sub(y, first_[1]);
    z = hn::Sub(z, first_[2]);
    const LaneVector along = hn::Add(hn::Add(hn::Mul(x, way_[0]), hn::Mul(y, way_[1])), hn::Mul(z, way_[2]));
    const LaneVector at = hn::Mul(hn::Mul(along, inverse_), inverse_);
    const LaneVector squared = squaredNorm(hn::Sub(x, hn::Mul(at, way_[0])), hn::Sub(y, hn::Mul(at, way_[1])),
                                           hn::Sub(z, hn::Mul(at, way_[2])));
    return {at, squared, hn::Sub(limit_, squared)};
  }

  /// Half of the part of the way that is within the reach.
  HWY_INLINE LaneVector halfStay(const Passage& by) const
  {
    return hn::Add(hn::Mul(hn::Sqrt(hn::Max(by.left, hn::Zero(LaneTag()))), inverse_), slack_);
  }

private:
  LaneVector first_[3], way_[3], inverse_, slack_, limit_;
};

/// How one straight segment passes points.
template <std::size_t Count>
struct Passages {
  std::uint32_t near;               ///< points within the reach, as bits
  alignas(64) float squared[Count]; ///< squared distance from the line of the segment
  alignas(64) float enter[Count];   ///< the part of its way before which it is not within the reach

  /// The points in `points` with `enter` before a part of the way, or with `squared` at most `squared_limit`.
  HWY_INLINE std::uint32_t before(std::uint32_t points, float part, float squared_limit) const
  {
    const LaneTag d;
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < Count; j += hn::Lanes(d))
      bits |= bitsOf(d, hn::Or(hn::Lt(hn::Load(d, enter + j), hn::Set(d, part)),
                               hn::Le(hn::Load(d, squared + j), hn::Set(d, squared_limit))))
              << j;
    return points & bits;
  }
};

/// The chord of arc i, without its bow, past `count` points at (x, y, z) + shift.
/// @param x, y, z readable for whole vectors. @param rounding in lengths: what that may amount to, at least 64 u of the
///   largest coordinate
/// @param reach any, `rounding` included
template <std::size_t Count>
HWY_INLINE void passPoints(const Segments<Count>& segments, std::uint32_t i, const float* x, const float* y,
                           const float* z, std::size_t count, const float* shift, float reach, float smallest,
                           float rounding, Passages<Count>& passages)
{
  const LaneTag d;
  const LaneVector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const float first[3] = {segments.start[0][i] - shift[0], segments.start[1][i] - shift[1],
                          segments.start[2][i] - shift[2]};
  const float way[3] = {segments.motion[0][i], segments.motion[1][i], segments.motion[2][i]};
  const LineLanes line(first, way, reach, smallest, rounding);
  passages.near = 0;
  for (std::size_t j = 0; j < count; j += hn::Lanes(d)) {
    const Passage by = line.past(hn::LoadU(d, x + j), hn::LoadU(d, y + j), hn::LoadU(d, z + j));
    const LaneVector half = line.halfStay(by), enter = hn::Sub(by.at, half), leave = hn::Add(by.at, half);
    hn::Store(by.squared, d, passages.squared + j);
    hn::Store(enter, d, passages.enter + j);
    passages.near |= bitsOf(d, hn::And(hn::And(hn::FirstN(d, count - j), by.isWithin()),
                                       hn::And(hn::Le(enter, one), hn::Ge(leave, zero))))
                     << j;
  }
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
