// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/pose_uncertainty.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/question/ask.h>

#include "support/random_clouds.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

/// One that the bound allows.
Eigen::Isometry3d sampled(const Eigen::Isometry3d& pose, const PoseUncertainty& bound, test::Random& random)
{
  const auto direction = [&] { return (random.rotation() * Eigen::Vector3d::UnitX()).eval(); };
  const double most = random.chance(0.5) ? 1.0 : random.uniform(0, 1);
  const Eigen::Vector3d about(bound.about.data());
  const Eigen::Isometry3d turned(Eigen::Translation3d(about + most * bound.length * (1 - 1e-12) * direction()) *
                                 Eigen::AngleAxisd(most * bound.angle * (1 - 1e-12), direction()) *
                                 Eigen::Translation3d(-about));
  return pose * turned;
}

struct Tried {
  std::vector<float> scan, robot;
  Question question;
  std::vector<Eigen::Isometry3d> path;

  explicit Tried(std::uint64_t seed)
  {
    test::Random random(seed);
    for (int i = 0; i < 3 * 300; ++i) scan.push_back(static_cast<float>(random.uniform(-2, 2)));
    for (int i = 0; i < 3 * 40; ++i) robot.push_back(static_cast<float>(random.uniform(-0.7, 0.7)));
    question.clearance = 0.3;
    question.pose_uncertainty = {0.05, random.uniform(0.0, 0.15), {0.2, -0.1, 0.3}};
    question.wanted.flags = true;
    for (int k = 0; k < 3; ++k) path.push_back(random.pose(1.0));
  }

  Shape scanShape() const { return {"scan", viewOf(scan.data(), scan.size() / 3)}; }
  Shape robotShape() const { return {"robot", viewOf(robot.data(), robot.size() / 3)}; }

  std::vector<Verdict> flags(const Question& asked) const
  {
    Shape a = scanShape(), b = robotShape();
    return ask(asked, a, b).collisions.flags;
  }
};

/// No verdict but undecided is other at a pose within the bound.
void expectNoContradiction(const std::vector<Verdict>& verdicts, const std::vector<Verdict>& at_sample)
{
  ASSERT_EQ(verdicts.size(), at_sample.size());
  for (std::size_t i = 0; i < verdicts.size(); ++i)
    EXPECT_TRUE(verdicts[i] == Verdict::undecided || verdicts[i] == at_sample[i]) << i;
}

TEST(PoseUncertainty, NoPoseWithinItContradictsAVerdict)
{
  std::size_t free_points = 0, colliding = 0, undecided = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Tried tried(seed);
    test::Random random(seed + 100);
    Question certain = tried.question;
    certain.pose_uncertainty = {};
    for (const bool moves : {false, true}) {
      Question asked = tried.question;
      if (moves)
        asked.path = tried.path;
      else
        asked.pose = tried.path.front();
      const auto verdicts = tried.flags(asked);
      free_points += countOf(verdicts, Verdict::free);
      colliding += countOf(verdicts, Verdict::colliding);
      undecided += countOf(verdicts, Verdict::undecided);
      for (int sample = 0; sample < 100; ++sample) {
        certain.path.reset();
        certain.pose = sampled(asked.pose, asked.pose_uncertainty, random);
        if (moves) {
          certain.path = tried.path;
          for (Eigen::Isometry3d& pose : *certain.path) pose = sampled(pose, asked.pose_uncertainty, random);
        }
        expectNoContradiction(verdicts, tried.flags(certain));
      }
    }
  }
  EXPECT_GT(free_points, 300u);
  EXPECT_GT(colliding, 150u);
  EXPECT_GT(undecided, 300u);
}

TEST(PoseUncertainty, HoldsOfSweptMotion)
{
  const Tried tried(3);
  test::Random random(5);
  Question asked = tried.question;
  asked.path = tried.path;
  asked.swept = 0.05;
  const auto verdicts = tried.flags(asked);
  Question certain = asked;
  certain.pose_uncertainty = {};
  for (int sample = 0; sample < 30; ++sample) {
    for (std::size_t k = 0; k < tried.path.size(); ++k)
      (*certain.path)[k] = sampled(tried.path[k], asked.pose_uncertainty, random);
    certain.swept = 0.0;
    const auto at_poses = tried.flags(certain); // some instants of the motion
    for (std::size_t i = 0; i < verdicts.size(); ++i)
      EXPECT_TRUE(verdicts[i] != Verdict::free || at_poses[i] == Verdict::free) << i;
  }
}

TEST(PoseUncertainty, HoldsOfListsOfPoses)
{
  const Tried tried(4);
  test::Random random(6);
  const PointsView robot = viewOf(tried.robot.data(), tried.robot.size() / 3);
  Uncertainty uncertainty;
  uncertainty.pose = tried.question.pose_uncertainty;
  const SphereHierarchy scan(viewOf(tried.scan.data(), tried.scan.size() / 3));
  const SphereHierarchy exact(robot), uncertain(withUncertainty(robot, {}, "robot", uncertainty));
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 200; ++k) poses.push_back(random.pose(6.0));
  AnyRequest request;
  request.clearance = 0.3;
  const auto verdicts = anyCollisionAtPoses({scan}, uncertain, poses, request).flags;
  for (int sample = 0; sample < 30; ++sample) {
    std::vector<Eigen::Isometry3d> others;
    for (const Eigen::Isometry3d& pose : poses) others.push_back(sampled(pose, uncertainty.pose, random));
    expectNoContradiction(verdicts, anyCollisionAtPoses({scan}, exact, others, request).flags);
  }
}

TEST(PoseUncertainty, MovesPointsByItsBound)
{
  const PoseUncertainty bound{0.1, 1.0, {1, 2, 3}};
  EXPECT_EQ(bound.turned({1, 2, 3}, 0.0), 0.0);
  EXPECT_NEAR(bound.turned({1, 2, 5}, 0.5), 2 * std::sin(0.5) * 2.5, 1e-9);
  EXPECT_GE(bound.turned({1, 2, 5}, 0.5), 2 * std::sin(0.5) * 2.5);
  EXPECT_NEAR((PoseUncertainty{0, 7.0, {0, 0, 0}}.turned({3, 4, 0}, 0.0)), 10.0, 1e-9); // half a turn is the worst
  const float place[] = {1, 2, 5};
  Uncertainty all(0.25);
  all.pose = bound;
  const PointsView view = withUncertainty(viewOf(place, 1), {}, "cloud", all);
  const double moved = view.uncertainty + view.ownUncertainty(0);
  EXPECT_GE(moved, 0.35 + 4 * std::sin(0.5));
  EXPECT_NEAR(moved, 0.35 + 4 * std::sin(0.5), 1e-6);
}

TEST(PoseUncertainty, RefusesNumbersThatAreNone)
{
  Uncertainty good(0.25);
  good.pose = {0.1, 1.0, {1, 2, 3}};
  EXPECT_NO_THROW(checkUncertainty("cloud", good));
  const std::vector<std::function<double&(Uncertainty&)>> numbers = {
      [](Uncertainty& u) -> double& { return u.length; }, [](Uncertainty& u) -> double& { return u.sigmas; },
      [](Uncertainty& u) -> double& { return u.pose.length; }, [](Uncertainty& u) -> double& { return u.pose.angle; }};
  for (const auto& number : numbers)
    for (const double value :
         {-0x1p-1074, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      Uncertainty bad = good;
      number(bad) = value;
      EXPECT_THROW(checkUncertainty("cloud", bad), std::invalid_argument) << value;
    }
}

TEST(PoseUncertainty, AddsToWhatPointsHave)
{
  const float place[] = {1, 2, 5}, own[] = {0.5f};
  PointsView given = viewOf(place, 1);
  given.uncertainty = 0.125;
  given.uncertainties = own;
  Uncertainty all(0.25);
  const auto moved = [&] {
    const PointsView view = withUncertainty(given, {}, "cloud", all);
    return view.uncertainty + view.ownUncertainty(0);
  };
  EXPECT_NEAR(moved(), 0.875, 1e-12);
  EXPECT_GE(moved(), 0.875);
  all.pose = {0.1, 1.0, {1, 2, 3}};
  EXPECT_NEAR(moved(), 0.975 + 4 * std::sin(0.5), 1e-6);
  EXPECT_GE(moved(), 0.975 + 4 * std::sin(0.5));
}

/// Double coordinates: a length that no float holds.
TEST(PoseUncertainty, RefusesToMovePointsByMoreThanAFloatHolds)
{
  const double places[] = {1, 2, 5, NAN, 0, 0, 1e39, 0, 0};
  Uncertainty all;
  all.pose = {0.0, 1.0, {0, 0, 0}};
  EXPECT_NO_THROW(withUncertainty(viewOf(places, 2), {}, "cloud", all));
  EXPECT_THAT([&] { withUncertainty(viewOf(places, 3), {}, "cloud", all); },
              testing::ThrowsMessage<InvalidInput>(
                  HasSubstr("cloud: point 2 may move by inf: give finite lengths >= 0, no more than 3.4")));
}

TEST(PoseUncertainty, MakesAQuestionUncertain)
{
  EXPECT_FALSE(Question().isUncertain());
  for (PoseUncertainty Question::*const pose : {&Question::pose_uncertainty, &Question::input_pose_uncertainty})
    for (const PoseUncertainty& bound : {PoseUncertainty{0.1, 0.0}, PoseUncertainty{0.0, 0.1}}) {
      Question question;
      question.*pose = bound;
      EXPECT_TRUE(question.isUncertain());
    }
  for (Uncertainty Question::*const points : {&Question::uncertainty, &Question::obstacle_uncertainty}) {
    Question question;
    question.*points = 0.1;
    EXPECT_TRUE(question.isUncertain());
    question.*points = {"sigma", 1.0};
    EXPECT_TRUE(question.isUncertain());
  }
}

std::string refusalOf(const std::string& text)
{
  try {
    PoseUncertainty::parse(text);
  }
  catch (const InvalidInput& error) {
    return error.what();
  }
  return {};
}

TEST(PoseUncertainty, ReadsItsText)
{
  const PoseUncertainty all{0.01, 0.002, {1, -2, 3.5}};
  EXPECT_TRUE(PoseUncertainty::parse(all.text()) == all);
  EXPECT_TRUE(PoseUncertainty::parse("0.01") == (PoseUncertainty{0.01}));
  EXPECT_TRUE(PoseUncertainty::parse("0.01,0.002") == (PoseUncertainty{0.01, 0.002}));
  EXPECT_TRUE(PoseUncertainty::parse("") == PoseUncertainty());
  EXPECT_TRUE(PoseUncertainty::parse("0,0.002") == (PoseUncertainty{0.0, 0.002}));
  EXPECT_EQ(PoseUncertainty().text(), "");
  const PoseUncertainty others[] = {
      {0.02, 0.002, {1, -2, 3.5}}, {0.01, 0.003, {1, -2, 3.5}}, {0.01, 0.002, {1, -2, 3}}};
  for (const PoseUncertainty& other : others) EXPECT_FALSE(other == all) << other.text();
  for (const char* wrong :
       {"a", "1,2,3", "-1", "1,-1", "nan", "1,inf", "covariance=3", "covariance=3:1,2", "1,,2", "1m"})
    EXPECT_THAT(refusalOf(wrong), HasSubstr(std::string("pose uncertainty: '") + wrong + "' is none: give T")) << wrong;
  std::string numbers = ":0";
  for (int i = 1; i < 36; ++i) numbers += ",0";
  EXPECT_EQ(refusalOf("covariance=3" + numbers), "");
  for (const std::string& wrong : {"covariance=" + numbers, "covariance=x" + numbers, "covariance=1,2" + numbers,
                                   "covariance=3" + numbers + ",0", "covariance=3" + numbers + "x"})
    EXPECT_THAT(refusalOf(wrong), HasSubstr("' is none: give T")) << wrong;
}

TEST(PoseUncertainty, IsComputedFromACovariance)
{
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  covariance.diagonal() << 1e-4, 4e-4, 9e-4, 1e-6, 4e-6, 1e-6;
  const PoseUncertainty bound = PoseUncertainty::of(covariance, 3.0, {1, 0, 0});
  EXPECT_NEAR(bound.length, 0.09, 1e-9);
  EXPECT_NEAR(bound.angle, 0.006, 1e-9);
  EXPECT_EQ(bound.about, (Point3{1, 0, 0}));
  const PoseUncertainty tiny = PoseUncertainty::of(1e-16 * covariance, 3.0);
  EXPECT_NEAR(tiny.length, 9e-10, 1e-15);
  EXPECT_NEAR(tiny.angle, 6e-11, 1e-16);
  for (const double scale : {1e-16, 1.0, 1e16}) { // by how much it may be off in its last digits
    Eigen::Matrix<double, 6, 6> rounded = covariance;
    rounded(0, 1) = 5e-10;
    EXPECT_NO_THROW(PoseUncertainty::of(scale * rounded, 3.0));
    rounded(0, 1) = 5e-9;
    EXPECT_THROW(PoseUncertainty::of(scale * rounded, 3.0), InvalidInput) << scale;
  }
  std::string text = "covariance=3:";
  for (int i = 0; i < 36; ++i) text += (i == 0 ? "" : ",") + std::to_string(covariance(i / 6, i % 6));
  EXPECT_NEAR(PoseUncertainty::parse(text).length, 0.09, 1e-3);
  covariance(0, 1) = 1.0;
  EXPECT_THROW(PoseUncertainty::of(covariance, 3.0), InvalidInput); // not symmetric
  covariance(1, 0) = 1.0;
  EXPECT_THROW(PoseUncertainty::of(covariance, 3.0), InvalidInput); // a negative variance
  EXPECT_THROW(PoseUncertainty::of(Eigen::Matrix<double, 6, 6>::Identity(), -1.0), InvalidInput);
  EXPECT_THROW(PoseUncertainty::of(Eigen::Matrix<double, 6, 6>::Identity(), INFINITY), InvalidInput);
  for (const double none : {std::nan(""), static_cast<double>(INFINITY)}) {
    Eigen::Matrix<double, 6, 6> without_a_number = Eigen::Matrix<double, 6, 6>::Identity();
    without_a_number(0, 5) = none; // in neither block
    EXPECT_THAT(
        [&] { PoseUncertainty::of(without_a_number, 1.0); },
        testing::ThrowsMessage<InvalidInput>(HasSubstr("covariance has numbers that are not finite: give 6 x")));
  }
}

} // namespace
} // namespace pcl_bsh
