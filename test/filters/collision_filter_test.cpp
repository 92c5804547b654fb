// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/collision_filter.h>

#include "clouds.h"
#include "support/verdicts.h"

#include <pcl/filters/voxel_grid.h>
#include <pcl/impl/point_types.hpp>
#include <pcl/point_types.h>

#include <boost/preprocessor/seq/enum.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace pcl_bsh {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

using Cloud = pcl::PointCloud<pcl::PointXYZI>;
using Filter = CollisionFilter<pcl::PointXYZI>;

constexpr double clearance = 0.08;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

auto refusedWith(const std::string& text)
{
  return ThrowsMessage<std::invalid_argument>(HasSubstr(text));
}

/// Two clouds that overlap in part. The input has points that are not finite, and says that it is dense.
class CollisionFilterTest : public testing::Test {
protected:
  CollisionFilterTest()
  {
    points_[7].x() = nan;
    points_[31] = {0, std::numeric_limits<double>::infinity(), 0};
    flags_ = doubleLoop(points_, obstacle_, pose_, clearance);

    input_ = typedCloud<pcl::PointXYZI>(points_);
    input_->is_dense = true;
    for (std::size_t i = 0; i < input_->size(); ++i) (*input_)[i].intensity = static_cast<float>(i);

    filter_.setInputCloud(input_);
    filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>(obstacle_));
    filter_.setPose(pose_);
    filter_.setClearance(clearance);
  }

  pcl::Indices filtered()
  {
    pcl::Indices indices;
    filter_.filter(indices);
    return indices;
  }

  void expectSelected(const Cloud& output, const pcl::Indices& expected) const
  {
    ASSERT_EQ(output.size(), expected.size());
    EXPECT_EQ(output.width, expected.size());
    EXPECT_EQ(output.height, 1u);
    EXPECT_EQ(output.header.frame_id, input_->header.frame_id);
    for (std::size_t i = 0; i < output.size(); ++i) {
      EXPECT_EQ(output[i].getVector3fMap(), (*original_)[at(expected, i)].getVector3fMap());
      EXPECT_EQ(output[i].intensity, static_cast<float>(expected[i]));
    }
  }

  static std::size_t at(const pcl::Indices& indices, std::size_t i) { return static_cast<std::size_t>(indices[i]); }

  Points points_ = randomPoints(700, 1);
  const Points obstacle_ = randomPoints(600, 2);
  const Eigen::Isometry3d pose_ = somePose();
  std::vector<Verdict> flags_;
  Cloud::Ptr original_ = typedCloud<pcl::PointXYZI>(points_);
  Cloud::Ptr input_;
  Filter filter_{true};
};

TEST_F(CollisionFilterTest, RemovesWhatCollides)
{
  const pcl::Indices expected = where(flags_, false, points_);
  ASSERT_GT(expected.size(), 100u);
  ASSERT_LT(expected.size(), 600u);

  EXPECT_EQ(filtered(), expected);
  Cloud output;
  filter_.filter(output);
  expectSelected(output, expected);
}

TEST_F(CollisionFilterTest, NegativeKeepsWhatCollides)
{
  filter_.setNegative(true);
  const pcl::Indices expected = where(flags_, true, points_);
  EXPECT_EQ(filtered(), expected);
  Cloud output;
  filter_.filter(output);
  expectSelected(output, expected);
}

TEST_F(CollisionFilterTest, PointsThatAreNotFiniteAreRemovedInBothPolarities)
{
  for (const bool negative : {false, true}) {
    filter_.setNegative(negative);
    const pcl::Indices kept = filtered();
    for (const pcl::index_t i : {7, 31}) EXPECT_EQ(std::count(kept.begin(), kept.end(), i), 0) << negative;
    const pcl::Indices& removed = *filter_.getRemovedIndices();
    for (const pcl::index_t i : {7, 31}) EXPECT_EQ(std::count(removed.begin(), removed.end(), i), 1) << negative;
  }
}

TEST_F(CollisionFilterTest, RemovedIndicesAreTheRest)
{
  for (const bool negative : {false, true}) {
    filter_.setNegative(negative);
    pcl::Indices all = filtered();
    const pcl::Indices removed = *filter_.getRemovedIndices();
    EXPECT_TRUE(std::is_sorted(removed.begin(), removed.end()));
    all.insert(all.end(), removed.begin(), removed.end());
    std::sort(all.begin(), all.end());
    pcl::Indices everything(points_.size());
    std::iota(everything.begin(), everything.end(), 0);
    EXPECT_EQ(all, everything);
  }
}

TEST_F(CollisionFilterTest, FlagsKnowNoPolarity)
{
  std::vector<Verdict> flags;
  for (const bool negative : {false, true}) {
    filter_.setNegative(negative);
    filter_.computeFlags(flags);
    EXPECT_EQ(flags, flags_);
  }
}

TEST_F(CollisionFilterTest, KeepOrganizedOverwritesWhatIsRemoved)
{
  input_->width = 70;
  input_->height = 10;
  filter_.setKeepOrganized(true);
  for (const float value : {nan, -5.0f}) {
    filter_.setUserFilterValue(value);
    Cloud output;
    filter_.filter(output);
    ASSERT_EQ(output.width, 70u);
    ASSERT_EQ(output.height, 10u);
    EXPECT_EQ(output.is_dense, std::isfinite(value));
    for (std::size_t i = 0; i < output.size(); ++i) {
      EXPECT_EQ(output[i].intensity, static_cast<float>(i));
      const Eigen::Vector3f xyz = output[i].getVector3fMap();
      if (points_[i].allFinite() && flags_[i] == Verdict::free)
        EXPECT_EQ(xyz, (*original_)[i].getVector3fMap());
      else if (std::isnan(value))
        EXPECT_TRUE(xyz.array().isNaN().all()) << i;
      else
        EXPECT_EQ(xyz, Eigen::Vector3f::Constant(value));
    }
  }
}

TEST_F(CollisionFilterTest, IndicesAreTheOnlyPoints)
{
  const auto indices = std::make_shared<pcl::Indices>(pcl::Indices{500, 7, 3, 3, 120, 64, 11});
  filter_.setIndices(indices);
  pcl::Indices expected;
  std::copy_if(indices->begin(), indices->end(), std::back_inserter(expected),
               [this](pcl::index_t i) { return i != 7 && flags_[static_cast<std::size_t>(i)] == Verdict::free; });
  EXPECT_EQ(filtered(), expected);

  std::vector<Verdict> flags;
  filter_.computeFlags(flags);
  ASSERT_EQ(flags.size(), points_.size());
  for (std::size_t i = 0; i < flags.size(); ++i) {
    const bool listed = std::count(indices->begin(), indices->end(), static_cast<pcl::index_t>(i)) > 0;
    EXPECT_EQ(flags[i], listed ? flags_[i] : Verdict::free) << i;
  }
}

TEST_F(CollisionFilterTest, RowsAndColumnsAreTheOnlyPoints)
{
  input_->width = 70;
  input_->height = 10;
  filter_.setIndices(2, 10, 4, 30);
  pcl::Indices expected;
  for (const pcl::index_t i : where(flags_, false, points_))
    if (i / 70 >= 2 && i / 70 < 6 && i % 70 >= 10 && i % 70 < 40) expected.push_back(i);
  ASSERT_GT(expected.size(), 10u);
  EXPECT_EQ(filtered(), expected);
}

TEST_F(CollisionFilterTest, KeepOrganizedLeavesPointsOutsideTheIndicesAlone)
{
  const auto indices = std::make_shared<pcl::Indices>();
  for (pcl::index_t i = 0; i < 350; ++i) indices->push_back(i);
  filter_.setIndices(indices);
  filter_.setKeepOrganized(true);
  filter_.setUserFilterValue(9.0f);
  Cloud output;
  filter_.filter(output);
  for (std::size_t i = 0; i < output.size(); ++i) {
    const bool removed = i < 350 && (!points_[i].allFinite() || flags_[i] != Verdict::free);
    EXPECT_EQ(output[i].z, removed ? 9.0f : (*original_)[i].z) << i;
  }
}

TEST_F(CollisionFilterTest, EmptyIndicesNameNoPoint)
{
  filter_.setIndices(std::make_shared<pcl::Indices>());
  EXPECT_THAT(filtered(), IsEmpty());
  EXPECT_THAT(*filter_.getRemovedIndices(), IsEmpty());
  std::vector<Verdict> flags;
  filter_.computeFlags(flags);
  EXPECT_EQ(flags, std::vector<Verdict>(points_.size(), Verdict::free));
}

TEST_F(CollisionFilterTest, ResultMayReplaceTheIndices)
{
  const auto indices = std::make_shared<pcl::Indices>(where(flags_, true, points_));
  indices->push_back(where(flags_, false, points_).front());
  filter_.setIndices(indices);
  filter_.filter(*indices);
  EXPECT_EQ(*indices, (pcl::Indices{where(flags_, false, points_).front()}));
}

TEST_F(CollisionFilterTest, IndexOutsideTheCloud)
{
  for (const pcl::index_t wrong : {700, -1}) {
    filter_.setIndices(std::make_shared<pcl::Indices>(pcl::Indices{0, wrong}));
    EXPECT_THROW(filtered(), std::invalid_argument);
  }
}

TEST_F(CollisionFilterTest, OutputMayBeTheInput)
{
  const pcl::Indices expected = where(flags_, false, points_);
  filter_.filter(*input_);
  expectSelected(*input_, expected);
}

TEST_F(CollisionFilterTest, InputMayBeTheObstacle)
{
  filter_.setObstacleCloud(input_);
  Cloud output;
  filter_.filter(output);
  EXPECT_EQ(output.size(), where(doubleLoop(points_, points_, pose_, clearance), false, points_).size());
}

TEST_F(CollisionFilterTest, EmptyInput)
{
  filter_.setInputCloud(std::make_shared<Cloud>());
  Cloud output = *original_;
  filter_.filter(output);
  EXPECT_TRUE(output.empty());
  std::vector<Verdict> flags(3);
  filter_.computeFlags(flags);
  EXPECT_THAT(flags, IsEmpty());
}

TEST_F(CollisionFilterTest, NothingCollidesWithAnEmptyObstacle)
{
  const Points nowhere(3, Eigen::Vector3d::Constant(nan));
  for (const Points& obstacle : {Points(), nowhere}) {
    filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>(obstacle));
    EXPECT_EQ(filtered().size(), points_.size() - 2);
  }
}

TEST_F(CollisionFilterTest, MissingCloudsAreErrors)
{
  Cloud output = *original_;
  pcl::Indices indices;
  std::vector<Verdict> flags;

  Filter no_obstacle;
  no_obstacle.setInputCloud(input_);
  EXPECT_THAT([&] { no_obstacle.filter(output); }, refusedWith("obstacle cloud is missing: call setObstacleCloud()"));
  EXPECT_THAT([&] { no_obstacle.filter(indices); }, refusedWith("obstacle cloud is missing"));
  EXPECT_THAT([&] { no_obstacle.computeFlags(flags); }, refusedWith("obstacle cloud is missing"));
  no_obstacle.setInputCloud(std::make_shared<Cloud>());
  EXPECT_THAT([&] { no_obstacle.filter(output); }, refusedWith("obstacle cloud is missing"));

  Filter no_input;
  no_input.setObstacleCloud(input_);
  EXPECT_THAT([&] { no_input.filter(output); }, refusedWith("input cloud is missing: call setInputCloud()"));
  EXPECT_THAT([&] { no_input.filter(indices); }, refusedWith("input cloud is missing"));
  EXPECT_THAT([&] { no_input.computeFlags(flags); }, refusedWith("input cloud is missing"));

  EXPECT_EQ(output.size(), original_->size());
  EXPECT_THAT([&] { filter_.setObstacleCloud(Cloud::Ptr()); }, refusedWith("obstacle cloud is null"));
}

TEST_F(CollisionFilterTest, BadSettingsAreErrorsAndLeaveTheOutput)
{
  Cloud output = *original_;
  output.header.frame_id = "mine";
  for (const double wrong : {-0.1, static_cast<double>(nan), std::numeric_limits<double>::infinity()}) {
    filter_.setClearance(wrong);
    EXPECT_THAT([&] { filter_.filter(output); }, refusedWith("clearance"));
  }
  filter_.setClearance(clearance);

  Eigen::Matrix4d scaled = pose_.matrix();
  scaled.topLeftCorner<3, 3>() *= 1.001;
  Eigen::Matrix4d mirrored = pose_.matrix();
  mirrored.col(0) *= -1;
  Eigen::Matrix4d projective = pose_.matrix();
  projective(3, 0) = 0.5;
  for (const Eigen::Matrix4d& wrong : {scaled, mirrored, projective}) {
    filter_.setPose(wrong);
    EXPECT_THAT([&] { filter_.filter(output); }, refusedWith("pose"));
  }
  EXPECT_EQ(output.size(), original_->size());
  EXPECT_EQ(output.header.frame_id, "mine");

  filter_.setPose(pose_);
  EXPECT_EQ(filtered(), where(flags_, false, points_));
}

TEST_F(CollisionFilterTest, TouchingIsColliding)
{
  filter_.setPose(Eigen::Isometry3d::Identity());
  filter_.setInputCloud(typedCloud<pcl::PointXYZI>({{0, 0, 0}}));
  filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>({{3, 4, 0}}));
  filter_.setClearance(5.0);
  EXPECT_THAT(filtered(), IsEmpty());
  filter_.setClearance(std::nextafter(5.0, 0.0));
  EXPECT_EQ(filtered().size(), 1u);

  filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>({{0, 0, 0}}));
  filter_.setClearance(0.0);
  EXPECT_THAT(filtered(), IsEmpty());
}

TEST_F(CollisionFilterTest, ObstacleOfAnyCloudType)
{
  const pcl::Indices expected = where(flags_, false, points_);
  filter_.setObstacleCloud(typedCloud<pcl::PointXYZI>(obstacle_));
  EXPECT_EQ(filtered(), expected);
  filter_.setObstacleCloud(pcl::PointCloud<pcl::PointNormal>::ConstPtr(typedCloud<pcl::PointNormal>(obstacle_)));
  EXPECT_EQ(filtered(), expected);
  filter_.setObstacleCloud(fieldCloud<double>(obstacle_));
  EXPECT_EQ(filtered(), expected);

  const auto unreadable = fieldCloud<float>(obstacle_);
  unreadable->fields.pop_back();
  unreadable->fields.pop_back();
  EXPECT_THAT([&] { filter_.setObstacleCloud(unreadable); }, refusedWith("field 'z' is missing"));
}

TEST_F(CollisionFilterTest, PoseOfAnyEigenType)
{
  const Eigen::Isometry3f pose = pose_.cast<float>();
  const auto expectPose = [&] { EXPECT_EQ(filter_.getQuestion().pose.matrix(), pose.matrix().cast<double>()); };
  const auto reset = [&] { filter_.setPose(Eigen::Isometry3d::Identity()); };
  filter_.setPose(pose);
  expectPose();
  EXPECT_EQ(filtered(), where(doubleLoop(points_, obstacle_, pose.cast<double>(), clearance), false, points_));
  reset();
  filter_.setPose(Eigen::Affine3f(pose));
  expectPose();
  reset();
  filter_.setPose(Eigen::Matrix4f(pose.matrix()));
  expectPose();
  reset();
  filter_.setPose(pose.cast<double>().matrix());
  expectPose();
}

TEST_F(CollisionFilterTest, ObstacleIsBuiltOnce)
{
  filtered();
  const Work both = filter_.getWork();
  filtered();
  const Work input_only = filter_.getWork();
  EXPECT_LT(input_only.voxels_built, both.voxels_built);

  filter_.setInputCloud(typedCloud<pcl::PointXYZI>({points_[0]}));
  filter_.setClearance(2 * clearance);
  filter_.setNegative(true);
  filter_.setPose(Eigen::Isometry3d::Identity());
  filtered();
  EXPECT_LE(filter_.getWork().voxels_built, input_only.voxels_built);

  filter_.setInputCloud(input_);
  filter_.setClearance(clearance);
  filter_.setPose(pose_);
  filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>(obstacle_));
  filtered();
  EXPECT_EQ(filter_.getWork().voxels_built, both.voxels_built);
}

TEST_F(CollisionFilterTest, NewObstacleReplacesTheOld)
{
  filtered();
  const Points other = randomPoints(300, 9);
  filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>(other));
  EXPECT_EQ(filtered(), where(doubleLoop(points_, other, pose_, clearance), false, points_));
}

TEST_F(CollisionFilterTest, ObstacleThatChangedIsAnError)
{
  const auto obstacle = typedCloud<pcl::PointXYZ>(obstacle_);
  filter_.setObstacleCloud(obstacle);
  filtered();
  obstacle->push_back({1000, 0, 0});
  EXPECT_THAT([&] { filtered(); }, refusedWith("the obstacle: has changed since it was set"));
  filter_.setObstacleCloud(obstacle);
  EXPECT_EQ(filtered().size(), where(flags_, false, points_).size());
}

TEST_F(CollisionFilterTest, ObstacleOutlivesItsCaller)
{
  auto obstacle = typedCloud<pcl::PointXYZ>(obstacle_);
  filter_.setObstacleCloud(obstacle);
  obstacle.reset();
  EXPECT_EQ(filtered(), where(flags_, false, points_));
}

TEST_F(CollisionFilterTest, SettingsOfACopyAreItsOwn)
{
  filtered();
  Filter copy = filter_;
  copy.setClearance(0.0);
  pcl::Indices kept;
  copy.filter(kept);
  EXPECT_EQ(kept.size(), points_.size() - 2);
  EXPECT_EQ(filtered(), where(flags_, false, points_));
}

TEST_F(CollisionFilterTest, ThreadsChangeNothing)
{
  const pcl::Indices expected = filtered();
  for (const unsigned threads : {0u, 2u, 7u}) {
    filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>(obstacle_)); // built anew by so many threads
    filter_.setNumberOfThreads(threads);
    EXPECT_EQ(filtered(), expected) << threads;
  }
}

TEST_F(CollisionFilterTest, UndecidedPointsAreNeverKeptAsFree)
{
  EXPECT_TRUE(filter_.getQuestion().accuracy.isExact());
  std::vector<Verdict> flags;
  std::size_t undecided = 0;
  for (const char* setting : {"exact", "level=0", "level=1", "level=2", "level=9", "pairs=0", "pairs=300", "time=0"}) {
    SCOPED_TRACE(setting);
    filter_.setAccuracy(Accuracy::parse(setting));
    filter_.computeFlags(flags);
    ASSERT_EQ(flags.size(), flags_.size());
    std::vector<Verdict> colliding_side;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < flags.size(); ++i) {
      counted += flags[i] == Verdict::undecided;
      EXPECT_TRUE(flags[i] == Verdict::undecided || flags[i] == flags_[i]) << i;
      colliding_side.push_back(test::verdictIf(flags[i] != Verdict::free));
    }
    EXPECT_EQ(filter_.getUndecidedCount(), counted);
    undecided += counted;

    if (filter_.getQuestion().accuracy.mode == Accuracy::Mode::time) continue; // another run decides other points
    for (const bool negative : {false, true}) {
      filter_.setNegative(negative);
      EXPECT_EQ(filtered(), where(colliding_side, negative, points_));
      EXPECT_EQ(filter_.getUndecidedCount(), counted);
    }
  }
  EXPECT_GT(undecided, 700u) << "hardly anything was ever undecided";
  filter_.setAccuracy(Accuracy::exact());
  filter_.computeFlags(flags);
  EXPECT_EQ(filter_.getUndecidedCount(), 0u);
}

TEST_F(CollisionFilterTest, UndecidedPointsAreOverwrittenWhereTheCloudStaysOrganized)
{
  filter_.setAccuracy(Accuracy::nodePairs(0));
  filter_.setKeepOrganized(true);
  filter_.setUserFilterValue(9.0f);
  Cloud output;
  filter_.filter(output);
  for (const pcl::PointXYZI& point : output) EXPECT_EQ(point.z, 9.0f);
}

TEST_F(CollisionFilterTest, ToleranceDecidesEveryPoint)
{
  const double tolerance = 0.02;
  filter_.setAccuracy(Accuracy::tolerance(tolerance));
  const std::vector<Verdict> most = doubleLoop(points_, obstacle_, pose_, clearance + tolerance);
  std::vector<Verdict> flags;
  filter_.computeFlags(flags);
  for (std::size_t i = 0; i < flags.size(); ++i) {
    EXPECT_GE(flags[i], flags_[i]) << i;
    EXPECT_LE(flags[i], most[i]) << i;
  }
  EXPECT_EQ(filter_.getUndecidedCount(), 0u);
}

TEST_F(CollisionFilterTest, AccuracyThatMakesNoSenseIsAnError)
{
  std::vector<Verdict> flags;
  for (const double wrong : {-1.0, static_cast<double>(nan)}) {
    filter_.setAccuracy(Accuracy::tolerance(wrong));
    EXPECT_THAT([&] { filter_.computeFlags(flags); }, refusedWith("accuracy: tolerance="));
  }
}

/// Poses that carry the obstacle through the input.
std::vector<Eigen::Isometry3d> somePath(const Eigen::Isometry3d& start)
{
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 5; ++k) {
    Eigen::Isometry3d pose = start * Eigen::AngleAxisd(0.2 * k, Eigen::Vector3d::UnitX());
    pose.translation().x() += 0.15 * k;
    poses.push_back(pose);
  }
  return poses;
}

TEST_F(CollisionFilterTest, TrajectoryCollidesAtAnyOfItsPoses)
{
  const std::vector<Eigen::Isometry3d> poses = somePath(pose_);
  std::vector<std::int32_t> first(points_.size(), -1), closest(points_.size(), -1);
  std::vector<double> distance(points_.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (std::size_t k = 0; k < poses.size(); ++k) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3d& q : obstacle_) nearest = std::fmin(nearest, (points_[i] - poses[k] * q).norm());
      if (!points_[i].allFinite() || nearest > clearance) continue;
      if (first[i] < 0) first[i] = static_cast<std::int32_t>(k);
      if (nearest < distance[i]) distance[i] = nearest, closest[i] = static_cast<std::int32_t>(k);
    }
  }
  std::vector<Verdict> expected;
  for (const std::int32_t k : first) expected.push_back(test::verdictIf(k >= 0));
  ASSERT_NE(expected, flags_) << "one pose is not enough";

  filter_.setTrajectory(poses);
  std::vector<Verdict> flags;
  filter_.computeFlags(flags);
  EXPECT_EQ(flags, expected);
  EXPECT_EQ(filtered(), where(expected, false, points_));
  filter_.setNegative(true);
  EXPECT_EQ(filtered(), where(expected, true, points_));

  TrajectoryResult along;
  filter_.computeTrajectory(along);
  EXPECT_EQ(along.flags, expected);
  EXPECT_EQ(along.first_pose, first);
  EXPECT_EQ(along.closest_pose, closest);
  EXPECT_EQ(along.poses.size(), poses.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (expected[i] != Verdict::free)
      EXPECT_NEAR(along.distance[i], distance[i], 1e-6) << i;
    else
      EXPECT_TRUE(std::isnan(along.distance[i])) << i;
  }
}

TEST_F(CollisionFilterTest, AccuracyAlongATrajectory)
{
  filter_.setTrajectory(somePath(pose_));
  std::vector<Verdict> exact, flags;
  filter_.computeFlags(exact);
  filter_.setAccuracy(Accuracy::level(0));
  filter_.computeFlags(flags);
  const auto undecided = static_cast<std::size_t>(std::count(flags.begin(), flags.end(), Verdict::undecided));
  EXPECT_GT(undecided, 0u);
  EXPECT_EQ(filter_.getUndecidedCount(), undecided);
  for (std::size_t i = 0; i < flags.size(); ++i)
    EXPECT_TRUE(flags[i] == Verdict::undecided || flags[i] == exact[i]) << i;
  EXPECT_EQ(filtered(), where(flags, false, points_));

  TrajectoryResult along;
  EXPECT_THAT([&] { filter_.computeTrajectory(along); },
              refusedWith("accuracy: level=0: decides which points collide"));
  filter_.setAccuracy(Accuracy::tolerance(0.01));
  filter_.computeTrajectory(along);
  EXPECT_EQ(filter_.getUndecidedCount(), 0u);
  filter_.setSwept(0.01);
  EXPECT_THAT([&] { filter_.computeFlags(flags); }, refusedWith("accuracy: tolerance=0.01: swept motion"));
}

TEST_F(CollisionFilterTest, PoseAndTrajectoryReplaceEachOther)
{
  filter_.setTrajectory(somePath(pose_));
  filter_.setPose(pose_);
  EXPECT_FALSE(filter_.getQuestion().path);
  std::vector<Verdict> flags;
  filter_.computeFlags(flags);
  EXPECT_EQ(flags, flags_);
  filter_.setPose(Eigen::Isometry3d(Eigen::Translation3d(9, 9, 9)));
  filter_.setTrajectory({pose_});
  filter_.computeFlags(flags);
  EXPECT_EQ(flags, flags_);
}

TEST_F(CollisionFilterTest, SweptFindsWhatLiesBetweenPoses)
{
  // A point half way between two poses that are far from it.
  filter_.setInputCloud(typedCloud<pcl::PointXYZI>({{0.5, 0, 0}, {0.5, 0.2, 0}}));
  filter_.setObstacleCloud(typedCloud<pcl::PointXYZ>({{0, 0, 0}}));
  filter_.setTrajectory({Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0))});
  std::vector<Verdict> flags;
  filter_.computeFlags(flags);
  EXPECT_EQ(flags, test::verdictsOf({0, 0}));
  filter_.setSwept(0.01);
  filter_.computeFlags(flags);
  EXPECT_EQ(flags, test::verdictsOf({1, 0}));
  filter_.setSwept(0);
  filter_.computeFlags(flags);
  EXPECT_EQ(flags, test::verdictsOf({0, 0}));
}

TEST_F(CollisionFilterTest, BadTrajectoriesAreErrors)
{
  std::vector<Verdict> flags;
  filter_.setTrajectory({});
  EXPECT_THAT([&] { filter_.computeFlags(flags); }, refusedWith("path: has no pose"));
  Eigen::Isometry3d scaled = pose_;
  scaled.linear() *= 2;
  filter_.setTrajectory({pose_, scaled});
  EXPECT_THAT([&] { filter_.computeFlags(flags); }, refusedWith("not rigid"));
  filter_.setTrajectory({pose_});
  for (const double tolerance : {-1.0, std::nan(""), HUGE_VAL}) {
    filter_.setSwept(tolerance);
    EXPECT_THROW(filter_.computeFlags(flags), std::invalid_argument) << tolerance;
  }
}

TEST_F(CollisionFilterTest, AfterVoxelGrid)
{
  const auto dense = typedCloud<pcl::PointXYZI>(randomPoints(20000, 5));
  pcl::VoxelGrid<pcl::PointXYZI> voxels;
  voxels.setInputCloud(dense);
  voxels.setLeafSize(0.1f, 0.1f, 0.1f);
  const auto thinned = std::make_shared<Cloud>();
  voxels.filter(*thinned);
  ASSERT_GT(thinned->size(), 500u);
  Points points;
  for (const auto& p : *thinned) points.push_back(p.getVector3fMap().cast<double>());

  filter_.setInputCloud(thinned);
  EXPECT_EQ(filtered(), where(doubleLoop(points, obstacle_, pose_, clearance), false, points));
}

TEST_F(CollisionFilterTest, IsAPclFilter)
{
  const auto filter = std::make_shared<Filter>(filter_);
  const pcl::Filter<pcl::PointXYZI>::Ptr base = filter;
  Cloud output;
  base->filter(output);
  expectSelected(output, where(flags_, false, points_));
}

template <typename PointT>
class CollisionFilterPointTypes : public testing::Test {
};

using PointTypes = testing::Types<BOOST_PP_SEQ_ENUM(PCL_XYZ_POINT_TYPES)>;
TYPED_TEST_SUITE(CollisionFilterPointTypes, PointTypes);

TYPED_TEST(CollisionFilterPointTypes, AreInstantiated)
{
  const Points points = randomPoints(60, 3);
  const Points obstacle = randomPoints(60, 4);
  CollisionFilter<TypeParam> filter;
  filter.setInputCloud(typedCloud<TypeParam>(points));
  filter.setObstacleCloud(typedCloud<TypeParam>(obstacle));
  filter.setClearance(0.15);
  pcl::Indices kept;
  filter.filter(kept);
  EXPECT_EQ(kept, where(doubleLoop(points, obstacle, Eigen::Isometry3d::Identity(), 0.15), false, points));
  pcl::PointCloud<TypeParam> output;
  filter.filter(output);
  EXPECT_EQ(output.size(), kept.size());
}

} // namespace
} // namespace pcl_bsh
