// SPDX-License-Identifier: BSD-3-Clause
// Attacks on the margins of slabs and of segments, on every instruction set, judged in long double: its error is less
// than a billionth of these margins.
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/simd/roundings.h>
#include <pcl_bsh/simd/supports.h>

#include "kernels.h"
#include "support/attack.h"
#include "support/climb.h"

#include <Eigen/Geometry>

namespace pcl_bsh {
namespace {

using test::floatOf;
using test::Random;
using Numbers = std::vector<double>;
using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;

constexpr double kNormalError = 0x1p-19; // of a normal's length, and of what carries it (kSlabMargin)

Vector vectorOf(const float (&v)[3])
{
  return {Real{v[0]}, Real{v[1]}, Real{v[2]}};
}

/// The points |x| <= r, |normal . x| <= h around a centre.
struct SlabSet {
  Vector center, normal;
  Real h, r;

  Vector nearestTo(const Vector& to) const
  {
    const Vector unit = normal.normalized(), x = to - center;
    const Real thick = h / normal.norm();
    if (thick >= r) return center + x * std::min(Real{1}, r / std::max(x.norm(), Real{1e-30L}));
    const Real along = std::clamp(unit.dot(x), -thick, thick);
    const Vector across = x - unit.dot(x) * unit;
    const Vector ball = x * std::min(Real{1}, r / std::max(x.norm(), Real{1e-30L}));
    if (std::abs(unit.dot(ball)) <= thick) return center + ball;
    const Real width = across.norm(), room = std::sqrt(r * r - along * along);
    return center + along * unit + across * std::min(Real{1}, room / std::max(width, Real{1e-30L}));
  }
};

/// Two slabs, of 26 numbers, one of them carried by a matrix that is a rotation within kNormalError. The claim of the
/// formula without its margins, less the distance of two points of the slabs, as a part of the margins.
double slabFraction(const Numbers& n, bool carried_is_other)
{
  const auto vector = [&](std::size_t k) { return Eigen::Vector3d(n[k], n[k + 1], n[k + 2]); };
  const auto off = [](double x) { return 1.0 + 0.999 * kNormalError * std::clamp(x, -1.0, 1.0); };
  Eigen::Quaterniond turn(n[6], n[7], n[8], n[9]);
  if (!(vector(0).norm() > 0.1 && vector(3).norm() > 0.1 && turn.norm() > 0.1)) return 0.0;
  const Eigen::Vector3d own = vector(0).normalized() * off(n[10]), its = vector(3).normalized() * off(n[11]);
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
  for (int k = 0; k < 3; ++k) stretch(k, k) = off(n[static_cast<std::size_t>(k) + 12]);
  const Eigen::Matrix3d carry = turn.normalized().toRotationMatrix() * stretch;
  const double most = stretch.diagonal().maxCoeff(), least = stretch.diagonal().minCoeff();
  test::TestSlab a{}, b{};
  float m[9], none[3] = {}, x[3][8] = {};
  for (int k = 0; k < 9; ++k) m[k] = static_cast<float>(carry(k / 3, k % 3));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    x[k][0] = static_cast<float>(own(row));
    b.normal[k] = static_cast<float>(its(row));
    a.center[k] = std::clamp(floatOf(n[k + 15]), -8.0f, 8.0f);
    b.center[k] = std::clamp(floatOf(n[k + 18]), -8.0f, 8.0f);
  }
  std::copy_n(test::carryEight(m, none, x[0], x[1], x[2]).point, 3, a.normal);
  a.radius = std::min(std::abs(floatOf(n[21])), 8.0f), b.radius = std::min(std::abs(floatOf(n[22])), 8.0f);
  a.h = std::min(std::abs(floatOf(n[23])), a.radius), b.h = std::min(std::abs(floatOf(n[24])), b.radius);

  // The points of the slab that is carried: no fewer than these are below a stretched radius.
  const Eigen::Matrix<Real, 3, 3> inverse = carry.cast<Real>().inverse();
  const Vector stored(x[0][0], x[1][0], x[2][0]);
  const SlabSet set_a{vectorOf(a.center), inverse.transpose() * stored, a.h, Real{a.radius} * Real{least}};
  const SlabSet set_b{vectorOf(b.center), vectorOf(b.normal), b.h, b.radius};
  Vector p = set_a.center, q = set_b.center;
  for (int k = 0; k < 40; ++k) p = set_a.nearestTo(q), q = set_b.nearestTo(p);
  const Real distance = (p - q).norm();

  const float factor = roundUp(most);
  const auto apart = [&](float reach) {
    if (!carried_is_other) return test::slabsApart(a, factor, b, reach);
    test::TestSlab other = a;
    other.radius *= factor;
    return test::slabsApart(b, 1.0f, other, reach);
  };
  if (!apart(0.0f)) return 0.0;
  float claimed = 0.0f, high = 64.0f;
  for (int k = 0; k < 40; ++k) {
    const float middle = 0.5f * (claimed + high);
    (apart(middle) ? claimed : high) = middle;
  }
  const Vector u = vectorOf(b.normal), v = vectorOf(a.normal), d = set_a.center - set_b.center;
  const Real cosine = std::abs(u.dot(v)), sine = std::sqrt(std::max(Real{0}, 1 - cosine * cosine));
  const Real on_u = std::abs(u.dot(d)) - (b.h + cosine * a.h + sine * Real{a.radius} * Real{factor}),
             on_v = std::abs(v.dot(d)) - (a.h + cosine * b.h + sine * b.radius);
  const auto bareAcross = [&](const Vector& normal) {
    const Real across = (d - normal.dot(d) * normal).norm() - (Real{a.radius} * Real{factor} + b.radius);
    return std::hypot(std::max({on_u, on_v, Real{0}}), std::max(across, Real{0}));
  };
  // Rounding decides between two normals that are as good: of the claims that may be meant, the lower one.
  const Real least_bare = std::min(bareAcross(u), bareAcross(v)), most_bare = std::max(bareAcross(u), bareAcross(v));
  const Real bare = least_bare > Real{claimed} ? least_bare : most_bare;
  return static_cast<double>((bare - distance) / (bare - Real{claimed}));
}

/// Two thin slabs, each with a second one across it, of 26 numbers, the first carried by a matrix that is a rotation
/// within kNormalError. The claimed distance without the margin, less their distance, as a part of the margin. @param
/// which 0: slabGaps(), 1: supportGaps(), 2: pointsGap()
double gapFraction(const Numbers& n, int which)
{
  const auto off = [](double x) { return 1.0 + 0.999 * kNormalError * std::clamp(x, -1.0, 1.0); };
  const auto vector = [&](std::size_t k) { return Eigen::Vector3d(n[k], n[k + 1], n[k + 2]); };
  Eigen::Quaterniond turn(n[6], n[7], n[8], n[9]);
  const Eigen::Vector3d aside_a = vector(0).cross(vector(23)), aside_b = vector(3).cross(vector(23));
  if (!(aside_a.norm() > 0.1 && aside_b.norm() > 0.1 && turn.norm() > 0.1)) return 0.0;
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
  for (int k = 0; k < 3; ++k) stretch(k, k) = off(n[static_cast<std::size_t>(k) + 12]);
  const Eigen::Matrix3d carry = turn.normalized().toRotationMatrix() * stretch;
  const float factor = roundUp(stretch.diagonal().maxCoeff());

  struct Held {
    test::TestSlab slab, cross;
    Vector normal, across; // of the set: of a, carried exactly
  };
  const auto held = [&](const Eigen::Vector3d& normal, const Eigen::Vector3d& across, std::size_t at, std::size_t r) {
    Held of{};
    float x[3][8] = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      of.slab.normal[k] = x[k][0] = static_cast<float>(normal(row));
      of.cross.normal[k] = x[k][1] = static_cast<float>(across(row));
      of.slab.center[k] = of.cross.center[k] = std::clamp(floatOf(n[at + k]), -8.0f, 8.0f);
    }
    of.slab.radius = of.cross.radius = std::clamp(std::abs(floatOf(n[r])), 0x1p-20f, 8.0f);
    of.slab.h = 0x1p-20f * of.slab.radius;
    of.cross.h = std::clamp(std::abs(floatOf(n[r + 2])), of.slab.h, of.slab.radius);
    of.normal = vectorOf(of.slab.normal), of.across = vectorOf(of.cross.normal);
    return of;
  };
  Held a = held(vector(0).normalized() * off(n[10]), aside_a.normalized(), 15, 21);
  const Held b = held(vector(3).normalized() * off(n[11]), aside_b.normalized(), 18, 22);
  a.slab.h = std::clamp(std::abs(floatOf(n[25])), a.slab.h, a.slab.radius);
  float m[9], none[3] = {}, x[3][8] = {};
  for (int k = 0; k < 9; ++k) m[k] = static_cast<float>(carry(k / 3, k % 3));
  for (std::size_t k = 0; k < 3; ++k) x[k][0] = a.slab.normal[k];
  std::copy_n(test::carryEight(m, none, x[0], x[1], x[2]).point, 3, a.slab.normal);
  for (std::size_t k = 0; k < 3; ++k) x[k][0] = a.cross.normal[k];
  std::copy_n(test::carryEight(m, none, x[0], x[1], x[2]).point, 3, a.cross.normal);

  const Eigen::Matrix<Real, 3, 3> exact = carry.cast<Real>(), inverse = exact.inverse();
  const Vector center_a = vectorOf(a.slab.center), center_b = vectorOf(b.slab.center);
  const Vector d = center_a - center_b;
  if (!(d.norm() > 0x1p-10L)) return 0.0;
  // Points in all that holds them, towards each other: where they are, a claim may not be above their distance.
  const auto farthest = [](Vector towards, const Held& of, Real radius, bool crossed) {
    Vector p = towards * (radius / std::max(towards.norm(), Real{1e-30L}));
    for (int k = 0; k < 30; ++k) {
      const auto between = [&](const Vector& normal, Real h) {
        const Real along = normal.dot(p);
        if (std::abs(along) > h) p -= normal * ((along - std::copysign(h, along)) / normal.squaredNorm());
      };
      between(of.normal, of.slab.h);
      if (crossed) between(of.across, of.cross.h);
    }
    const Real least = std::min({Real{1}, of.slab.h / std::max(std::abs(of.normal.dot(p)), Real{1e-30L}),
                                 crossed ? of.cross.h / std::max(std::abs(of.across.dot(p)), Real{1e-30L}) : Real{1},
                                 radius / std::max(p.norm(), Real{1e-30L})});
    return Vector(p * least);
  };
  const bool crossed = which == 1;
  Vector p = farthest(inverse * -d, a, Real{a.slab.radius}, crossed);
  Vector q = which == 2 ? Vector(Vector::Zero()) : farthest(d, b, Real{b.slab.radius}, crossed);
  const Real distance = (d + exact * p - q).norm();

  const test::Gaps gaps = test::gapsOf(a.slab, a.cross, factor, b.slab, b.cross);
  const float claimed = which == 0 ? gaps.slabs : which == 1 ? gaps.supports : gaps.point;
  if (!(claimed > 0.0f)) return 0.0;
  const Real radii = Real{a.slab.radius} * Real{factor} + (which == 2 ? Real{0} : Real{b.slab.radius});
  const Real margin = Real{kSupportShare} * radii + Real{kDistanceShare} * d.norm();
  return static_cast<double>((Real{claimed} + margin - distance) / margin);
}

/// Discs, and discs across which there is a second slab, that reach towards each other with their rims.
TEST(LanesAttack, MarginOfSupports)
{
  test::onEveryTarget([](const std::string& target) {
    for (const int which : {0, 1, 2}) {
      Random random(203);
      const auto start = [&] {
        Numbers n(27, 0.0);
        for (double& x : n) x = random.uniform(-1, 1);
        for (std::size_t k = 15; k < 21; ++k) n[k] *= 2.0;
        n[21] = random.uniform(0.1, 1), n[22] = random.uniform(0.1, 1);
        n[25] = random.chance(0.5) ? 0.0 : random.uniform(0, 0.1);
        if (random.chance(0.5)) { // the normal across the way from one to the other: the whole disc reaches
          const Eigen::Vector3d d(n[15] - n[18], n[16] - n[19], n[17] - n[20]);
          const Eigen::Vector3d across = d.cross(Eigen::Vector3d(n[0], n[1], n[2]));
          for (std::size_t k = 0; k < 3; ++k) n[k] = n[k + 3] = across(static_cast<Eigen::Index>(k));
          n[6] = 1, n[7] = n[8] = n[9] = 0;
        }
        return n;
      };
      const double reached = test::climbFromMany(
          start, [&](const Numbers& n) { return gapFraction(n, which); }, 20, 200, random);
      test::report("supports, kernel " + std::to_string(which) + ", " + target, reached);
      if (which != 1) { // a second slab leaves of a sphere what no point need reach
        EXPECT_GE(reached, 0.1);
      }
    }
  });
}

/// Nearly parallel normals: the margin in the sine's square pays for 6 x 2^-19 of lengths and for roundings, of 8 x
/// 2^-19.
TEST(LanesAttack, MarginOfSlabs)
{
  test::onEveryTarget([](const std::string& target) {
    for (const bool carried_is_other : {false, true}) {
      Random random(201);
      const auto start = [&] {
        const double tilt = std::sqrt(6 * kNormalError) * random.uniform(0.8, 1.2), gap = random.uniform(0.01, 0.2);
        Numbers n = {0, 0, 1, std::sin(tilt), 0, std::cos(tilt), 1, 0, 0, 0, 1, 1, 1, 1, 1};
        if (random.chance(0.2))
          for (std::size_t k = 0; k < 6; ++k) n[k] = random.uniform(-1, 1);
        n.insert(n.end(), {0, 0, 0, 1 + gap * n[3], gap * n[4], gap * n[5], 1, 0x1p-12, 0x1p-30, 0x1p-30, 0});
        if (random.chance(0.2)) n[18] += random.uniform(0, 2); // apart across the normals, too
        if (random.chance(0.5))
          for (double& x : n) x += 0x1p-12 * random.uniform(-1, 1);
        return n;
      };
      const double reached = test::climbFromMany(
          start, [&](const Numbers& n) { return slabFraction(n, carried_is_other); }, 20, 200, random);
      test::report("slabs, the " + std::string(carried_is_other ? "other" : "lanes") + " carried, " + target, reached);
      EXPECT_GE(reached, 0.9);
    }
  });
}

/// A segment, of shift, matrix row and point at both ends, that touches a box's side along x. The least reach with
/// which its stay in the box holds the instant of touching, less the true reach, as a part of kSegmentRounding.
///
/// The bound adds the errors of both ends, which weigh 1 - t and t. It takes a time's error for twice the largest
/// coordinate, which only a segment from side to side has: a third of it at best.
double boxFraction(const Numbers& n)
{
  float ends[2][3] = {};
  Real true_ends[2];
  Real largest = 0;
  for (std::size_t e = 0; e < 2; ++e) {
    const std::size_t at = 4 * e;
    const float m[9] = {floatOf(n[at + 1]), floatOf(n[at + 2]), floatOf(n[at + 3])}, g[3] = {floatOf(n[at])};
    float x[3][8] = {};
    Real sum = n[at], absolute = std::abs(n[at]);
    for (std::size_t k = 0; k < 3; ++k) {
      x[k][0] = floatOf(n[8 + k]);
      sum += Real{n[at + 1 + k]} * Real{x[k][0]};
      absolute += std::abs(Real{n[at + 1 + k]} * Real{x[k][0]});
    }
    ends[e][0] = test::carryEight(m, g, x[0], x[1], x[2]).x[0];
    true_ends[e] = sum;
    largest = std::max(largest, absolute);
  }
  const float low[3] = {floatOf(n[11]), -1, -1}, high[3] = {low[0] + std::abs(floatOf(n[12])), 1, 1};
  const Real reach = std::abs(n[13]), motion = true_ends[1] - true_ends[0];
  largest = std::max({largest + reach, Real{1}}); // not of the box: its ends round as the gap to them
  if (!(largest < 16 && motion != 0)) return 0.0;
  const Real at_low = (low[0] - reach - true_ends[0]) / motion, at_high = (high[0] + reach - true_ends[0]) / motion;
  const Real enter = std::max(Real{0}, std::min(at_low, at_high)), leave = std::min(Real{1}, std::max(at_low, at_high));
  if (!(enter <= leave)) return 0.0;
  const Real rounding = Real{kSegmentRounding} * largest;
  const auto holds = [&](Real margin) {
    const test::Stay stay = test::segmentInBox(ends[0], ends[1], {0, 0, 0}, static_cast<float>(rounding) * 0x1p-8f,
                                               roundUp(static_cast<double>(reach + margin)), low, high);
    return stay.in_box && stay.from <= enter && stay.to >= leave;
  };
  if (!holds(rounding)) return 2.0;
  Real least = 0, most = rounding;
  for (int k = 0; k < 12; ++k) {
    const Real middle = (least + most) / 2;
    (holds(middle) ? most : least) = middle;
  }
  return static_cast<double>(most / rounding);
}

TEST(LanesAttack, SegmentsInBoxes)
{
  test::onEveryTarget([](const std::string& target) {
    Random random(202);
    const auto start = [&] {
      Numbers n(14);
      for (double& x : n) x = test::suspect(random, 3);
      n[12] = std::ldexp(n[12], random.chance(0.5) ? 0 : random.integer(0, 24));
      n[13] = std::ldexp(n[13], -random.integer(1, 20));
      return n;
    };
    const double reached = test::climbFromMany(start, boxFraction, 40, 400, random);
    test::report("segments in boxes, " + target, reached);
    EXPECT_GE(reached, 0.1);
  });
}

/// A bowed segment past a box, nearest to it at some instant. The least margin with which it is near for a reach of
/// just that distance, as a part of kSegmentRounding; and its stay has to hold the instant.
double bowedFraction(const Numbers& n)
{
  float start[3], end[3], bow[3], low[3], high[3];
  Real largest = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    start[k] = floatOf(n[k]);
    end[k] = floatOf(n[3 + k]);
    bow[k] = floatOf(n[6 + k]);
    low[k] = floatOf(n[9 + k]);
    high[k] = low[k] + std::abs(floatOf(n[12 + k]));
    largest = std::max({largest, std::abs(Real{start[k]}), std::abs(Real{end[k]})}); // not of the box
  }
  if (!(largest < 16)) return 0.0;
  const auto distanceAt = [&](Real t) {
    Real squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Real at = start[k] + t * (Real{end[k]} - start[k]) + 4 * t * (1 - t) * bow[k];
      const Real gap = std::max({Real{low[k]} - at, at - high[k], Real{0}});
      squared += gap * gap;
    }
    return std::sqrt(squared);
  };
  Real instant = 0;
  for (int i = 1; i <= 64; ++i)
    if (distanceAt(i / Real{64}) < distanceAt(instant)) instant = i / Real{64};
  for (Real step = 1 / Real{128}; step > 1e-9L; step /= 2)
    for (const Real next : {instant - step, instant + step})
      if (next >= 0 && next <= 1 && distanceAt(next) < distanceAt(instant)) instant = next;
  const Real reach = distanceAt(instant);
  const Real bows = std::sqrt(Real{bow[0]} * bow[0] + Real{bow[1]} * bow[1] + Real{bow[2]} * bow[2]);
  const Real rounding = Real{kSegmentRounding} * (largest + reach + 8 * bows);
  const auto holds = [&](Real margin) {
    const test::Stay stay = test::segmentInBox(start, end, bow, static_cast<float>(rounding) * 0x1p-8f,
                                               roundUp(static_cast<double>(reach + margin)), low, high);
    return stay.in_box && stay.from <= instant && stay.to >= instant;
  };
  if (!holds(rounding)) return 2.0;
  Real least = 0, most = rounding;
  for (int k = 0; k < 12; ++k) {
    const Real middle = (least + most) / 2;
    (holds(middle) ? most : least) = middle;
  }
  return static_cast<double>(most / rounding);
}

TEST(LanesAttack, BowedSegmentsInBoxes)
{
  test::onEveryTarget([](const std::string& target) {
    Random random(203);
    const auto start = [&] {
      Numbers n(15);
      for (double& x : n) x = test::suspect(random, 3);
      for (std::size_t k = 6; k < 9; ++k) n[k] = std::ldexp(n[k], -random.integer(0, 12));
      for (std::size_t k = 12; k < 15; ++k) n[k] = std::ldexp(n[k], random.chance(0.5) ? 0 : random.integer(0, 24));
      return n;
    };
    const double reached = test::climbFromMany(start, bowedFraction, 40, 400, random);
    test::report("bowed segments in boxes, " + target, reached);
    EXPECT_LE(reached, 1.0);
    EXPECT_GE(reached, 0.02);
  });
}

} // namespace
} // namespace pcl_bsh
