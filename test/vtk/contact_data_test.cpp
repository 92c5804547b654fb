// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/contact_data.h>

#include <gtest/gtest.h>

#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <algorithm>

namespace pcl_bsh::vtk {
namespace {

Contact contactAt(const Eigen::Vector3d& place, const Eigen::Vector3d& normal, double gap)
{
  Contact contact;
  contact.place_b = place;
  contact.place_a = place + gap * normal;
  contact.normal = normal;
  contact.distance = gap;
  contact.id = 7;
  contact.patch = 2;
  return contact;
}

TEST(ContactData, HasPlacesNormalsAndSignedGaps)
{
  const auto data =
      contactData({contactAt({5e6 + 0.125, 2, 3}, {0, 0, 1}, -0.25), contactAt({4, 5, 6}, {1, 0, 0}, 0.5)});
  ASSERT_EQ(data->GetNumberOfPoints(), 2);
  EXPECT_EQ(data->GetPoint(0)[0], 5e6 + 0.125);
  vtkPointData& arrays = *data->GetPointData();
  EXPECT_EQ(arrays.GetArray("gap")->GetTuple1(0), -0.25);
  EXPECT_EQ(arrays.GetArray("gap")->GetTuple1(1), 0.5);
  EXPECT_EQ(arrays.GetArray("normal")->GetTuple3(1)[0], 1.0);
  EXPECT_EQ(arrays.GetVectors(), arrays.GetArray("normal"));
  EXPECT_EQ(arrays.GetArray("place_a")->GetTuple3(0)[2], 2.75);
  EXPECT_EQ(arrays.GetArray("id")->GetTuple1(0), 7);
  EXPECT_EQ(arrays.GetArray("patch")->GetTuple1(1), 2);
  EXPECT_EQ(contactData({})->GetNumberOfPoints(), 0);
}

TEST(ContactData, ArrowsBeginAtThePlaceAndFollowTheNormal)
{
  const auto data = contactData({contactAt({5e6, 2, 3}, {0, 0.6, 0.8}, -0.25)});
  const auto arrows = contactArrows(*data, 0.5);
  ASSERT_GT(arrows->GetNumberOfCells(), 0);
  double lowest = 1e9, highest = -1e9;
  for (vtkIdType i = 0; i < arrows->GetNumberOfPoints(); ++i) {
    const Eigen::Vector3d from = Eigen::Vector3d(arrows->GetPoint(i)) - Eigen::Vector3d(5e6, 2, 3);
    const double along = from.dot(Eigen::Vector3d(0, 0.6, 0.8));
    EXPECT_LT((from - along * Eigen::Vector3d(0, 0.6, 0.8)).norm(), 0.06) << "it is thin";
    lowest = std::min(lowest, along), highest = std::max(highest, along);
  }
  EXPECT_NEAR(lowest, 0.0, 1e-6);
  EXPECT_NEAR(highest, 0.5, 1e-6);
  EXPECT_EQ(arrows->GetPointData()->GetArray("gap")->GetTuple1(0), -0.25);
}

TEST(ContactData, WithoutADirectionThereIsNoArrow)
{
  const auto arrows = contactArrows(*contactData({contactAt({1, 2, 3}, {0, 0, 0}, 0.0)}), 0.5);
  double bounds[6];
  arrows->GetBounds(bounds);
  EXPECT_TRUE(arrows->GetNumberOfPoints() == 0 || bounds[1] - bounds[0] < 1e-6);
}

} // namespace
} // namespace pcl_bsh::vtk
