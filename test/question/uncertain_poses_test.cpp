// SPDX-License-Identifier: BSD-3-Clause
// A hundred thousand poses within the bound of each kind of question: none contradicts what was called free or
// colliding.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/question/pose_uncertainty.h>
#include <pcl_bsh/scene/scene.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace pcl_bsh {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

constexpr int kSamples = 100000;
constexpr double kClearance = 0.3;

std::vector<double> pointsWithin(double half, int count, test::Random& random)
{
  std::vector<double> xyz;
  for (int i = 0; i < 3 * count; ++i) xyz.push_back(random.uniform(-half, half));
  return xyz;
}

/// One that the bound allows, as turned and shifted in the body's frame: half of them as far as it allows.
Eigen::Isometry3d errorWithin(const PoseUncertainty& bound, test::Random& random)
{
  const auto direction = [&] { return (random.rotation() * Eigen::Vector3d::UnitX()).eval(); };
  const double most = random.chance(0.5) ? 1.0 - 1e-12 : random.uniform(0, 1);
  const Eigen::Vector3d about(bound.about.data());
  return Eigen::Isometry3d(Eigen::Translation3d(about + most * bound.length * direction()) *
                           Eigen::AngleAxisd(most * bound.angle, direction()) * Eigen::Translation3d(-about));
}

class UncertainPoses : public testing::Test {
protected:
  UncertainPoses()
  {
    for (int k = 0; k < 8; ++k) {
      path.push_back(random.pose(1.0));
      path.back().linear() =
          Eigen::Quaterniond(path.back().linear()).slerp(0.7, Eigen::Quaterniond::Identity()).matrix();
    }
    question.clearance = kClearance;
    question.pose_uncertainty = {0.04, 0.06, {0.2, -0.1, 0.3}};
    question.wanted.flags = true;
  }

  Answer asked(const Question& what) const
  {
    Shape a("scan", view(scan)), b("robot", view(robot));
    return ask(what, a, b);
  }

  static PointsView view(const std::vector<double>& xyz) { return viewOf(xyz.data(), xyz.size() / 3); }
  static PointsView view(const std::vector<double>& xyz, const PoseUncertainty& pose)
  {
    Uncertainty uncertainty;
    uncertainty.pose = pose;
    return withUncertainty(view(xyz), {}, "cloud", uncertainty);
  }

  static bool collides(const double* p, const Eigen::Isometry3d& pose_p, const double* q,
                       const Eigen::Isometry3d& pose_q)
  {
    const SphereHierarchy a(viewOf(p, 1)), b(viewOf(q, 1));
    return brute_force::anyCollision({a, pose_p}, {b, pose_q}, {kClearance, 1}).verdict == Verdict::colliding;
  }

  /// Which points of the scan collide at exact poses: by doubles, and where these leave it open, exactly.
  void addColliding(const Eigen::Isometry3d& of_scan, const Eigen::Isometry3d& of_robot, std::vector<char>& found) const
  {
    const Eigen::Isometry3d between = of_scan.inverse() * of_robot;
    std::vector<Eigen::Vector3d> placed;
    for (std::size_t j = 0; j < robot.size(); j += 3) placed.push_back(between * Eigen::Vector3d(&robot[j]));
    for (std::size_t i = 0; i < scan.size() / 3; ++i) {
      for (std::size_t j = 0; j < placed.size() && !found[i]; ++j) {
        const double distance = (placed[j] - Eigen::Vector3d(&scan[3 * i])).norm();
        if (std::abs(distance - kClearance) < 1e-9)
          found[i] = collides(&scan[3 * i], of_scan, &robot[3 * j], of_robot);
        else
          found[i] = distance < kClearance;
      }
    }
  }

  std::vector<char> colliding(const Eigen::Isometry3d& of_scan, const Eigen::Isometry3d& of_robot) const
  {
    std::vector<char> found(scan.size() / 3, 0);
    addColliding(of_scan, of_robot, found);
    return found;
  }

  /// The smallest distance of any two points.
  double distance(const Eigen::Isometry3d& of_robot) const
  {
    double least = 1e9;
    for (std::size_t j = 0; j < robot.size(); j += 3) {
      const Eigen::Vector3d q = of_robot * Eigen::Vector3d(&robot[j]);
      for (std::size_t i = 0; i < scan.size(); i += 3) least = std::min(least, (Eigen::Vector3d(&scan[i]) - q).norm());
    }
    return least;
  }

  void judge(const std::vector<Verdict>& verdicts, const std::vector<char>& found)
  {
    ASSERT_EQ(verdicts.size(), found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      contradicted += verdicts[i] == Verdict::free && found[i];
      contradicted += verdicts[i] == Verdict::colliding && !found[i];
    }
  }

  /// The question can be answered each way, so that something was tested.
  static void expectAllVerdicts(const std::vector<Verdict>& verdicts)
  {
    for (const Verdict verdict : {Verdict::free, Verdict::colliding, Verdict::undecided})
      EXPECT_GT(countOf(verdicts, verdict), 0u) << static_cast<int>(verdict);
  }

  test::Random random{7};
  std::vector<double> scan = pointsWithin(1.5, 60, random), robot = pointsWithin(0.6, 25, random);
  Poses path;
  Question question;
  std::size_t contradicted = 0;
};

TEST_F(UncertainPoses, OfTheObstacleAndOfTheInputContradictNoFlag)
{
  question.input_pose_uncertainty = {0.02, 0.03, {-0.5, 0, 0}};
  question.pose = path.front();
  const std::vector<Verdict> verdicts = asked(question).collisions.flags;
  expectAllVerdicts(verdicts);
  for (int sample = 0; sample < kSamples; ++sample) {
    judge(verdicts, colliding(errorWithin(question.input_pose_uncertainty, random),
                              question.pose * errorWithin(question.pose_uncertainty, random)));
  }
  EXPECT_EQ(contradicted, 0u);
}

TEST_F(UncertainPoses, OfAPathContradictNoFlag)
{
  question.path = path;
  const std::vector<Verdict> verdicts = asked(question).collisions.flags;
  expectAllVerdicts(verdicts);
  for (int sample = 0; sample < kSamples / 8; ++sample) {
    std::vector<char> found(verdicts.size(), 0);
    for (const Eigen::Isometry3d& pose : path)
      addColliding(Eigen::Isometry3d::Identity(), pose * errorWithin(question.pose_uncertainty, random), found);
    judge(verdicts, found);
  }
  EXPECT_EQ(contradicted, 0u);
}

/// At each instant the pose is off by what the bound allows, now one way, now another.
TEST_F(UncertainPoses, OfSweptMotionContradictNoFlag)
{
  question.path = path;
  question.swept = 0.05;
  const std::vector<Verdict> verdicts = asked(question).collisions.flags;
  expectAllVerdicts(verdicts);
  constexpr int steps = 40;
  for (int sample = 0; sample < kSamples / (7 * steps); ++sample) {
    std::vector<char> found(verdicts.size(), 0);
    std::vector<double> nearest(verdicts.size(), 1e9);
    const Eigen::Isometry3d error = errorWithin(question.pose_uncertainty, random); // all the way
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      for (int step = 0; step < steps; ++step) {
        const Eigen::Isometry3d pose = poseBetween(path[k], path[k + 1], (step + 0.5) / steps);
        addColliding(Eigen::Isometry3d::Identity(), pose * errorWithin(question.pose_uncertainty, random), found);
        for (std::size_t j = 0; j < robot.size(); j += 3) {
          const Eigen::Vector3d q = pose * error * Eigen::Vector3d(&robot[j]);
          for (std::size_t i = 0; i < nearest.size(); ++i)
            nearest[i] = std::min(nearest[i], (Eigen::Vector3d(&scan[3 * i]) - q).norm());
        }
      }
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      contradicted += verdicts[i] == Verdict::free && found[i];
      // Between two instants a point moves by less than 0.1.
      contradicted += verdicts[i] == Verdict::colliding && nearest[i] > kClearance + question.swept + 0.1;
    }
  }
  EXPECT_EQ(contradicted, 0u);
}

TEST_F(UncertainPoses, OfListsContradictNoVerdict)
{
  const SphereHierarchy exact(view(scan)), uncertain(view(robot, question.pose_uncertainty));
  Poses poses;
  for (int k = 0; k < 500; ++k) poses.push_back(random.pose(3.0));
  AnyRequest request;
  request.clearance = kClearance;
  const std::vector<Verdict> verdicts = anyCollisionAtPoses({exact}, uncertain, poses, request).flags;
  expectAllVerdicts(verdicts);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    for (int sample = 0; sample < kSamples / 500; ++sample) {
      const auto found =
          colliding(Eigen::Isometry3d::Identity(), poses[k] * errorWithin(question.pose_uncertainty, random));
      judge({verdicts[k]}, {std::count(found.begin(), found.end(), 1) > 0 ? char(1) : char(0)});
    }
  }
  EXPECT_EQ(contradicted, 0u);
}

TEST_F(UncertainPoses, OfListsOfMotionsContradictNoVerdict)
{
  const SphereHierarchy exact(view(scan)), uncertain(view(robot, question.pose_uncertainty));
  Poses poses;
  std::vector<PoseMotion> motions;
  for (std::uint32_t k = 0; k < 200; ++k) {
    poses.push_back(random.pose(3.0));
    poses.push_back(poses.back() * Eigen::Translation3d{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0} *
                    Eigen::AngleAxisd(random.uniform(-0.5, 0.5), Eigen::Vector3d::UnitZ()));
    motions.push_back({2 * k, 2 * k + 1});
  }
  MotionsRequest request;
  request.clearance = kClearance;
  request.swept = 0.02;
  const std::vector<Verdict> verdicts = anyCollisionOnMotions({exact}, uncertain, poses, motions, request).flags;
  expectAllVerdicts(verdicts);
  constexpr int steps = 20;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    for (int sample = 0; sample < kSamples / (200 * steps); ++sample) {
      double nearest = 1e9;
      const Eigen::Isometry3d error = errorWithin(question.pose_uncertainty, random);
      for (int step = 0; step < steps; ++step) {
        const Eigen::Isometry3d pose = poseBetween(poses[2 * m], poses[2 * m + 1], (step + 0.5) / steps);
        nearest = std::min(nearest, distance(pose * error));
      }
      contradicted += verdicts[m] == Verdict::free && nearest <= kClearance - 1e-9;
      contradicted += verdicts[m] == Verdict::colliding && nearest > kClearance + request.swept + 0.1;
    }
  }
  EXPECT_EQ(contradicted, 0u);
}

TEST_F(UncertainPoses, OfObjectsInAScene)
{
  const auto hall = std::make_shared<SphereHierarchy>(view(scan)),
             machine = std::make_shared<SphereHierarchy>(view(robot, question.pose_uncertainty));
  std::vector<Verdict> all;
  for (int k = 0; k < 100; ++k) {
    const Eigen::Isometry3d pose = random.pose(3.0);
    SceneOptions options;
    options.clearance = kClearance;
    options.effects.any = options.effects.flags = true;
    Scene scene(options);
    scene.add(fixedObject("hall", hall));
    scene.add(object("machine", machine, pose));
    const SceneResult result = scene.query();
    std::vector<Verdict> verdicts(scan.size() / 3, Verdict::free);
    for (const FlaggedPart& part : result.flags)
      if (part.object == 0) verdicts = part.flags;
    const Verdict any = !result.any.empty()         ? Verdict::colliding
                        : !result.undecided.empty() ? Verdict::undecided
                                                    : Verdict::free;
    all.push_back(any);
    for (int sample = 0; sample < kSamples / 100; ++sample) {
      const auto found =
          colliding(Eigen::Isometry3d::Identity(), pose * errorWithin(question.pose_uncertainty, random));
      judge(verdicts, found);
      judge({any}, {std::count(found.begin(), found.end(), 1) > 0 ? char(1) : char(0)});
    }
  }
  expectAllVerdicts(all);
  EXPECT_EQ(contradicted, 0u);
}

} // namespace
} // namespace pcl_bsh
