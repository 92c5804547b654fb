// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/manifold/parting.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/manifold/collider_parts.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/solid/labels.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pcl_bsh {
namespace {

void checkWay(const std::string& name, double way)
{
  if (std::isfinite(way) && way > 0.0) return;
  throw InvalidInput(Input::clearance, name, std::to_string(way), "give a finite length above 0").withValue(way);
}

bool areMet(const PlacedCollider& a, const PlacedCollider& b)
{
  const Collider::Parts &of_a = a.collider->parts(), &of_b = b.collider->parts();
  if (anyCollision({of_a.thing, a.pose}, {of_b.thing, b.pose}, AnyRequest()).verdict == Verdict::colliding) return true;
  return (of_b.solid && anyInside({of_a.places(), a.pose}, {*of_b.solid, b.pose})) ||
         (of_a.solid && anyInside({of_b.places(), b.pose}, {*of_a.solid, a.pose}));
}

/// The depth of the deepest place of one in the other.
double depthOf(const PlacedCollider& a, const PlacedCollider& b)
{
  ManifoldRequest request;
  request.thickness = 0.0;
  request.most = request.most_patches = 1;
  const Manifold deepest = contactManifold(a, b, request);
  return deepest.contacts.empty() ? 0.0 : std::max(0.0, -deepest.contacts.front().distance);
}

} // namespace

Interval partingOf(const PlacedCollider& a, const PlacedCollider& b, const Contact& contact, double tolerance,
                   double most)
{
  constexpr int most_steps = 200;
  constexpr double rounding = 1e-12;
  checkPoses(a.pose, b.pose);
  checkWay("tolerance", tolerance);
  checkWay("longest way", most);
  if (!a.collider->parts().solid && !b.collider->parts().solid)
    throw InvalidInput(Input::surface, "bodies", "neither is a solid", "give a solid to the collider of one");
  const auto after = [&](double way) {
    PlacedCollider moved = a;
    moved.pose.pretranslate(way * contact.normal);
    return moved;
  };
  double met = 0.0;
  for (int i = 0; i < most_steps && met < most; ++i) {
    const double depth = depthOf(after(met), b) * (1.0 - rounding);
    if (!(depth > rounding * (met + tolerance))) break;
    met += depth;
    if (depth < 0.25 * tolerance) break;
  }
  const double lower = met;
  if (!areMet(after(lower), b)) return {lower * (1.0 - rounding), lower};
  double apart = lower;
  for (double step = tolerance; apart <= most; step *= 2.0) {
    apart = lower + step;
    if (!areMet(after(apart), b)) break;
    met = apart;
  }
  if (apart > most) return {lower, std::numeric_limits<double>::infinity()};
  while (apart - met > tolerance) {
    const double middle = 0.5 * (met + apart);
    (areMet(after(middle), b) ? met : apart) = middle;
  }
  return {lower, apart};
}

} // namespace pcl_bsh
