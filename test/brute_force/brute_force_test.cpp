// SPDX-License-Identifier: BSD-3-Clause
// The oracle itself, against answers known beforehand.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>

#include "support/brute_force/many_poses.h"
#include "support/question.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

using Flags = std::vector<Verdict>;
using test::Cloud;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

test::Question within(double clearance, Flagged flagged = Flagged::a)
{
  test::Question request;
  request.clearance = clearance;
  request.flagged = flagged;
  return request;
}

class BruteForce : public testing::Test {
protected:
  const Cloud a_{std::vector<Point3>{{10, 0, 0}, {nan, 0, 0}, {0, 0, 0}, {0, 0, 0}, {3, 4, 0}}};
  const Cloud b_{std::vector<Point3>{{0, 0, -5}, {3, 4, 0}, {0, infinity, 0}, {0, 5, 0}}};
  const SphereHierarchy hierarchy_a_{a_.view()}, hierarchy_b_{b_.view()};
  const Placed pa_{hierarchy_a_}, pb_{hierarchy_b_};
};

TEST_F(BruteForce, FlagsTheSideAskedFor)
{
  const FlagsResult of_a = brute_force::collisionFlags(pa_, pb_, within(5));
  EXPECT_EQ(of_a.a, test::verdictsOf({0, 0, 1, 1, 1}));
  EXPECT_TRUE(of_a.b.empty());
  EXPECT_EQ(of_a.colliding_a, 3u);
  EXPECT_EQ(of_a.colliding_b, 0u);
  const FlagsResult of_b = brute_force::collisionFlags(pa_, pb_, within(0, Flagged::b));
  EXPECT_TRUE(of_b.a.empty());
  EXPECT_EQ(of_b.b, test::verdictsOf({0, 1, 0, 0}));
  EXPECT_EQ(of_b.colliding_b, 1u);
  const FlagsResult of_both = brute_force::collisionFlags(pa_, pb_, within(5, Flagged::both));
  EXPECT_EQ(of_both.a, of_a.a);
  EXPECT_EQ(of_both.b, test::verdictsOf({1, 1, 0, 1}));
  EXPECT_EQ(of_both.work.exact_decisions, 12u);
}

TEST_F(BruteForce, FindsTheSmallestWitness)
{
  EXPECT_EQ(brute_force::anyCollision(pa_, pb_, within(5)).pair, (PointPair{2, 0}));
  EXPECT_EQ(brute_force::anyCollision(pa_, pb_, within(0)).pair, (PointPair{4, 1}));
  EXPECT_EQ(brute_force::anyCollision({hierarchy_b_}, {hierarchy_b_}, within(0)).pair, (PointPair{0, 0}));
  const Cloud far({{100, 0, 0}});
  const SphereHierarchy away(far.view());
  const AnyResult none = brute_force::anyCollision(pa_, {away}, within(89.999));
  EXPECT_EQ(none.verdict, Verdict::free);
  EXPECT_FALSE(none.pair);
}

TEST_F(BruteForce, ClosestPairIsTheSmallestOfEquals)
{
  Cloud points({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  points.restrictTo({3, 2, 1}); // the order of a subset does not matter
  const Cloud origin({{7, 7, 7}, {0, 0, 0}, {0, 0, 0}});
  const SphereHierarchy hierarchy(points.view()), target(origin.view());
  const DistanceResult result = brute_force::closestPair({hierarchy}, {target});
  EXPECT_EQ(result.distance, 1.0);
  EXPECT_EQ(result.pair, (PointPair{1, 1}));
  EXPECT_EQ(result.work.exact_decisions, 9u);
}

TEST_F(BruteForce, RadiiAddToTheClearanceAndShortenTheDistance)
{
  Cloud a({{0, 0, 0}, {0, 3, 4}});
  a.setRadii({0.0f, 1.5f});
  Cloud b({{0, 0, 0}});
  b.setRadii({0.5f});
  const SphereHierarchy ha(a.view()), hb(b.view());
  EXPECT_EQ(brute_force::collisionFlags({ha}, {hb}, within(3)).a, test::verdictsOf({1, 1}));
  EXPECT_EQ(brute_force::collisionFlags({ha}, {hb}, within(std::nextafter(3.0, 0.0))).a, test::verdictsOf({1, 0}));
  const DistanceResult result = brute_force::closestPair({ha}, {hb});
  EXPECT_EQ(result.distance, -0.5);
  EXPECT_EQ(result.pair, (PointPair{0, 0}));
}

TEST_F(BruteForce, NothingIsInfinitelyFar)
{
  const Cloud bad({{nan, 0, 0}, {0, 0, -infinity}});
  const SphereHierarchy nothing(bad.view());
  for (const DistanceResult& result :
       {brute_force::closestPair({nothing}, pb_), brute_force::closestPair(pb_, {nothing})}) {
    EXPECT_EQ(result.distance, infinity);
    EXPECT_FALSE(result.pair);
  }
  EXPECT_EQ(brute_force::anyCollision({nothing}, pb_, within(1e300)).verdict, Verdict::free);
  EXPECT_EQ(brute_force::collisionFlags({nothing}, pb_, within(1e300)).a, test::verdictsOf({0, 0}));
}

TEST_F(BruteForce, AnswersAlikeWhateverTheRoundingMode)
{
  test::Random random(25);
  for (int i = 0; i < 200; ++i) {
    const auto coordinate = [&] { return random.uniform(-1, 1) * 1.3; };
    const Cloud p({random.point(coordinate)}, {Scalar::float64}), q({random.point(coordinate)}, {Scalar::float64});
    const SphereHierarchy hp(p.view()), hq(q.view());
    const double distance = brute_force::closestPair({hp}, {hq}).distance;
    const bool expected = brute_force::anyCollision({hp}, {hq}, within(distance)).pair.has_value();
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      std::fesetround(mode);
      const DistanceResult again = brute_force::closestPair({hp}, {hq});
      const AnyResult any = brute_force::anyCollision({hp}, {hq}, within(distance));
      std::fesetround(FE_TONEAREST);
      EXPECT_EQ(again.distance, distance);
      EXPECT_EQ(any.pair.has_value(), expected);
    }
  }
}

TEST_F(BruteForce, ChecksTheRequest)
{
  EXPECT_THROW(brute_force::anyCollision(pa_, pb_, within(-1)), std::invalid_argument);
  EXPECT_THROW(brute_force::collisionFlags(pa_, pb_, within(nan)), std::invalid_argument);
  EXPECT_THROW(brute_force::closestPair(pa_, pb_, {Accuracy::tolerance(-1)}), std::invalid_argument);
}

TEST_F(BruteForce, CountsThePosesOfEachVerdict)
{
  Cloud p({{0, 0, 0}}), q({{0, 0, 0}});
  p.setUncertainties(0.25, {});
  const SphereHierarchy hp(p.view()), hq(q.view());
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); };
  const std::vector<Eigen::Isometry3d> poses = {at(0), at(1), at(1.125), at(0.5), at(4)};
  const AnyAtPoses found = brute_force::anyCollisionAtPoses({hp}, hq, poses, within(1.0));
  EXPECT_EQ(found.flags, (std::vector<Verdict>{Verdict::colliding, Verdict::undecided, Verdict::undecided,
                                               Verdict::colliding, Verdict::free}));
  EXPECT_EQ(found.colliding, 2u);
  EXPECT_EQ(found.undecided, 2u);
}

} // namespace
} // namespace pcl_bsh
