// SPDX-License-Identifier: BSD-3-Clause
// A machine low above a scanned floor: its bottom is in the skin, and what the floor was cleared of is resolved.
#include <pcl_bsh/clashes/former_places.h>
#include <pcl_bsh/clashes/unseen_places.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/question/ask.h>

#include "solid/meshes.h"
#include "support/made_scans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace pcl_bsh {
namespace {

/// A yard of 40 m x 20 m, scanned from one place, and a box of 12 m x 3 m x 2 m that stands 0.15 m above its floor.
class ShadowAndSkin : public testing::Test {
protected:
  using Vector = Eigen::Vector3d;

  ShadowAndSkin()
  {
    question.clearance = 0.05;
    question.seen = true;
    question.origin = ScanOrigins::of({2, 10, 1.8});
    question.wanted.flags = question.wanted.contacts = question.wanted.unseen_places = true;
    placeBox({8, 8.5, 0.15}, {20, 11.5, 2.15});
  }

  void placeBox(const Vector& low, const Vector& high)
  {
    machine = test::boxMesh();
    for (std::size_t i = 0; i < machine.xyz.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i % 3);
      machine.xyz[i] = machine.xyz[i] == 0.0 ? low[k] : high[k];
    }
  }

  void scan(double step = 0.012)
  {
    test::Random random(1);
    returns = makeScan(yard, {origin, step, -1.3, 1.3}, random).returns;
  }

  Answer asked()
  {
    Shape input("yard", viewOf(returns.data(), returns.size() / 3)), obstacle("machine", viewOf(machine.view()));
    return ask(question, input, obstacle);
  }

  std::vector<Clash> listed(const Answer& answer) const
  {
    return findUnseenPlaces({viewOf(machine.view()), question.poses(), answer.unseen.where, &answer.unseen.kinds}, 0.5);
  }

  std::vector<Clash> clashes(const Answer& answer) const
  {
    return findClashes(viewOf(returns.data(), returns.size() / 3), answer.collisions, 0.5);
  }

  /// Former clashes, judged by this run.
  std::vector<Clash> compared(const std::vector<Clash>& before, const Answer& now)
  {
    std::vector<Clash> all = clashes(now);
    compareWithEarlier(all, before, 0.5);
    FormerPlaces former(all, *question.clearance, 0.5);
    const PointsView model = viewOf(machine.view());
    former.visit(SphereHierarchy(model), question.poses(), TrajectoryRequest());
    former.scan(viewOf(returns.data(), returns.size() / 3));
    tellUnseen(former, {model, question.poses(), now.unseen.where, &now.unseen.kinds});
    former.judge();
    return all;
  }

  const Vector origin = {2, 10, 1.8};
  test::MadeRoom yard{{Vector(0, 0, 0), Vector(40, 20, 6)}, {}};
  test::ClosedMesh machine;
  std::vector<double> returns;
  Question question;
};

TEST_F(ShadowAndSkin, OfABottomIsSkin)
{
  placeBox({5, 9.5, 0.17}, {17, 10.5, 2.15});
  scan(0.004);
  question.solid = true;
  const Answer found = asked();
  EXPECT_EQ(found.collisions.colliding, 0u);
  EXPECT_GT(found.unseen.count, 0u);
  EXPECT_EQ(found.unseen.in_shadow, 0u);
  EXPECT_EQ(found.unseen.inSkin(), found.unseen.count);
  EXPECT_EQ(found.unseen.shadow_at_poses, std::vector<std::size_t>{0});
  ASSERT_EQ(found.unseen.inside.size(), 1u);
  EXPECT_EQ(found.unseen.inside[0], 0.0);
  for (const Clash& place : listed(found)) {
    EXPECT_EQ(place.points_in_shadow, 0u);
    EXPECT_LT(place.high[2], 0.6) << "the bottom, and the lower ends of the walls";
    EXPECT_GT(place.low[0], 5.5) << "near the scanner the skin is thinner than 0.17 m";
  }
}

/// Below a ceiling, before a wall; a slope has no cube behind the floor either.
TEST_F(ShadowAndSkin, InsideIsNothingNearOtherSurfaces)
{
  scan();
  question.solid = true;
  for (const auto& [low, high] : {std::pair(Vector(10, 8.5, 4), Vector(20.1, 11.5, 5.9)),
                                  {Vector(30, 9, 1), Vector(39.9, 11.03, 2.07)},
                                  {Vector(9, 15, 1), Vector(14.3, 19.9, 3)},
                                  {Vector(9, 0.1, 0.1), Vector(20, 4.03, 2)}}) {
    placeBox(low, high);
    const Answer found = asked();
    EXPECT_EQ(found.collisions.colliding, 0u);
    EXPECT_EQ(found.unseen.in_shadow, 0u) << low.transpose();
    EXPECT_EQ(found.unseen.inside.at(0), 0.0) << low.transpose();
  }
}

TEST_F(ShadowAndSkin, InsideIsWhatIsHidden)
{
  yard.boxes.emplace_back(Vector(5, 9.5, 0), Vector(5.3, 10.5, 6)); // 1 m wide, 3 m before the scanner
  scan();
  question.solid = true;
  const Answer found = asked();
  EXPECT_GT(found.unseen.in_shadow, 0u);
  double hidden = 0.0, thin = 0.0; // by rays to places of the box, and less what the beams beside the pillar pass
  const double step = 0.125;
  for (double x = 8 + step / 2; x < 20; x += step)
    for (double y = 8.5 + step / 2; y < 11.5; y += step)
      for (double z = 0.15 + step / 2; z < 2.15; z += step) {
        const Vector way = Vector(x, y, z) - origin;
        if (yard.cast(origin, way.normalized()) < way.norm()) hidden += step * step * step;
        const double margin = 0.025 * way.norm(), side = std::abs(y - 10) + margin;
        if (side / (x - 2) < 0.5 / 3.3) thin += step * step * step;
      }
  EXPECT_LT(found.unseen.inside.at(0), hidden * 1.05);
  EXPECT_GT(found.unseen.inside.at(0), thin * 0.95);
}

TEST_F(ShadowAndSkin, OfAWallAreWhereItIsHidden)
{
  placeBox({8, 8.5, 1}, {20, 11.5, 2.15});
  yard.boxes.emplace_back(Vector(5, 8.9, 0), Vector(5.2, 9.4, 6)); // hides a piece of the wall at y = 8.5
  scan();
  const Answer found = asked();
  EXPECT_GT(found.unseen.in_shadow, 0u);
  const std::vector<Clash> places = listed(found);
  const auto covers = [&](const Vector& at) {
    return std::any_of(places.begin(), places.end(), [&](const Clash& place) {
      return Eigen::AlignedBox3d(Vector(place.low.data()), Vector(place.high.data())).exteriorDistance(at) < 1e-9;
    });
  };
  for (double x = 8.05; x < 20; x += 0.1) {
    const Vector at(x, 8.5, 1.1), way = at - origin;
    if (yard.cast(origin, way.normalized()) < way.norm()) {
      EXPECT_TRUE(covers(at)) << x;
    }
  }
  EXPECT_FALSE(covers({19.9, 8.5, 2.0})) << "of the same two triangles";
  EXPECT_FALSE(covers({8.1, 11.5, 2.0}));
}

/// Places of two holes of one triangle are two.
TEST_F(ShadowAndSkin, OfOneTriangleAreAsManyAsItHas)
{
  placeBox({8, 6, 1.0}, {9, 14, 2.5});
  yard.boxes.emplace_back(Vector(5, 8.5, 0), Vector(5.1, 8.8, 6));
  yard.boxes.emplace_back(Vector(5, 11.2, 0), Vector(5.1, 11.5, 6));
  scan();
  const std::vector<Clash> places = listed(asked());
  std::size_t before = 0;
  for (const Clash& place : places) {
    EXPECT_LT(place.high[1] - place.low[1], 2.5);
    EXPECT_GT(place.points_in_shadow, 0u);
    before += place.low[1] > 10.0 ? 1 : 0;
  }
  EXPECT_EQ(before, 1u);
  EXPECT_EQ(places.size(), 2u);
}

TEST_F(ShadowAndSkin, APalletThatWasRemovedIsResolved)
{
  for (const double x : {10.0, 14.0, 18.0}) {
    yard.boxes = {{Vector(x, 9.8, 0), Vector(x + 1.2, 10.6, 0.3)}};
    scan();
    question.seen = true;
    question.origin = ScanOrigins::of({2, 10, 1.8});
    const std::vector<Clash> before = clashes(asked());
    ASSERT_EQ(before.size(), 1u);
    yard.boxes.clear();
    scan();
    for (const bool seen : {true, false}) {
      question.seen = seen;
      if (!seen) question.origin = {};
      const std::vector<Clash> now = compared(before, asked());
      ASSERT_EQ(now.size(), 1u);
      EXPECT_EQ(now[0].status, ClashStatus::resolved) << x << ' ' << seen;
    }
  }
}

TEST_F(ShadowAndSkin, APalletThatIsHiddenIsNotResolved)
{
  yard.boxes = {{Vector(14, 9.8, 0), Vector(15.2, 10.6, 0.3)}};
  scan();
  const std::vector<Clash> before = clashes(asked());
  ASSERT_EQ(before.size(), 1u);
  yard.boxes = {{Vector(5, 9, 0), Vector(5.2, 11, 4)}};
  scan();
  const std::vector<Clash> now = compared(before, asked());
  ASSERT_EQ(now.size(), 1u);
  EXPECT_EQ(now[0].status, ClashStatus::unseen);
}

} // namespace
} // namespace pcl_bsh
