// SPDX-License-Identifier: BSD-3-Clause
// Several obstacles, each on a path of its own, against questions about one at a time and against all pairs of points.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/question/obstacles.h>

#include "support/random_clouds.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

/// A scan, and three obstacles that cross it at four poses each.
class ObstaclePaths : public testing::Test {
protected:
  ObstaclePaths()
  {
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = test::makePoints(test::Shape::uniform, 120 + 30 * i, 0.3, random);
      obstacles.push_back({Shape("obstacle " + std::to_string(i), viewOf(points[i][0].data(), points[i].size()))});
      obstacles[i].path.emplace(4, Eigen::Isometry3d::Identity());
      for (std::size_t k = 0; k < 4; ++k) {
        Eigen::Isometry3d& pose = (*obstacles[i].path)[k];
        pose.translation() = Eigen::Vector3d(0.4 * static_cast<double>(k) - 0.7, 0.25 * static_cast<double>(i), 0.1);
        if (i == 1) pose.translation().x() *= -1.0;
        pose.rotate(Eigen::AngleAxisd(0.3 * static_cast<double>(k), Eigen::Vector3d::UnitZ()));
      }
    }
    obstacles[2].path->assign(4, obstacles[2].path->front()); // stands still
  }

  test::Random random{64};
  std::vector<Point3> scan = test::makePoints(test::Shape::uniform, 900, 1.0, random);
  std::vector<std::vector<Point3>> points = std::vector<std::vector<Point3>>(3);
  std::vector<PlacedShape> obstacles;
};

TEST_F(ObstaclePaths, AreFollowedAsIfEachWereAskedAlone)
{
  Question question;
  question.clearance = 0.03;
  question.wanted.flags = question.wanted.contacts = question.wanted.poses = question.wanted.closest = true;
  Shape input("scan", viewOf(scan[0].data(), scan.size()));
  std::vector<Verdict> gravest(scan.size(), Verdict::free);
  std::size_t told = 0;
  const ObstaclesAnswer found =
      ask(question, input, obstacles, [&](std::size_t i, const Question& asked, Answer& answer) {
        Question alone = question;
        alone.path = obstacles[i].path;
        ASSERT_TRUE(asked.path);
        Shape fresh("alone", viewOf(points[i][0].data(), points[i].size()));
        const Answer expected = ask(alone, input, fresh);
        EXPECT_GT(expected.collisions.colliding, 0U) << i;
        EXPECT_EQ(answer.collisions.flags, expected.collisions.flags);
        EXPECT_EQ(answer.collisions.first_pose, expected.collisions.first_pose);
        EXPECT_EQ(answer.collisions.closest_pose, expected.collisions.closest_pose);
        for (std::size_t p = 0; p < gravest.size(); ++p) gravest[p] = graver(gravest[p], expected.collisions.flags[p]);
        ++told;
      });
  EXPECT_EQ(told, 3U);
  EXPECT_EQ(found.all.collisions.flags, gravest);
  EXPECT_EQ(found.all.collisions.poses.size(), 4U);
  for (const ObstacleAnswer& one : found.each) EXPECT_GE(one.closest_pose, 0);
}

TEST_F(ObstaclePaths, AreComparedWithEachOtherAtPosesOfOneNumber)
{
  Question question;
  question.clearance = 0.04;
  const auto all = [](std::uint32_t, std::uint32_t) { return true; };
  const std::vector<ObstaclePair> pairs = askBetween(question, obstacles, all);
  ASSERT_EQ(pairs.size(), 3U);
  std::size_t later = 0;
  for (const ObstaclePair& pair : pairs) {
    const auto placed = [&](const SphereHierarchy& hierarchy, std::uint32_t i, std::size_t k) {
      return Placed(hierarchy, (*obstacles[i].path)[k]);
    };
    const SphereHierarchy one(viewOf(points[pair.first][0].data(), points[pair.first].size())),
        other(viewOf(points[pair.second][0].data(), points[pair.second].size()));
    ObstaclePair expected;
    for (std::size_t k = 0; k < 4; ++k) {
      const DistanceResult now = brute_force::closestPair(placed(one, pair.first, k), placed(other, pair.second, k));
      if (now.distance <= 0.04 && expected.first_pose < 0) expected.first_pose = static_cast<std::int32_t>(k);
      if (!(now.distance < expected.closest.distance)) continue;
      expected.closest = now;
      expected.closest_pose = static_cast<std::int32_t>(k);
    }
    EXPECT_EQ(pair.verdict, expected.first_pose < 0 ? Verdict::free : Verdict::colliding);
    EXPECT_EQ(pair.first_pose, expected.first_pose);
    EXPECT_EQ(pair.closest_pose, expected.closest_pose);
    EXPECT_EQ(pair.closest.distance, expected.closest.distance);
    ASSERT_TRUE(pair.closest.pair);
    EXPECT_EQ(pair.closest.pair->a, expected.closest.pair->a);
    EXPECT_EQ(pair.closest.pair->b, expected.closest.pair->b);
    later += expected.first_pose > 0 || expected.closest_pose > expected.first_pose ? 1 : 0;
  }
  EXPECT_GT(later, 0U) << "else the first pose decides all";
}

TEST_F(ObstaclePaths, MeetAtALaterPoseAmongMany)
{
  const auto standing = [](double x) {
    std::vector<Eigen::Isometry3d> path(3, Eigen::Isometry3d::Identity());
    for (Eigen::Isometry3d& pose : path) pose.translation().x() = x;
    return path;
  };
  std::vector<PlacedShape> crowd(most_obstacles_with_free_pairs + 1, obstacles[0]);
  for (std::size_t i = 0; i < crowd.size(); ++i) crowd[i].path = standing(10.0 * static_cast<double>(i));
  crowd[3].path->at(2) = crowd[17].path->at(2);
  const std::vector<ObstaclePair> pairs = askBetween({}, crowd, [](std::uint32_t, std::uint32_t) { return true; });
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].first, 3U);
  EXPECT_EQ(pairs[0].second, 17U);
  EXPECT_EQ(pairs[0].first_pose, 2);
}

TEST_F(ObstaclePaths, BelongTogether)
{
  Question question;
  question.clearance = 0.03;
  question.wanted.flags = true;
  Shape input("scan", viewOf(scan[0].data(), scan.size()));
  const auto refusal = [&](const Question& asked, const std::vector<PlacedShape>& given) {
    std::vector<PlacedShape> copy = given;
    try {
      ask(asked, input, copy);
    }
    catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::vector<PlacedShape> uneven = obstacles;
  uneven[1].path->pop_back();
  EXPECT_THAT(refusal(question, uneven), HasSubstr("obstacle 1: has a path of 3 poses, and obstacle 0 of 4: give all"));
  const auto all = [](std::uint32_t, std::uint32_t) { return true; };
  EXPECT_THROW(askBetween(question, uneven, all), InvalidInput);
  uneven[1].path.reset();
  EXPECT_THAT(refusal(question, uneven), HasSubstr("has a path of 0 poses"));
  Question moving = question;
  moving.path.emplace(2, Eigen::Isometry3d::Identity());
  EXPECT_THAT(refusal(moving, obstacles), HasSubstr("obstacle 0: has a path, and the question, too"));
  EXPECT_EQ(refusal(question, obstacles), "");
}

} // namespace
} // namespace pcl_bsh
