// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/swept/object_motion.h>

namespace pcl_bsh {

ObjectMotion::ObjectMotion(const Leg& leg, const Box3& box)
: RigidMotion(leg.from, leg.to, leg.center, leg.turn),
  box_(box),
  radius_(box.empty() ? 0.0 : (box.half().norm() + (box.center() - leg.center).norm()) * (1.0 + kDoubleMargin))
{
}

Box3 ObjectMotion::swept() const
{
  Box3 box = moved(box_, from());
  box.merge(moved(box_, to()));
  if (turns() && !box_.empty()) {
    Box3 ball{worldPivot(), worldPivot()};
    ball.merge({worldPivot() + shift(), worldPivot() + shift()});
    ball.grow(radius_ * stretch() * (1.0 + kDoubleMargin) + rounding());
    box.merge(ball);
  }
  return box;
}

double ObjectMotion::rounding() const
{
  if (box_.empty()) return 0.0;
  constexpr double kPlaceRounding = 64 * kDoubleUnit; // of some dozen operations on these lengths
  return kPlaceRounding *
         (from().translation().norm() + to().translation().norm() + pivot().norm() + radius_ + speed());
}

} // namespace pcl_bsh
