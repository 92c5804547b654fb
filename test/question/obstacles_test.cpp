// SPDX-License-Identifier: BSD-3-Clause
// Several obstacles against one cloud of all their points, and against questions about one at a time.
#include <pcl_bsh/question/obstacles.h>
#include <pcl_bsh/question/options.h>

#include "support/made_meshes.h"
#include "support/random_clouds.h"

#include <pcl_bsh/hierarchy/triangles_view.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A scan and three obstacles at places that floats hold exactly, and all obstacles as one cloud.
struct Crowd {
  explicit Crowd(std::uint64_t seed) : random(seed)
  {
    scan = test::makePoints(test::Shape::uniform, 1200, 1.0, random);
    scan[7][0] = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 0; k < 3; ++k) {
      places.push_back(test::makePoints(test::Shape::uniform, 150 + 40 * k, 0.3, random));
      for (Point3& place : places[k])
        for (double& x : place) x = std::round(x * 1024) / 1024;
      shifts.emplace_back(0.5 * static_cast<double>(k) - 0.5, 0.25, 0.125);
      for (const Point3& p : places[k])
        together.push_back({p[0] + shifts[k].x(), p[1] + shifts[k].y(), p[2] + shifts[k].z()});
    }
  }

  std::vector<PlacedShape> obstacles() const
  {
    std::vector<PlacedShape> all;
    for (std::size_t k = 0; k < places.size(); ++k) {
      all.push_back({Shape("obstacle " + std::to_string(k), viewOf(places[k][0].data(), places[k].size()))});
      all.back().pose.translation() = shifts[k];
    }
    return all;
  }

  Shape input() const { return {"scan", viewOf(scan[0].data(), scan.size())}; }
  Shape union_() const { return {"all", viewOf(together[0].data(), together.size())}; }

  /// The obstacle that has this record of the cloud of all.
  std::uint32_t obstacleOf(std::uint32_t record) const
  {
    std::uint32_t k = 0;
    for (; record >= places[k].size(); ++k) record -= static_cast<std::uint32_t>(places[k].size());
    return k;
  }

  test::Random random;
  std::vector<Point3> scan, together;
  std::vector<std::vector<Point3>> places;
  std::vector<Eigen::Vector3d> shifts;
};

constexpr auto any_two = [](std::uint32_t, std::uint32_t) { return true; };

Question contactsWithin(double clearance)
{
  Question question;
  question.clearance = clearance;
  question.wanted.flags = question.wanted.contacts = question.wanted.closest = true;
  return question;
}

template <class T>
void expectSame(const std::vector<T>& found, const std::vector<T>& expected)
{
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] == expected[i]) continue;
    EXPECT_TRUE(found[i] != found[i] && expected[i] != expected[i]) << i; // NaN
  }
}

TEST(Obstacles, AnswerAsTheCloudOfAllTheirPoints)
{
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Crowd crowd(seed);
    Shape input = crowd.input(), together = crowd.union_();
    std::vector<PlacedShape> obstacles = crowd.obstacles();
    const Question question = contactsWithin(0.05);
    const ObstaclesAnswer found = ask(question, input, obstacles);
    const Answer expected = ask(question, input, together);
    EXPECT_GT(expected.collisions.colliding, 0U);
    EXPECT_EQ(found.all.collisions.colliding, expected.collisions.colliding);
    expectSame(found.all.collisions.flags, expected.collisions.flags);
    expectSame(found.all.collisions.distance, expected.collisions.distance);
    expectSame(found.all.collisions.first_pose, expected.collisions.first_pose);
    EXPECT_EQ(found.all.closest.distance, expected.closest.distance);
    ASSERT_TRUE(expected.closest.pair);
    EXPECT_EQ(found.all.closest.pair->a, expected.closest.pair->a);
    EXPECT_EQ(found.closest, crowd.obstacleOf(expected.closest.pair->b));
    for (std::size_t i = 0; i < crowd.scan.size(); ++i) {
      const std::uint32_t nearest = expected.collisions.closest_point[i];
      if (nearest == kNothing)
        EXPECT_EQ(found.closest_obstacle[i], kNothing);
      else
        EXPECT_EQ(found.closest_obstacle[i], crowd.obstacleOf(nearest));
    }
  }
}

TEST(Obstacles, FollowAPathTogether)
{
  const Crowd crowd(11);
  Shape input = crowd.input(), together = crowd.union_();
  std::vector<PlacedShape> obstacles = crowd.obstacles();
  Question question = contactsWithin(0.06);
  std::vector<Eigen::Isometry3d> path(4, Eigen::Isometry3d::Identity());
  for (std::size_t k = 0; k < path.size(); ++k) path[k].translation().x() = 0.25 * static_cast<double>(k) - 1.0;
  question.path = path;
  const ObstaclesAnswer found = ask(question, input, obstacles);
  const Answer expected = ask(question, input, together);
  EXPECT_GT(expected.collisions.colliding, 0U);
  expectSame(found.all.collisions.flags, expected.collisions.flags);
  expectSame(found.all.collisions.distance, expected.collisions.distance);
  expectSame(found.all.collisions.first_pose, expected.collisions.first_pose);
  expectSame(found.all.collisions.closest_pose, expected.collisions.closest_pose);
  question.swept = 1e-3;
  const ObstaclesAnswer swept = ask(question, input, obstacles);
  const Answer swept_together = ask(question, input, together);
  expectSame(swept.all.collisions.flags, swept_together.collisions.flags);
  ASSERT_TRUE(swept.all.collisions.first_contact);
  EXPECT_EQ(swept.all.collisions.first_contact->pose, swept_together.collisions.first_contact->pose);
}

TEST(Obstacles, MeasureToTheNearestOfAll)
{
  const Crowd crowd(12);
  Shape input = crowd.input(), together = crowd.union_();
  std::vector<PlacedShape> obstacles = crowd.obstacles();
  for (const double least : {0.0, 0.1}) {
    Question question;
    question.wanted.distances = question.wanted.within = true;
    question.limits = {least, 0.4};
    const ObstaclesAnswer found = ask(question, input, obstacles);
    const Answer expected = ask(question, input, together);
    expectSame(found.all.distances.a.distance, expected.distances.a.distance);
    EXPECT_EQ(found.all.within, expected.within);
    EXPECT_EQ(found.all.distances.a.measured, expected.distances.a.measured);
    EXPECT_EQ(found.all.distances.a.greatest, expected.distances.a.greatest);
    EXPECT_EQ(found.all.distances.a.greatest_pair->a, expected.distances.a.greatest_pair->a);
  }
}

TEST(Obstacles, ListWhatCollidesOnce)
{
  const Crowd crowd(13);
  Shape input = crowd.input(), together = crowd.union_();
  std::vector<PlacedShape> obstacles = crowd.obstacles();
  Question question;
  question.clearance = 0.08;
  question.wanted.indices = question.wanted.any = true;
  const ObstaclesAnswer found = ask(question, input, obstacles);
  std::vector<std::int32_t> expected = ask(question, input, together).indices.a;
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(found.all.indices.a, expected);
  EXPECT_EQ(found.all.any.verdict, Verdict::colliding);
}

TEST(Obstacles, AreToldOneByOneAsIfAskedAlone)
{
  const Crowd crowd(14);
  Shape input = crowd.input();
  std::vector<PlacedShape> obstacles = crowd.obstacles();
  obstacles[1].clearance = 0.0;
  obstacles[2].pose.translation().x() = 20.0; // far away
  std::vector<std::size_t> told;
  const Question question = contactsWithin(0.05);
  const ObstaclesAnswer found =
      ask(question, input, obstacles, [&](std::size_t i, const Question& asked, Answer& answer) {
        told.push_back(i);
        EXPECT_EQ(*asked.clearance, i == 1 ? 0.0 : 0.05);
        Shape alone = crowd.obstacles()[i].shape;
        const Answer expected = ask(asked, input, alone);
        EXPECT_EQ(answer.collisions.colliding, expected.collisions.colliding);
        Question however_far = asked;
        however_far.wanted = {};
        however_far.wanted.closest = true;
        EXPECT_FLOAT_EQ(static_cast<float>(answer.closest.distance),
                        static_cast<float>(ask(however_far, input, alone).closest.distance));
        if (expected.collisions.colliding > 0)
          expectSame(answer.collisions.distance, expected.collisions.distance);
        else
          EXPECT_THAT(answer.collisions.flags, IsEmpty());
      });
  EXPECT_THAT(told, ElementsAre(0U, 1U, 2U));
  EXPECT_EQ(found.each[0].verdict, Verdict::colliding);
  EXPECT_EQ(found.each[2].verdict, Verdict::free);
  EXPECT_GT(found.each[2].closest.distance, 15.0);
}

TEST(Obstacles, OneOfThemCostsAsMuchAsAskedAlone)
{
  const Crowd crowd(15);
  const Question question = contactsWithin(0.05);
  Shape input = crowd.input(), fresh = crowd.input();
  std::vector<PlacedShape> one = {crowd.obstacles()[0]};
  Shape alone = crowd.obstacles()[0].shape;
  const ObstaclesAnswer found = ask(question, input, one);
  const Answer expected = ask(questionOf(question, one[0]), fresh, alone);
  EXPECT_EQ(found.all.work.node_pairs, expected.work.node_pairs);
  EXPECT_EQ(found.all.work.leaf_pairs, expected.work.leaf_pairs);
  EXPECT_EQ(found.all.work.exact_decisions, expected.work.exact_decisions);
}

TEST(Obstacles, ThatAreFreeLeaveOneEntryPerRecord)
{
  const Crowd crowd(16);
  Shape input = crowd.input();
  std::vector<PlacedShape> obstacles = crowd.obstacles();
  for (PlacedShape& obstacle : obstacles) obstacle.pose.translation().x() += 50.0;
  const ObstaclesAnswer found = ask(contactsWithin(0.05), input, obstacles);
  EXPECT_EQ(found.all.collisions.flags.size(), crowd.scan.size());
  EXPECT_THAT(found.all.collisions.flags, Each(Verdict::free));
  EXPECT_EQ(found.all.collisions.distance.size(), crowd.scan.size());
  EXPECT_EQ(found.all.collisions.closest_pose.size(), crowd.scan.size());
  EXPECT_EQ(found.all.collisions.first_pose.size(), crowd.scan.size());
  EXPECT_EQ(found.closest_obstacle.size(), crowd.scan.size());
}

TEST(Obstacles, ThatAreFreeAlongAPathHaveTheirNearestPose)
{
  const Crowd crowd(18);
  Shape input = crowd.input();
  std::vector<PlacedShape> obstacles = crowd.obstacles();
  for (PlacedShape& obstacle : obstacles) obstacle.pose.translation().z() += 5.0;
  Question question = contactsWithin(0.05);
  question.path.emplace(3, Eigen::Isometry3d::Identity());
  for (std::size_t k = 0; k < 3; ++k) (*question.path)[k].translation().z() = k == 1 ? -1.0 : 0.5;
  const ObstaclesAnswer found = ask(question, input, obstacles);
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    EXPECT_EQ(found.each[k].verdict, Verdict::free);
    EXPECT_EQ(found.each[k].closest_pose, 1);
    Question at_pose;
    at_pose.pose = questionOf(question, obstacles[k]).path->at(1);
    at_pose.wanted.closest = true;
    EXPECT_EQ(found.each[k].closest.distance, ask(at_pose, input, obstacles[k].shape).closest.distance);
  }
}

TEST(Obstacles, StandAgainstEachOther)
{
  const test::TestMesh box = test::boxMesh(1, 1, 1);
  const Shape shape("box", viewOf(box.trianglesView()));
  std::vector<PlacedShape> boxes(3, {shape});
  boxes[1].pose.translation().x() = 0.5;
  boxes[2].pose.translation().x() = 4.0;
  Question question;
  question.clearance = 0.1;
  const std::vector<ObstaclePair> pairs = askBetween(question, boxes, any_two);
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_EQ(pairs[0].verdict, Verdict::colliding);
  EXPECT_EQ(pairs[1].verdict, Verdict::free);
  EXPECT_EQ(pairs[1].closest.distance, 3.0);
  boxes[2].clearance = 3.0;
  EXPECT_EQ(askBetween(question, boxes, any_two)[1].verdict, Verdict::colliding);
  EXPECT_THAT(askBetween(question, boxes, [](std::uint32_t, std::uint32_t) { return false; }), IsEmpty());
}

TEST(Obstacles, StandAgainstEachOtherOnAnyNumberOfThreads)
{
  const Crowd crowd(23);
  std::vector<PlacedShape> obstacles = crowd.obstacles();
  for (const PlacedShape& one : crowd.obstacles()) {
    obstacles.push_back(one);
    obstacles.back().pose.translation().z() += 0.4;
  }
  Question question;
  question.clearance = 0.125;
  const auto some = [](std::uint32_t i, std::uint32_t k) { return i + k != 4; };
  const std::vector<ObstaclePair> one = askBetween(question, obstacles, some);
  question.threads = 4;
  std::size_t told = 0;
  question.progress = [&](double done) { return ++told, done == 1.0; };
  const std::vector<ObstaclePair> four = askBetween(question, obstacles, some);
  ASSERT_EQ(one.size(), 13U);
  ASSERT_EQ(four.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(four[i].first, one[i].first);
    EXPECT_EQ(four[i].second, one[i].second);
    EXPECT_EQ(four[i].verdict, one[i].verdict);
    EXPECT_EQ(four[i].closest.distance, one[i].closest.distance);
  }
  EXPECT_GT(told, 0U);
  question.progress = [](double) { return false; };
  EXPECT_THROW(askBetween(question, obstacles, some), Cancelled);
}

/// A plate of many boxes, some of which touch their neighbours, within their own clearances.
TEST(Obstacles, OfManyThoseThatAreNearStandAgainstEachOther)
{
  constexpr std::uint32_t side = 45;
  const test::TestMesh box = test::boxMesh(1, 1, 1);
  test::Random random(29);
  std::vector<PlacedShape> boxes(side * side, {Shape("box", viewOf(box.trianglesView()))});
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    boxes[i].pose = Eigen::AngleAxisd(random.uniform(0, 0.2), Eigen::Vector3d::UnitZ());
    boxes[i].pose.translation() << 1.3 * (i / side), 1.3 * (i % side), random.uniform(0, 0.5);
    if (i % 100 == 7) boxes[i].clearance = 0.9;
    boxes[i].uncertainty = Uncertainty(i % 3 == 0 ? 0.05 : 0.0);
  }
  Question question;
  question.clearance = 0.25;
  question.threads = 2;
  std::size_t asked = 0;
  const auto count = [&](std::uint32_t i, std::uint32_t k) { return ++asked, i % 50 != 3 || k % 2 == 0; };
  const std::vector<ObstaclePair> found = askBetween(question, boxes, count);
  EXPECT_LT(asked, 8 * boxes.size()) << "of " << boxes.size() * boxes.size() / 2 << " pairs";
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < boxes.size(); i += 31) // each with all others, two at a time
    for (std::uint32_t k = i + 1; k < boxes.size(); ++k) {
      const bool counts = i % 50 != 3 || k % 2 == 0;
      const bool may_touch = (boxes[i].pose.translation() - boxes[k].pose.translation()).norm() < 3.0;
      const auto told = std::find_if(found.begin() + static_cast<std::ptrdiff_t>(at), found.end(),
                                     [&](const ObstaclePair& pair) { return pair.first == i && pair.second == k; });
      if (told != found.end()) at = static_cast<std::size_t>(told - found.begin());
      if (!counts || !may_touch) {
        EXPECT_EQ(told, found.end()) << i << ", " << k;
        continue;
      }
      const ObstaclePair alone = askBetween(question, {boxes[i], boxes[k]}, any_two)[0];
      ASSERT_EQ(told != found.end(), alone.verdict != Verdict::free) << i << ", " << k;
      if (told == found.end()) continue;
      EXPECT_EQ(told->verdict, alone.verdict);
      EXPECT_EQ(told->closest.distance, alone.closest.distance);
      EXPECT_EQ(told->clearance, alone.clearance);
    }
  EXPECT_GT(found.size(), boxes.size() / 2);
}

TEST(Obstacles, TellHowMuchOfEachOtherIsWithin)
{
  const test::TestMesh box = test::boxMesh(1, 1, 1);
  std::vector<PlacedShape> boxes(3, {Shape("box", viewOf(box.trianglesView()))});
  boxes[1].pose.translation() << 0.5, 0.0625, 0.75;
  boxes[2].pose.translation().x() = 4.0;
  boxes[0].solid = true;
  boxes[2].solid = true;
  Question question;
  question.clearance = 5.0;
  EXPECT_FALSE(askBetween(question, boxes, any_two)[0].second_within) << "it was not asked for";
  question.wanted.overlap = true;
  const std::vector<ObstaclePair> pairs = askBetween(question, boxes, any_two);
  ASSERT_TRUE(pairs[0].second_within);
  EXPECT_FALSE(pairs[0].first_within) << "the second is no solid";
  constexpr double expected = 0.5 * 0.9375 + 0.25 * 0.9375 + 0.5 * 0.25;
  EXPECT_LE(pairs[0].second_within->lower, expected);
  EXPECT_GE(pairs[0].second_within->upper, expected);
  EXPECT_EQ(pairs[1].first_within->upper, 0.0) << "near is not within";
  EXPECT_EQ(pairs[1].second_within->upper, 0.0);
  std::swap(boxes[0], boxes[1]);
  EXPECT_EQ(askBetween(question, boxes, any_two)[0].first_within->upper, pairs[0].second_within->upper);
}

TEST(Obstacles, TellProgressThatNeverFalls)
{
  const Crowd crowd(11);
  Question question = contactsWithin(0.05);
  double last = 0;
  question.progress = [&](double done) {
    EXPECT_GE(done, last);
    EXPECT_LE(done, 1);
    last = done;
    return true;
  };
  for (const bool along_a_path : {false, true}) {
    last = 0;
    if (along_a_path) question.path.emplace(3, Eigen::Isometry3d::Identity());
    Shape input = crowd.input();
    std::vector<PlacedShape> obstacles = crowd.obstacles();
    ask(question, input, obstacles);
    EXPECT_GT(last, 0.5) << "it is asked until the last one";
    last = 0;
    Question stopped = question;
    stopped.progress = [](double done) { return done < 0.5; };
    EXPECT_THROW(ask(stopped, input, obstacles), Cancelled);
  }
}

TEST(Obstacles, OfAListWithoutAnyAreRefused)
{
  const Crowd crowd(17);
  Shape input = crowd.input();
  std::vector<PlacedShape> none;
  EXPECT_THROW(ask(contactsWithin(0.1), input, none), InvalidInput);
  std::vector<PlacedShape> obstacles = crowd.obstacles();
  Question question = contactsWithin(0.1);
  question.wanted.obstacle_flags = true;
  EXPECT_THROW(ask(question, input, obstacles), InvalidInput);
  question = {};
  question.wanted.within = question.wanted.distances = true;
  question.limits = {0.1, 0.5};
  question.max_distance = 0.2;
  EXPECT_THROW(ask(question, input, obstacles), InvalidOption);
}

} // namespace
} // namespace pcl_bsh
