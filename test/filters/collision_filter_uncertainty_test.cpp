// SPDX-License-Identifier: BSD-3-Clause
// The filter where points may be elsewhere than they were measured: a length of all points, or a field of sigmas.
#include <pcl_bsh/filters/collision_filter.h>

#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>

#include "clouds.h"
#include "support/verdicts.h"

#include <pcl/point_types.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_bsh {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::ThrowsMessage;

using Cloud = pcl::PCLPointCloud2;

constexpr double clearance = 0.08;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

auto refusedWith(const std::string& text)
{
  return ThrowsMessage<std::invalid_argument>(HasSubstr(text));
}

/// The field `intensity` of the test clouds holds the sigmas.
void setSigma(Cloud& cloud, std::size_t i, float sigma)
{
  std::memcpy(&cloud.data[i * cloud.point_step + cloud.fields.back().offset], &sigma, sizeof sigma);
}

class CollisionFilterUncertainty : public testing::Test {
protected:
  CollisionFilterUncertainty()
  {
    points_[7].x() = nan;
    input_ = fieldCloud<float>(points_);
    obstacle_ = fieldCloud<double>(obstacle_points_);
    for (std::size_t i = 0; i < points_.size(); ++i) setSigma(*input_, i, 0.001f * static_cast<float>(i % 11));
    for (std::size_t i = 0; i < obstacle_points_.size(); ++i)
      setSigma(*obstacle_, i, 0.002f * static_cast<float>(i % 7));
    setUp(filter_);
  }

  template <typename Filter>
  void setUp(Filter& filter) const
  {
    if constexpr (std::is_same_v<Filter, CollisionFilter<Cloud>>) filter.setInputCloud(input_);
    filter.setObstacleCloud(obstacle_);
    filter.setPose(pose_);
    filter.setClearance(clearance);
  }

  /// Verdicts of brute force on these views. @param sigmas of the input's points, whose own sigmas count
  std::vector<Verdict> expected(double sigmas, double of_obstacle) const
  {
    std::vector<float> own;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double length = sigmas * static_cast<double>(0.001f * static_cast<float>(i % 11));
      auto rounded = static_cast<float>(length);
      if (static_cast<double>(rounded) < length) rounded = std::nextafter(rounded, 1.0f);
      own.push_back(rounded);
    }
    PointsView a = viewOf(*input_), b = viewOf(*obstacle_);
    a.uncertainties = own.data();
    b.uncertainty = of_obstacle;
    FlagsRequest request;
    request.clearance = clearance;
    const SphereHierarchy of_a(a), of_b(b);
    return brute_force::collisionFlags({of_a}, {of_b, pose_}, request).a;
  }

  std::vector<Verdict> flags()
  {
    std::vector<Verdict> found;
    filter_.computeFlags(found);
    return found;
  }

  Points points_ = randomPoints(700, 1);
  const Points obstacle_points_ = randomPoints(600, 2);
  const Eigen::Isometry3d pose_ = somePose();
  Cloud::Ptr input_, obstacle_;
  CollisionFilter<Cloud> filter_{true};
};

TEST_F(CollisionFilterUncertainty, FlagsAreThoseOfBruteForce)
{
  filter_.setInputUncertainty(Uncertainty("intensity", 2.5));
  filter_.setObstacleUncertainty(0.007);
  const std::vector<Verdict> wanted = expected(2.5, 0.007), found = flags();
  ASSERT_GT(countOf(wanted, Verdict::free), 50U);
  ASSERT_GT(countOf(wanted, Verdict::colliding), 50U);
  ASSERT_GT(countOf(wanted, Verdict::undecided), 50U);
  EXPECT_EQ(found, wanted);
  EXPECT_EQ(filter_.getUndecidedCount(), countOf(wanted, Verdict::undecided));
}

TEST_F(CollisionFilterUncertainty, WhatIsUndecidedIsNotFree)
{
  filter_.setInputUncertainty(0.01);
  const std::vector<Verdict> found = flags();
  ASSERT_GT(countOf(found, Verdict::undecided), 50U);
  pcl::Indices kept;
  filter_.filter(kept);
  EXPECT_EQ(kept, where(found, false, points_)) << "free ones alone";
  filter_.setNegative(true);
  filter_.filter(kept);
  EXPECT_EQ(kept, where(found, true, points_));
  filter_.setKeepFlagged(true);
  Cloud flagged;
  filter_.filter(flagged);
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_EQ(flagged.data[i * flagged.point_step + flagged.fields.back().offset], bytesOf(found)[i]);
}

TEST_F(CollisionFilterUncertainty, TypedCloudsHaveFieldsToo)
{
  const auto typed = typedCloud<pcl::PointXYZI>(points_);
  for (std::size_t i = 0; i < points_.size(); ++i) (*typed)[i].intensity = 0.001f * static_cast<float>(i % 11);
  CollisionFilter<pcl::PointXYZI> filter;
  filter.setInputCloud(typed);
  setUp(filter);
  filter.setInputUncertainty(Uncertainty("intensity", 1.0));
  std::vector<Verdict> found;
  filter.computeFlags(found);
  EXPECT_EQ(found, expected(1.0, 0.0));

  const auto some = std::make_shared<pcl::Indices>(pcl::Indices{3, 5, 8, 7, 600});
  filter.setIndices(some);
  std::vector<Verdict> of_some;
  filter.computeFlags(of_some);
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_EQ(of_some[i], std::find(some->begin(), some->end(), i) == some->end() ? Verdict::free : found[i]) << i;
}

TEST_F(CollisionFilterUncertainty, EverySettingCountsAtItsNextUse)
{
  const std::vector<Verdict> measured = flags();
  EXPECT_EQ(countOf(measured, Verdict::undecided), 0U);
  filter_.setObstacleUncertainty(0.007);
  filter_.setInputUncertainty(Uncertainty("intensity", 1.0));
  EXPECT_EQ(flags(), expected(1.0, 0.007)) << "the obstacle's hierarchy was built without";
  filter_.setInputUncertainty(Uncertainty("intensity", 3.0));
  EXPECT_EQ(flags(), expected(3.0, 0.007));
  filter_.setObstacleUncertainty({});
  EXPECT_EQ(flags(), expected(3.0, 0.0));
  CollisionFilter<Cloud> copy(filter_);
  filter_.setInputUncertainty({});
  EXPECT_EQ(flags(), measured);
  std::vector<Verdict> found;
  copy.computeFlags(found);
  EXPECT_EQ(found, expected(3.0, 0.0));
}

TEST_F(CollisionFilterUncertainty, ObstaclesSigmasMustNotChangeUnseen)
{
  filter_.setObstacleUncertainty(Uncertainty("intensity", 1.0));
  const std::vector<Verdict> before = flags();
  setSigma(*obstacle_, 5, 0.5f);
  EXPECT_THAT([&] { flags(); }, refusedWith("the obstacle: has changed"));
  filter_.setObstacleCloud(obstacle_);
  EXPECT_NE(flags(), before);
}

TEST_F(CollisionFilterUncertainty, RefusesWhatIsNoLength)
{
  filter_.setInputUncertainty(0.01);
  for (const double wrong : {-0.1, nan, infinity, -infinity}) {
    EXPECT_THAT([&] { filter_.setInputUncertainty(wrong); }, refusedWith("the input: uncertainty "));
    EXPECT_THAT([&] { filter_.setObstacleUncertainty(Uncertainty("intensity", wrong)); },
                refusedWith("the obstacle: number of sigmas "));
  }
  EXPECT_EQ(filter_.getQuestion().uncertainty.length, 0.01) << "an error changes nothing";

  filter_.setInputUncertainty(Uncertainty("sigma", 1.0));
  EXPECT_THAT([&] { flags(); },
              refusedWith("the input: field 'sigma' of its points' sigmas is missing: give a length, or one of its "
                          "fields: label, x, y, z, intensity"));
  filter_.setInputUncertainty(Uncertainty("intensity", 1.0));
  for (const float wrong : {-0.25f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    setSigma(*input_, 12, wrong);
    EXPECT_THAT([&] { flags(); }, refusedWith("the input: field 'intensity' of point 12 is "));
  }
  setSigma(*input_, 12, 1e38f);
  EXPECT_NO_THROW(flags());
  filter_.setInputUncertainty(Uncertainty("intensity", 1e6));
  EXPECT_THAT([&] { flags(); }, refusedWith("point 12 is 1e+38"));
}

TEST_F(CollisionFilterUncertainty, PointsThatAreNotFiniteNeedNone)
{
  filter_.setInputUncertainty(Uncertainty("intensity", 1.0));
  setSigma(*input_, 7, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(flags(), expected(1.0, 0.0));
}

/// A wall scanned in lines that are apart by more than twice the clearance, and points before it.
class CollisionFilterDensity : public testing::Test {
protected:
  CollisionFilterDensity()
  {
    Points wall;
    for (int j = 0; j < 15; ++j)
      for (int i = 0; i < 60; ++i) wall.emplace_back(0.0625 * i, 0.5 * j, 0.0);
    wall_ = fieldCloud<float>(wall);
    for (int i = 0; i < 20; ++i)
      for (const double z : {0.05, 0.15, 0.5}) points_.emplace_back(1.5, 2.0 + 0.1 * i, z);
    filter_.setInputCloud(fieldCloud<float>(points_));
    filter_.setObstacleCloud(wall_);
    filter_.setClearance(0.1);
    filter_.setDensityGuard(true);
    filter_.setWidestGap(1.0);
  }

  std::vector<Verdict> flags()
  {
    std::vector<Verdict> found;
    filter_.computeFlags(found);
    return found;
  }

  Points points_;
  Cloud::Ptr wall_;
  CollisionFilter<Cloud> filter_;
};

/// Spacings are those of the cloud that was measured, and setters of other things do not make it another one.
TEST_F(CollisionFilterDensity, WhatHasChangedIsRefusedWhateverElseIsSet)
{
  flags();
  const Cloud former = *wall_;
  const auto set_again = [&] {
    filter_.setObstacleUncertainty(Uncertainty("intensity", 0.0));
    filter_.setObstacleUncertainty(0.0);
    filter_.setWidestGap(2.0);
    filter_.setWidestGap(1.0);
  };
  const float moved = 0.25f;
  std::memcpy(wall_->data.data(), &moved, sizeof moved);
  set_again();
  EXPECT_THAT([&] { flags(); }, refusedWith("the obstacle: has changed since it was set: set it again"));
  *wall_ = former;
  set_again();
  EXPECT_NO_THROW(flags()) << "as it was";

  Points more(900 * 4, Eigen::Vector3d(9, 9, 9));
  *wall_ = *fieldCloud<float>(more);
  set_again();
  EXPECT_THAT([&] { flags(); }, refusedWith("has changed since it was set: set it again")) << "it has grown";
  filter_.setObstacleCloud(wall_);
  EXPECT_EQ(flags(), std::vector<Verdict>(points_.size(), Verdict::free)) << "far away, and all at one place";
}

TEST_F(CollisionFilterDensity, HolesBetweenLinesAreNotFree)
{
  const std::vector<Verdict> guarded = flags();
  EXPECT_EQ(filter_.getSparseCount(), countOf(guarded, Verdict::sparse));
  EXPECT_EQ(filter_.getUndecidedCount(), filter_.getSparseCount());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].z() <= 0.1) {
      EXPECT_NE(guarded[i], Verdict::free) << "within the clearance of the wall";
    }
    if (points_[i].z() == 0.5) {
      EXPECT_EQ(guarded[i], Verdict::free) << "farther than the clearance and half of a hole";
    }
  }
  pcl::Indices kept;
  filter_.filter(kept);
  EXPECT_EQ(kept, where(guarded, false, points_)) << "free ones alone";
  filter_.setDensityGuard(false);
  const std::vector<Verdict> plain = flags();
  EXPECT_EQ(filter_.getSparseCount(), 0U);
  for (std::size_t i = 0; i < plain.size(); ++i)
    EXPECT_EQ(plain[i], guarded[i] == Verdict::sparse ? Verdict::free : guarded[i]);
  EXPECT_NE(plain, guarded);
}

TEST_F(CollisionFilterDensity, WhatGapesWiderIsAnOpening)
{
  filter_.setWidestGap(0.25);
  const std::vector<Verdict> narrow = flags();
  EXPECT_EQ(std::count(narrow.begin(), narrow.end(), Verdict::sparse), 0);
  filter_.setWidestGap(1.0);
  EXPECT_NE(flags(), narrow);
}

TEST_F(CollisionFilterDensity, Refuses)
{
  for (const double wrong : {-1.0, nan, infinity}) {
    filter_.setWidestGap(wrong);
    EXPECT_THAT([&] { flags(); }, refusedWith("widest_gap: "));
  }
  filter_.setWidestGap(0.0);
  EXPECT_NO_THROW(flags());
  filter_.setTrajectory({Eigen::Isometry3d::Identity()});
  EXPECT_THAT([&] { flags(); }, refusedWith("density: is about which points collide at one pose: leave out the path"));
}

} // namespace
} // namespace pcl_bsh
