// SPDX-License-Identifier: BSD-3-Clause
// None before; at it, within clearance + tolerance: judged in rational numbers.
#include <pcl_bsh/trajectory/leaf/closest_approach.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/journeys.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace pcl_bsh {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using test::Cloud;
using test::identity;
using test::Poses;
using test::Random;

/// |from + t (to - from)|^2 of a point at rest less one that moves by translation.
struct ExactWay {
  Rational from[3], to[3];

  Rational squaredAt(const Rational& t) const
  {
    Rational squared = 0;
    for (int k = 0; k < 3; ++k) {
      const Rational x = from[k] + t * (to[k] - from[k]);
      squared += x * x;
    }
    return squared;
  }

  /// The least over [0, last].
  Rational leastSquared(const Rational& last) const
  {
    Rational along = 0, length = 0;
    for (int k = 0; k < 3; ++k) {
      along += from[k] * (to[k] - from[k]);
      length += (to[k] - from[k]) * (to[k] - from[k]);
    }
    if (length == 0) return squaredAt(0);
    const Rational foot = -along / length;
    return squaredAt(foot < 0 ? Rational(0) : foot > last ? last : foot);
  }
};

struct Passing {
  Point3 point;    ///< of the scan; the model is a point at 0
  Point3 from, to; ///< its ways' ends
  double clearance, tolerance;
};

/// @return whether it was refused
bool expectPromiseKept(const Passing& passing)
{
  const Cloud scan_cloud({passing.point}, {Scalar::float64, 0, 0}), model_cloud({{0, 0, 0}});
  const SphereHierarchy scan(scan_cloud.view()), model(model_cloud.view());
  Poses poses(2, identity);
  ExactWay way;
  for (std::size_t k = 0; k < 3; ++k) {
    poses[0].translation()[static_cast<Eigen::Index>(k)] = passing.from[k];
    poses[1].translation()[static_cast<Eigen::Index>(k)] = passing.to[k];
    way.from[k] = Rational(passing.from[k]) - Rational(passing.point[k]);
    way.to[k] = Rational(passing.to[k]) - Rational(passing.point[k]);
  }
  TrajectoryRequest request;
  request.clearance = passing.clearance;
  request.swept = passing.tolerance;
  TrajectoryResult found;
  try {
    found = collideAlong({scan}, model, poses, request);
  }
  catch (const std::invalid_argument&) {
    return true;
  }
  const Rational clearance(passing.clearance), most = clearance + Rational(passing.tolerance);
  if (!found.first_contact) {
    EXPECT_GT(way.leastSquared(1), clearance * clearance) << "free, and it collides";
    EXPECT_EQ(found.colliding, 0u);
    return false;
  }
  EXPECT_EQ(found.colliding, 1u);
  const FirstContact at = *found.first_contact;
  const Rational time = at.pose == 0 ? Rational(at.fraction) : Rational(1);
  EXPECT_LE(way.squaredAt(time), most * most) << "apart at the first contact, at " << at.fraction;
  if (time > 0) {
    // Before it: up to the last double below, the way gets nearer all the time.
    const double before = std::nextafter(at.pose == 0 ? at.fraction : 1.0, 0.0);
    EXPECT_GT(way.leastSquared(Rational(before)), clearance * clearance) << "a contact before " << at.fraction;
  }
  return false;
}

TEST(TrajectoryFirstContact, OnALongWay)
{
  EXPECT_FALSE(expectPromiseKept({{0.58389131789999271, 1.5404554724645024e-07, 0},
                                  {-109.16400178682251, 0, 0},
                                  {107.32055213752176, 0, 0},
                                  0.0,
                                  1e-6}));
}

TEST(TrajectoryFirstContact, OnLongWaysOfAnyKind)
{
  Random random(88);
  int refused = 0;
  for (int i = 0; i < 4000 && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const double length = std::exp2(random.uniform(-3, 18)), tolerance = std::exp2(random.uniform(-24, 0));
    const double clearance = random.chance(0.5) ? 0.0 : std::exp2(random.uniform(-10, 4));
    // The way passes at about the distance at which things change, now through, now by.
    const double beside = (clearance + tolerance) * random.uniform(0, 1.2);
    Passing passing{{random.uniform(-1, 1), beside, 0},
                    {-length * random.uniform(0, 1), 0, 0},
                    {length * random.uniform(0, 1), 0, 0},
                    clearance,
                    tolerance};
    if (random.chance(0.5)) // in any direction
      passing.from[1] = -(passing.to[1] = length * random.uniform(-1, 1));
    if (random.chance(0.1)) std::swap(passing.from, passing.to);
    if (random.chance(0.1)) passing.to = passing.from;
    refused += expectPromiseKept(passing) ? 1 : 0;
  }
  EXPECT_LT(refused, 400) << "what can be kept is to be accepted";
}

TEST(TrajectoryFirstContact, AHundredKilometresOn)
{
  Random random(89);
  for (int i = 0; i < 1000 && !::testing::Test::HasFailure(); ++i) {
    const double tolerance = 1e-4, clearance = random.chance(0.5) ? 0.0 : 0.05;
    EXPECT_FALSE(expectPromiseKept({{random.uniform(-1, 1), (clearance + tolerance) * random.uniform(0, 1.1), 0},
                                    {-1e5 * random.uniform(0.5, 1), 0, 0},
                                    {1e5 * random.uniform(0.5, 1), 0, 0},
                                    clearance,
                                    tolerance}));
  }
}

TEST(TrajectoryFirstContact, RefusesWhatDoublesCannotTell)
{
  const auto refusal = [](const Passing& passing) -> std::string {
    const Cloud point({passing.point}, {Scalar::float64, 0, 0});
    const SphereHierarchy cloud(point.view());
    Poses poses(2, identity);
    poses[1].translation() = Eigen::Vector3d(passing.to[0], passing.to[1], passing.to[2]);
    TrajectoryRequest request;
    request.swept = passing.tolerance;
    try {
      collideAlong({cloud}, cloud, poses, request);
    }
    catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing";
  };
  using testing::AllOf;
  using testing::HasSubstr;
  EXPECT_THAT(refusal({{0, 0, 0}, {}, {1e5, 0, 0}, 0, 1e-9}), AllOf(HasSubstr("1e-09"), HasSubstr("give at least")));
  EXPECT_THAT(refusal({{0, 0, 0}, {}, {1e-200, 0, 0}, 0, 1e-190}),
              AllOf(HasSubstr("1e-190"), HasSubstr("give at least")));
  for (const double far : {1e31, 1e150, 1e300, 1e308})
    EXPECT_THAT(refusal({{far, 0, 0}, {}, {far, 0, 0}, 0, far / 8}),
                AllOf(HasSubstr("swept motion: coordinates as large as"), testing::Not(HasSubstr("brute_force"))));
  // A pivot far away is a length that rounding counts for, too.
  const Cloud point({{0, 0, 0}});
  const SphereHierarchy cloud(point.view());
  TrajectoryRequest request;
  request.swept = 1e-6;
  request.pivot = {1e9, 0, 0};
  EXPECT_THROW(collideAlong({cloud}, cloud, Poses(2, identity), request), std::invalid_argument);
}

/// The bounds that closest_approach.h states.
TEST(StraightWay, RightWithinSixteenRoundings)
{
  Random random(90);
  for (int i = 0; i < 20000 && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const double near = std::exp2(random.uniform(-30, 3)), length = std::exp2(random.uniform(-40, 20));
    Point3 away = random.point([&] { return near * random.uniform(-2, 2); });
    Point3 motion = random.point([&] { return length * random.uniform(-1, 1); });
    if (random.chance(0.3)) motion[1] = motion[2] = 0.0;
    const double back = random.uniform(-0.2, 1.2);
    for (std::size_t k = 0; k < 3; ++k) away[k] -= back * motion[k];
    const Approach found = closestApproach(away, motion, near);
    ExactWay way;
    double largest = near;
    for (std::size_t k = 0; k < 3; ++k) {
      way.from[k] = Rational(away[k]);
      way.to[k] = Rational(away[k]) + Rational(motion[k]);
    }
    largest = std::max({largest, std::hypot(away[0], away[1], away[2]), std::hypot(motion[0], motion[1], motion[2])});
    const Rational slack(16 * 0x1p-53 * largest), least = way.leastSquared(1);
    const auto square = [](const Rational& x) { return Rational(x < 0 ? Rational(0) : Rational(x * x)); };
    if (!found.contact) {
      EXPECT_GE(least, square(Rational(near) - slack));
      continue;
    }
    EXPECT_LE(least, square(Rational(near) + slack));
    EXPECT_LE(least, square(Rational(found.distance) + slack));
    EXPECT_GE(least, square(Rational(found.distance) - slack));
    EXPECT_LE(way.squaredAt(Rational(found.at)), square(Rational(found.distance) + slack));
    EXPECT_LE(found.enter, found.at);
    EXPECT_LE(way.squaredAt(Rational(found.enter)), square(Rational(near) + slack));
    if (found.enter > 0.0) {
      EXPECT_GE(way.leastSquared(Rational(found.enter)), square(Rational(near) - slack));
    }
  }
}

} // namespace
} // namespace pcl_bsh
