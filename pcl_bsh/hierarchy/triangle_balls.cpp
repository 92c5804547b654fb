// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/triangle_balls.h>

#include <pcl_bsh/geometry/rounding.h>

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/hierarchy/triangle_balls.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void findEightBallsOnTarget(EightBalls& balls, bool to_float)
{
  const hn::CappedTag<double, kBallsTogether> d;
  const hn::Rebind<float, decltype(d)> df;
  using Vector = hn::Vec<decltype(d)>;
  struct Place {
    Vector x, y, z;
  };
  const auto squared = [](const Place& p, const Place& q) HWY_ATTR {
    const Vector x = hn::Sub(p.x, q.x), y = hn::Sub(p.y, q.y), z = hn::Sub(p.z, q.z);
    return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
  };
  const Vector one = hn::Set(d, 1.0), zero = hn::Zero(d);
  const auto isNormal = [&](Vector v) HWY_ATTR {
    return hn::And(hn::Ge(v, hn::Set(d, std::numeric_limits<double>::min())),
                   hn::Le(v, hn::Set(d, std::numeric_limits<double>::max())));
  };
  Vector largest = zero;
  for (std::size_t i = 0; i < kBallsTogether; i += hn::Lanes(d)) {
    const auto corner = [&](std::size_t c) HWY_ATTR {
      const auto& at = balls.corners[c];
      return Place{hn::LoadU(d, at[0] + i), hn::LoadU(d, at[1] + i), hn::LoadU(d, at[2] + i)};
    };
    const Place corners[3] = {corner(0), corner(1), corner(2)};
    Vector a = squared(corners[1], corners[2]), b = squared(corners[2], corners[0]),
           c = squared(corners[0], corners[1]);
    const Vector longest = hn::Max(hn::Max(a, b), c), of_longest = hn::Div(one, longest);
    a = hn::Mul(a, of_longest), b = hn::Mul(b, of_longest), c = hn::Mul(c, of_longest);
    Vector wa = hn::Mul(a, hn::Sub(hn::Add(b, c), a)), wb = hn::Mul(b, hn::Sub(hn::Add(c, a), b)),
           wc = hn::Mul(c, hn::Sub(hn::Add(a, b), c));
    const auto acute = hn::Gt(hn::Min(hn::Min(wa, wb), wc), hn::Set(d, 0x1p-900));
    const Vector most = hn::Max(hn::Max(a, b), c);
    const auto faces_a = hn::Eq(a, most), faces_b = hn::AndNot(faces_a, hn::Eq(b, most));
    wa = hn::IfThenElse(acute, wa, hn::IfThenElse(faces_a, zero, one));
    wb = hn::IfThenElse(acute, wb, hn::IfThenElse(faces_b, zero, one));
    wc = hn::IfThenElse(acute, wc, hn::IfThenElse(hn::Or(faces_a, faces_b), one, zero));
    const Vector unit = hn::Div(one, hn::Add(hn::Add(wa, wb), wc));
    wa = hn::Mul(wa, unit), wb = hn::Mul(wb, unit), wc = hn::Mul(wc, unit);
    const auto middle = [&](Vector p, Vector q, Vector r) HWY_ATTR {
      const Vector at = hn::Add(hn::Add(hn::Mul(p, wa), hn::Mul(q, wb)), hn::Mul(r, wc));
      return to_float ? hn::PromoteTo(d, hn::DemoteTo(df, at)) : at;
    };
    const Place center = {middle(corners[0].x, corners[1].x, corners[2].x),
                          middle(corners[0].y, corners[1].y, corners[2].y),
                          middle(corners[0].z, corners[1].z, corners[2].z)};
    const Vector reach =
        hn::Max(hn::Max(squared(corners[0], center), squared(corners[1], center)), squared(corners[2], center));
    const auto known = hn::And(isNormal(longest), isNormal(reach));
    hn::StoreU(center.x, d, balls.centers[0] + i);
    hn::StoreU(center.y, d, balls.centers[1] + i);
    hn::StoreU(center.z, d, balls.centers[2] + i);
    for (const Place& p : corners) {
      const Vector size = hn::Max(hn::Max(hn::Abs(p.x), hn::Abs(p.y)), hn::Abs(p.z));
      largest = hn::Max(largest, hn::IfThenElseZero(known, size));
    }
    double radii[kBallsTogether];
    const Vector radius = hn::Mul(hn::Sqrt(reach), hn::Set(d, 1.0 + kFewDoubleRoundings));
    hn::StoreU(hn::IfThenElse(known, radius, hn::Set(d, std::numeric_limits<double>::quiet_NaN())), d, radii);
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) balls.radii[i + k] = roundUp(radii[k]);
  }
  balls.largest = hn::GetLane(hn::MaxOfLanes(d, largest));
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(findEightBallsOnTarget);

void findEightBalls(EightBalls& balls, bool to_float)
{
  HWY_DYNAMIC_DISPATCH(findEightBallsOnTarget)(balls, to_float);
}

} // namespace pcl_bsh
#endif
