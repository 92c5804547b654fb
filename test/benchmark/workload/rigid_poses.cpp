// SPDX-License-Identifier: BSD-3-Clause
#include "rigid_poses.h"

#include "random.h"

namespace pcl_bsh::bench {
namespace {

/// From a uniform random unit quaternion (four bell-shaped numbers, normalised).
std::array<double, 9> randomRotation(Random& random)
{
  double w = random.bell(), x = random.bell(), y = random.bell(), z = random.bell();
  const double n = std::sqrt(w * w + x * x + y * y + z * z);
  w /= n, x /= n, y /= n, z /= n;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

/// One approach: b turned once, then moved along a line through a's origin.
class Approach {
public:
  Approach(const ReferenceTree& a, const ReferenceTree& b, Random& random)
  : a_(a),
    b_(b),
    rotation_(randomRotation(random)),
    direction_(random.direction())
  {
  }

  RigidPose at(double t) const { return {rotation_, {direction_[0] * t, direction_[1] * t, direction_[2] * t}}; }

  double distance(double t) const { return a_.distance(b_, at(t)); }

  /// Where, coming from afar, the distance first is `wanted`, to within `tolerance`. Moving by t changes the distance
  /// by at most t, so steps of what is left never overshoot; halving the rest of the way starts once they get short.
  double whereDistanceIs(double wanted, double tolerance) const
  {
    double outside = a_.reach() + b_.reach() + wanted, gap = distance(outside);
    double inside = outside;
    for (double step = gap - wanted; step > tolerance; step = gap - wanted) {
      const double leap = outside - 2.0 * step; // a guess that often lands inside and brackets the place
      const double there = distance(leap);
      if (there > wanted) {
        outside = leap;
        gap = there;
      }
      else {
        outside -= step;
        gap = distance(outside);
        inside = leap;
        break;
      }
    }
    while (gap - wanted > tolerance && outside - inside > 0.01 * tolerance) {
      const double middle = 0.5 * (outside + inside), there = distance(middle);
      if (there > wanted) {
        outside = middle;
        gap = there;
      }
      else {
        inside = middle;
      }
    }
    return outside;
  }

private:
  const ReferenceTree& a_;
  const ReferenceTree& b_;
  std::array<double, 9> rotation_;
  std::array<double, 3> direction_;
};

} // namespace

std::vector<PosedCase> rigidPoses(const ReferenceTree& a, const ReferenceTree& b, double spacing, std::size_t count,
                                  std::uint64_t seed)
{
  constexpr PoseClass kClasses[] = {PoseClass::hit, PoseClass::near_miss, PoseClass::far};
  Random random(seed);
  std::vector<PosedCase> cases;
  while (cases.size() < count) {
    const PoseClass kind = kClasses[cases.size() % 3];
    const Approach approach(a, b, random);
    double t = 0.0;
    switch (kind) {
    case PoseClass::near_miss:
      t = approach.whereDistanceIs(random.uniform(1.3, 4.0) * spacing, 0.01 * spacing);
      break;
    case PoseClass::hit: // from just touching to deep inside
      t = approach.whereDistanceIs(0.9 * spacing, 0.05 * spacing) * (1.0 - 0.4 * random.uniform());
      break;
    case PoseClass::far:
      t = approach.whereDistanceIs(20.0 * spacing, spacing) + a.reach() * random.uniform(0.0, 2.0);
      break;
    }
    const double distance = approach.distance(t);
    const bool as_meant = kind == PoseClass::hit ? distance <= 0.99 * spacing : distance >= 1.25 * spacing;
    if (as_meant) cases.push_back({approach.at(t), kind, distance});
  }
  return cases;
}

} // namespace pcl_bsh::bench
