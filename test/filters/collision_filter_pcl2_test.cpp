// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/collision_filter.h>

#include "clouds.h"
#include "support/verdicts.h"

#include <pcl/conversions.h>
#include <pcl/filters/voxel_grid.h>
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
using testing::IsEmpty;
using testing::ThrowsMessage;

using Cloud = pcl::PCLPointCloud2;
using Filter = CollisionFilter<Cloud>;

constexpr double clearance = 0.08;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

auto refusedWith(const std::string& text)
{
  return ThrowsMessage<std::invalid_argument>(HasSubstr(text));
}

/// Two clouds that overlap in part, the input with a point that is not finite.
class CollisionFilterPcl2Test : public testing::Test {
protected:
  CollisionFilterPcl2Test()
  {
    flags_ = doubleLoop(points_, obstacle_, pose_, clearance);
    input_ = fieldCloud<float>(points_);
    filter_.setInputCloud(input_);
    setUp(filter_);
  }

  template <typename PointT>
  void setUp(CollisionFilter<PointT>& filter) const
  {
    filter.setObstacleCloud(fieldCloud<float>(obstacle_));
    filter.setPose(pose_);
    filter.setClearance(clearance);
  }

  Cloud filtered()
  {
    Cloud output;
    filter_.filter(output);
    return output;
  }

  /// The records of the input with these numbers, every byte of them, under its header and fields.
  static void expectRecords(const Cloud& output, const Cloud& input, const pcl::Indices& expected)
  {
    ASSERT_EQ(output.width, expected.size());
    EXPECT_EQ(output.height, 1u);
    EXPECT_EQ(output.point_step, input.point_step);
    EXPECT_EQ(output.row_step, output.width * output.point_step);
    EXPECT_EQ(output.data.size(), output.row_step);
    EXPECT_EQ(output.header.frame_id, input.header.frame_id);
    ASSERT_EQ(output.fields.size(), input.fields.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(record(output, i), record(input, static_cast<std::size_t>(expected[i]))) << i;
    }
  }

  void expectFlagged(const Cloud& output, const std::vector<Verdict>& flags) const
  {
    const Cloud& input = *original_;
    ASSERT_EQ(output.width * output.height, flags.size());
    ASSERT_EQ(output.fields.size(), input.fields.size() + 1);
    EXPECT_EQ(output.fields.back().name, "collision");
    EXPECT_EQ(output.fields.back().datatype, pcl::PCLPointField::UINT8);
    for (std::size_t i = 0; i < flags.size(); ++i) {
      auto expected = record(input, i);
      expected.push_back(static_cast<std::uint8_t>(flags[i]));
      EXPECT_EQ(record(output, i), expected) << i;
    }
  }

  const Points points_ = withNonFinite(randomPoints(700, 1));
  const Points obstacle_ = randomPoints(600, 2);
  const Eigen::Isometry3d pose_ = somePose();
  std::vector<Verdict> flags_;
  const Cloud::ConstPtr original_ = fieldCloud<float>(points_);
  Cloud::Ptr input_;
  Filter filter_{true};

private:
  static Points withNonFinite(Points points)
  {
    points[7].x() = nan;
    return points;
  }
};

TEST_F(CollisionFilterPcl2Test, KeepsEveryFieldOfWhatItKeeps)
{
  expectRecords(filtered(), *original_, where(flags_, false, points_));
  filter_.setNegative(true);
  expectRecords(filtered(), *original_, where(flags_, true, points_));
}

TEST_F(CollisionFilterPcl2Test, OutputMayBeTheInput)
{
  filter_.filter(*input_);
  expectRecords(*input_, *original_, where(flags_, false, points_));
}

TEST_F(CollisionFilterPcl2Test, TrajectoryAddsItsFields)
{
  filter_.setTrajectory({Eigen::Isometry3d(Eigen::Translation3d(9, 9, 9)), pose_});
  filter_.setKeepFlagged(true);
  const Cloud output = filtered();
  ASSERT_EQ(output.fields.size(), original_->fields.size() + 4);
  const auto last = output.fields.end() - 4;
  const std::vector<std::pair<std::string, std::uint8_t>> expected = {{"collision", pcl::PCLPointField::UINT8},
                                                                      {"distance", pcl::PCLPointField::FLOAT32},
                                                                      {"first_pose", pcl::PCLPointField::INT32},
                                                                      {"closest_pose", pcl::PCLPointField::INT32}};
  for (std::size_t f = 0; f < 4; ++f) {
    EXPECT_EQ(last[static_cast<std::ptrdiff_t>(f)].name, expected[f].first);
    EXPECT_EQ(last[static_cast<std::ptrdiff_t>(f)].datatype, expected[f].second);
  }
  TrajectoryResult along;
  filter_.computeTrajectory(along);
  EXPECT_EQ(along.flags, flags_);
  for (std::size_t i = 0; i < flags_.size(); ++i) {
    auto bytes = record(*original_, i);
    const auto append = [&](const auto& value) {
      const auto* const first = reinterpret_cast<const std::uint8_t*>(&value);
      bytes.insert(bytes.end(), first, first + sizeof value);
    };
    append(flags_[i]);
    append(along.distance[i]);
    append(along.first_pose[i]);
    append(along.closest_pose[i]);
    EXPECT_EQ(along.first_pose[i], flags_[i] != Verdict::free ? 1 : -1);
    EXPECT_EQ(record(output, i), bytes) << i;
  }
}

TEST_F(CollisionFilterPcl2Test, UndecidedPointsHaveAFlagOfTheirOwn)
{
  filter_.setAccuracy(Accuracy::nodePairs(300));
  std::vector<Verdict> flags;
  filter_.computeFlags(flags);
  const auto undecided = static_cast<std::size_t>(std::count(flags.begin(), flags.end(), Verdict::undecided));
  EXPECT_GT(undecided, 0u);
  EXPECT_EQ(filter_.getUndecidedCount(), undecided);
  expectRecords(filtered(), *original_, where(flags, false, points_));
  filter_.setNegative(true);
  expectRecords(filtered(), *original_, where(flags, true, points_));
  filter_.setKeepFlagged(true);
  expectFlagged(filtered(), flags);
}

TEST_F(CollisionFilterPcl2Test, AgreesWithTheTypedFilter)
{
  const auto typed_input = typedCloud<pcl::PointXYZ>(points_);
  typed_input->width = 70;
  typed_input->height = 10;
  const auto input = std::make_shared<Cloud>();
  pcl::toPCLPointCloud2(*typed_input, *input);
  const auto some = std::make_shared<pcl::Indices>(pcl::Indices{5, 7, 600, 4, 4, 99});

  for (unsigned options = 0; options < 16; ++options) {
    const bool organized = options & 2u;
    const auto apply = [&](auto& filter, const auto& cloud, auto& output, pcl::Indices& kept) {
      setUp(filter);
      filter.setInputCloud(cloud);
      filter.setNegative(options & 1u);
      filter.setKeepOrganized(organized);
      if (options & 4u) filter.setIndices(some);
      if (options & 8u) filter.setUserFilterValue(-1.5f);
      filter.filter(kept);
      filter.filter(output);
    };
    pcl::PointCloud<pcl::PointXYZ> expected;
    pcl::Indices expected_kept;
    CollisionFilter<pcl::PointXYZ> typed(true);
    apply(typed, typed_input, expected, expected_kept);

    Cloud fields;
    pcl::Indices kept;
    Filter filter(true);
    apply(filter, input, fields, kept);
    pcl::PointCloud<pcl::PointXYZ> output;
    pcl::fromPCLPointCloud2(fields, output);

    EXPECT_EQ(kept, expected_kept) << options;
    EXPECT_EQ(*filter.getRemovedIndices(), *typed.getRemovedIndices()) << options;
    EXPECT_EQ(output.height, organized ? 10u : 1u) << options;
    EXPECT_EQ(output.width, expected.width) << options;
    EXPECT_EQ(output.is_dense, expected.is_dense) << options;
    ASSERT_EQ(output.size(), expected.size()) << options;
    for (std::size_t i = 0; i < output.size(); ++i) {
      const Eigen::Array3f a = output[i].getArray3fMap();
      const Eigen::Array3f b = expected[i].getArray3fMap();
      EXPECT_TRUE((a == b || (a.isNaN() && b.isNaN())).all()) << options << " " << i;
    }
  }
}

TEST_F(CollisionFilterPcl2Test, KeepOrganizedWritesDoublesToDoubles)
{
  const auto input = fieldCloud<double>(points_);
  input->width = 10;
  input->height = 70;
  input->row_step = 10 * input->point_step;
  input->is_dense = 1;
  filter_.setInputCloud(input);
  filter_.setKeepOrganized(true);
  for (const float value : {-0.1f, std::numeric_limits<float>::quiet_NaN()}) {
    filter_.setUserFilterValue(value);
    const Cloud output = filtered();
    ASSERT_EQ(output.width, 10u);
    ASSERT_EQ(output.height, 70u);
    EXPECT_EQ(output.is_dense, std::isfinite(value) ? 1 : 0);
    const PointsView before = viewOf(*input);
    const PointsView after = viewOf(output);
    for (std::uint32_t i = 0; i < before.count; ++i) {
      const bool removed = flags_[i] != Verdict::free || !points_[i].allFinite();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double expected = removed ? static_cast<double>(value) : before.point(i)[axis];
        EXPECT_TRUE(after.point(i)[axis] == expected || (std::isnan(expected) && std::isnan(after.point(i)[axis])))
            << i;
      }
      const auto other_fields = [i](const Cloud& cloud) {
        auto bytes = record(cloud, i);
        bytes.erase(bytes.begin() + 2, bytes.begin() + 2 + 3 * sizeof(double));
        return bytes;
      };
      EXPECT_EQ(other_fields(output), other_fields(*input)) << i;
    }
  }
}

TEST_F(CollisionFilterPcl2Test, RemovedIndicesOnlyOnRequest)
{
  Filter filter;
  filter.setInputCloud(input_);
  setUp(filter);
  pcl::Indices kept;
  filter.filter(kept);
  EXPECT_THAT(*filter.getRemovedIndices(), IsEmpty());
}

TEST_F(CollisionFilterPcl2Test, KeepFlaggedAddsAField)
{
  filter_.setKeepFlagged(true);
  for (const bool negative : {false, true}) {
    filter_.setNegative(negative);
    expectFlagged(filtered(), flags_);
    EXPECT_THAT(*filter_.getRemovedIndices(), IsEmpty());
  }
  pcl::Indices kept;
  filter_.filter(kept);
  EXPECT_EQ(kept, where(flags_, true, points_));
}

TEST_F(CollisionFilterPcl2Test, KeepFlaggedInPlaceAndAgain)
{
  filter_.setKeepFlagged(true);
  filter_.filter(*input_);
  expectFlagged(*input_, flags_);
  filter_.setClearance(0.0);
  filter_.filter(*input_);
  expectFlagged(*input_, std::vector<Verdict>(points_.size(), Verdict::free));
}

TEST_F(CollisionFilterPcl2Test, KeepFlaggedKeepsPointsOutsideTheIndices)
{
  filter_.setKeepFlagged(true);
  const auto indices = std::make_shared<pcl::Indices>(where(flags_, true, points_));
  indices->resize(indices->size() / 2);
  filter_.setIndices(indices);
  std::vector<Verdict> expected(points_.size(), Verdict::free);
  for (const pcl::index_t i : *indices) expected[static_cast<std::size_t>(i)] = Verdict::colliding;
  expectFlagged(filtered(), expected);
}

/// 1,000 points along x, 1 cm apart, in a UTM zone; y and z in metres.
Points utmRow(double y)
{
  Points points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(500000.003 + .01 * i, y, 100.0);
  return points;
}

TEST(CollisionFilterUtm, Float64IsNotRounded)
{
  pcl::Indices kept;
  Filter filter;
  filter.setClearance(.05);

  // 8 cm apart; in float32 on top of each other.
  filter.setInputCloud(fieldCloud<double>(utmRow(5400000.26)));
  filter.setObstacleCloud(fieldCloud<double>(utmRow(5400000.34)));
  filter.filter(kept);
  EXPECT_EQ(kept.size(), 1000u);

  // 2 cm apart; in float32, half a metre.
  filter.setInputCloud(fieldCloud<double>(utmRow(5400000.24)));
  filter.setObstacleCloud(fieldCloud<double>(utmRow(5400000.26)));
  filter.filter(kept);
  EXPECT_THAT(kept, IsEmpty());
}

TEST(CollisionFilterUtm, WarnsOnceOfFloatsTooCoarseForTheClearance)
{
  const auto said = [](Filter& filter) {
    std::vector<Verdict> flags;
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout(); // PCL's console may use either
    filter.computeFlags(flags);
    return testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
  };
  Filter coarse;
  coarse.setClearance(.05);
  coarse.setInputCloud(fieldCloud<float>(utmRow(5400000.26)));
  coarse.setObstacleCloud(fieldCloud<double>(utmRow(5400000.34)));
  const std::string warning = said(coarse);
  EXPECT_THAT(warning, testing::HasSubstr("the input: its float32 coordinates lie 0.5 apart"));
  EXPECT_THAT(warning, testing::HasSubstr("clearance of 0.05"));
  EXPECT_EQ(said(coarse), "");

  Filter wide;
  wide.setClearance(6.0);
  wide.setInputCloud(fieldCloud<float>(utmRow(5400000.26)));
  wide.setObstacleCloud(fieldCloud<float>(utmRow(5400000.34)));
  EXPECT_EQ(said(wide), "");
  Filter precise;
  precise.setClearance(.05);
  precise.setInputCloud(fieldCloud<double>(utmRow(5400000.26)));
  precise.setObstacleCloud(fieldCloud<double>(utmRow(5400000.34)));
  EXPECT_EQ(said(precise), "");
}

TEST_F(CollisionFilterPcl2Test, EmptyClouds)
{
  filter_.setInputCloud(fieldCloud<float>({}));
  EXPECT_TRUE(filtered().data.empty());
  filter_.setKeepFlagged(true);
  EXPECT_EQ(filtered().fields.back().name, "collision");
  filter_.setKeepFlagged(false);

  filter_.setInputCloud(input_);
  filter_.setObstacleCloud(fieldCloud<double>({}));
  EXPECT_EQ(filtered().width, points_.size() - 1);
}

TEST_F(CollisionFilterPcl2Test, ErrorsLeaveTheOutput)
{
  Cloud output = *original_;
  Filter filter;
  EXPECT_THAT([&] { filter.filter(output); }, refusedWith("input cloud is missing"));
  EXPECT_THAT([&] { filter.setInputCloud(nullptr); }, refusedWith("input cloud is null"));
  filter.setInputCloud(input_);
  EXPECT_THAT([&] { filter.filter(output); }, refusedWith("obstacle cloud is missing"));
  EXPECT_THAT([&] { filter.setObstacleCloud(std::make_shared<Cloud>()); }, refusedWith("field 'x' is missing"));

  filter.setObstacleCloud(input_);
  filter.setClearance(-1.0);
  EXPECT_THAT([&] { filter.filter(output); }, refusedWith("clearance"));
  filter.setClearance(1.0);
  const auto headless = fieldCloud<float>(points_);
  headless->fields.erase(headless->fields.begin() + 1);
  filter.setInputCloud(headless);
  EXPECT_THAT([&] { filter.filter(output); }, refusedWith("field 'x' is missing"));

  EXPECT_EQ(output.fields.size(), original_->fields.size());
  EXPECT_EQ(output.data, original_->data);
}

TEST_F(CollisionFilterPcl2Test, ErrorDoesNotSpoilTheNextCall)
{
  Filter filter;
  setUp(filter);
  filter.setInputCloud(fieldCloud<float>({points_[0]}));
  filter.setClearance(-1.0);
  Cloud output;
  EXPECT_THROW(filter.filter(output), std::invalid_argument);

  filter.setInputCloud(input_);
  filter.setClearance(clearance);
  filter.filter(output);
  expectRecords(output, *original_, where(flags_, false, points_));
}

TEST_F(CollisionFilterPcl2Test, AfterVoxelGrid)
{
  const auto dense = fieldCloud<float>(randomPoints(20000, 5));
  pcl::VoxelGrid<Cloud> voxels;
  voxels.setInputCloud(dense);
  voxels.setLeafSize(0.1f, 0.1f, 0.1f);
  const auto thinned = std::make_shared<Cloud>();
  voxels.filter(*thinned);
  Points points;
  const PointsView view = viewOf(*thinned);
  for (std::uint32_t i = 0; i < view.count; ++i) points.emplace_back(view.point(i).data());
  ASSERT_GT(points.size(), 500u);

  filter_.setInputCloud(thinned);
  expectRecords(filtered(), *thinned, where(doubleLoop(points, obstacle_, pose_, clearance), false, points));
}

} // namespace
} // namespace pcl_bsh
