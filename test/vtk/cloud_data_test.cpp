// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/cloud_data.h>
#include <pcl_bsh/vtk/path_data.h>

#include <gmock/gmock.h>

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <limits>
#include <stdexcept>
#include <vector>

namespace pcl_bsh::vtk {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(CloudData, KeepsFinitePointsWithTheirNumbersAndType)
{
  const double xyz[] = {500000.125, 1, 2, nan, 0, 0, 3, 4, 5};
  const auto data = cloudData(viewOf(xyz, 3));
  ASSERT_EQ(data->GetNumberOfPoints(), 2);
  EXPECT_EQ(data->GetNumberOfVerts(), 1) << "one poly-vertex cell";
  EXPECT_EQ(data->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(data->GetPoint(0)[0], 500000.125);
  EXPECT_EQ(data->GetPointData()->GetArray("index")->GetTuple1(1), 2);
  const float near[] = {1, 2, 3};
  EXPECT_EQ(cloudData(viewOf(near, 1))->GetPoints()->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(cloudData(PointsView{})->GetNumberOfPoints(), 0);
}

TEST(CloudData, ArraysAndSubsetsFollowTheNumbers)
{
  const float xyz[] = {0, 0, 0, static_cast<float>(nan), 0, 0, 2, 0, 0, 3, 0, 0};
  const auto data = cloudData(viewOf(xyz, 4));
  addArray(*data, "collision", std::vector<std::uint8_t>{0, 1, 1, 0});
  addArray(*data, "first_pose", std::vector<std::int32_t>{-1, 8, 7, -1});
  addArray(*data, "distance", std::vector<float>{0.5f, 1.5f, 2.5f, 3.5f});
  EXPECT_EQ(data->GetPointData()->GetArray("first_pose")->GetTuple1(1), 7);
  const auto some = subset(*data, {0, 1, 1, 0});
  ASSERT_EQ(some->GetNumberOfPoints(), 1) << "the point that is not finite is not there";
  EXPECT_EQ(some->GetPoint(0)[0], 2);
  EXPECT_EQ(some->GetPointData()->GetArray("distance")->GetTuple1(0), 2.5);
  EXPECT_EQ(some->GetPointData()->GetArray("index")->GetTuple1(0), 2);
  EXPECT_THAT(
      [&] { addArray(*data, "short", std::vector<float>{1.0f}); },
      testing::ThrowsMessage<std::invalid_argument>(testing::StartsWith("array short: 1 value, and none for point ")));
}

/// In whichever coordinate it is.
TEST(CloudData, LeavesOutWhatIsNotFinite)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const double xyz[] = {0, nan, 0, 0, 0, infinite, 1, 2, 3, -infinite, 0, 0};
  const auto data = cloudData(viewOf(xyz, 4));
  ASSERT_EQ(data->GetNumberOfPoints(), 1);
  EXPECT_EQ(data->GetPointData()->GetArray("index")->GetTuple1(0), 2);
}

TEST(CloudData, DataOfOthersIsRefused)
{
  vtkNew<vtkPolyData> other;
  EXPECT_THAT(([&] { addArray(*other, "distance", std::vector<float>{1.0f}); }),
              testing::ThrowsMessage<std::invalid_argument>(
                  "array distance: the data has no array 'index': take it from cloudData()"));
  EXPECT_THAT(([&] { subset(*other, {1}); }), testing::ThrowsMessage<std::invalid_argument>(
                                                  "subset: the data has no array 'index': take it from cloudData()"));
}

TEST(CloudData, SubsetsKeepDoubles)
{
  const double xyz[] = {0, 0, 0, 500000.125, 5400000.0625, 2};
  const auto some = subset(*cloudData(viewOf(xyz, 2)), {0, 1});
  ASSERT_EQ(some->GetNumberOfPoints(), 1);
  EXPECT_EQ(some->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(some->GetPoint(0)[1], 5400000.0625);
}

TEST(CloudData, ThinsEvenly)
{
  std::vector<float> xyz(3000, 0.0f);
  for (std::size_t i = 0; i < 1000; ++i) xyz[3 * i] = static_cast<float>(i);
  const auto data = cloudData(viewOf(xyz.data(), 1000));
  const auto few = thinned(*data, 100);
  ASSERT_EQ(few->GetNumberOfPoints(), 100);
  EXPECT_EQ(few->GetPoint(50)[0], 500);
  EXPECT_EQ(thinned(*data, 1000), data);
}

TEST(PathData, IsALineWithTimes)
{
  std::vector<Eigen::Isometry3d> poses(3, Eigen::Isometry3d::Identity());
  poses[1].translation().x() = 1;
  poses[2].translation().x() = 3;
  const auto path = pathData(poses, {0.0, 0.5, 2.0}, {0, 1, 0});
  ASSERT_EQ(path->GetNumberOfPoints(), 3);
  EXPECT_EQ(path->GetNumberOfLines(), 1);
  EXPECT_EQ(path->GetPoint(2)[0], 3);
  EXPECT_EQ(path->GetPoint(2)[1], 1);
  EXPECT_EQ(path->GetPointData()->GetArray("time")->GetTuple1(1), 0.5);
  EXPECT_EQ(path->GetPointData()->GetArray("pose")->GetTuple1(2), 2);
  EXPECT_EQ(pathData(poses)->GetPointData()->GetArray("time")->GetTuple1(2), 2);
  EXPECT_EQ(pathData({})->GetNumberOfPoints(), 0);
  EXPECT_EQ(pathData({})->GetNumberOfLines(), 0) << "not one of no points";
  poses.resize(1);
  EXPECT_THAT(
      [&] {
        pathData(poses, {1.0, 2.0});
      },
      testing::ThrowsMessage<std::invalid_argument>("times: 2 for 1 pose: give one per pose, or none"));
}

} // namespace
} // namespace pcl_bsh::vtk
