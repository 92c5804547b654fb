// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/view_check.h>

#include <pcl_bsh/hierarchy/update.h>
#include <pcl_bsh/neighbors/neighbors.h>

#include <gmock/gmock.h>

#include <cfenv>
#include <stdexcept>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

std::string complaint(const PointsView& view)
{
  try {
    checkView("view", view);
  }
  catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "";
}

TEST(ViewCheck, RecordsNeedAStride)
{
  const std::vector<float> xyz(30);
  PointsView view{xyz.data(), 10};
  EXPECT_THAT(complaint(view), HasSubstr("stride of 0 bytes puts its 10 records over each other"));
  EXPECT_THROW(SphereHierarchy{view}, std::invalid_argument);
  view = viewOf(xyz.data(), 10, 3);
  EXPECT_THAT(complaint(view), HasSubstr("stride of 3 bytes"));
  view = viewOf(xyz.data(), 10, 8);
  EXPECT_THAT(complaint(view), HasSubstr("x and z at bytes 0 and 8 of records that are 8 bytes apart"));
}

TEST(ViewCheck, CoordinatesLieBesideEachOther)
{
  const std::vector<double> xyz(40);
  PointsView view = viewOf(xyz.data(), 10);
  view.offset = {0, 0, 0};
  EXPECT_THAT(complaint(view), HasSubstr("x and y at bytes 0 and 0"));
  view.offset = {0, 8, 12};
  EXPECT_THAT(complaint(view), HasSubstr("y and z at bytes 8 and 12"));
  view.offset = {16, 0, 8};
  EXPECT_EQ(complaint(view), "");
  view.count = 1;
  view.stride = 0;
  EXPECT_EQ(complaint(view), "");
  EXPECT_THAT(complaint(PointsView{xyz.data(), 1}), HasSubstr("x and y"));
}

TEST(ViewCheck, EachCoordinateMayHaveItsOwnArray)
{
  std::vector<float> xyz(30);
  for (std::size_t i = 0; i < 30; ++i) xyz[i] = static_cast<float>(i);
  PointsView view = viewOf(xyz.data(), 10, sizeof(float));
  view.offset = {0, 10 * sizeof(float), 20 * sizeof(float)};
  EXPECT_EQ(complaint(view), "");
  Neighbors found;
  EXPECT_EQ(nearestKSearch(SphereHierarchy(view), {9, 19, 29}, 1, found), 1u);
  EXPECT_EQ(found.indices[0], 9);
  EXPECT_EQ(found.squared_distances[0], 0.0f);
  view.count = 11;
  EXPECT_THAT(complaint(view), HasSubstr("x and y"));
  view = viewOf(xyz.data(), 2);
  view.offset = {0, 4, 22}; // of which only the third record's x lies over the first one's z
  EXPECT_EQ(complaint(view), "");
  view.count = 3;
  EXPECT_THAT(complaint(view), HasSubstr("x and z at bytes 0 and 22"));
}

TEST(ViewCheck, RecordsAreNamedByNumbersBelow2To31)
{
  const float xyz[3] = {0, 0, 0};
  const std::int32_t index = 0;
  PointsView view = viewOf(xyz, std::size_t{1} << 31);
  EXPECT_THAT(complaint(view), HasSubstr("2147483648 points are more than an index can name (2147483647)"));
  --view.count;
  EXPECT_EQ(complaint(view), "");
  view.count = 1;
  view.indices = &index;
  view.index_count = std::size_t{1} << 31;
  EXPECT_THAT(complaint(view), HasSubstr("2147483648 indices are more than the limit of 2^31 - 1"));
}

TEST(ViewCheck, WhoeverTakesAViewLooksAtIt)
{
  std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const PointsView good = viewOf(xyz.data(), 3);
  SphereHierarchy hierarchy(good);
  PointsView null = good, without_stride = good;
  null.data = nullptr;
  without_stride.stride = 0;
  const std::int32_t beyond[] = {0, 3};
  PointsView outside = good;
  outside.indices = beyond;
  outside.index_count = 2;
  for (const PointsView* bad : {&null, &without_stride}) {
    HierarchyUpdate update(hierarchy, nullptr, 0);
    EXPECT_THROW(update.commit(*bad), std::invalid_argument);
    EXPECT_THROW(hierarchy.refit(*bad), std::invalid_argument);
    EXPECT_THROW(SphereHierarchy{*bad}, std::invalid_argument);
  }
  const std::vector<float> radii(3, 1.0f);
  for (PointsView bad : {null, without_stride, outside}) {
    bad.radii = radii.data();
    NeighborLists found;
    EXPECT_THROW(nearestKSearch(hierarchy, bad, 1, found), std::invalid_argument);
    EXPECT_THROW(radiusSearch(hierarchy, bad, 1.0, found), std::invalid_argument);
    EXPECT_THROW(flagAnyInRadius(hierarchy, bad, 1.0), std::invalid_argument);
    EXPECT_THROW(anyInBalls(hierarchy, bad), std::invalid_argument);
  }
}

/// Bounds rest on rounding to nearest: a caller's own mode must not reach what it causes to be built.
TEST(SphereHierarchy, BuildsTheSameInAnyRoundingMode)
{
  std::vector<float> xyz;
  for (int i = 0; i < 3000; ++i) xyz.push_back(static_cast<float>((i * 7919) % 1000) / 7.0f);
  const auto nodesBuiltIn = [&](int mode) {
    const SphereHierarchy hierarchy(viewOf(xyz.data(), 1000));
    std::fesetround(mode);
    const bool sound = hierarchy.validate().none();
    const double spacing = hierarchy.coordinateSpacing();
    std::fesetround(FE_TONEAREST);
    EXPECT_TRUE(sound) << mode;
    return std::pair(hierarchy.statistics().mean_leaf_radius, spacing);
  };
  const auto nearest = nodesBuiltIn(FE_TONEAREST);
  for (const int mode : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) EXPECT_EQ(nodesBuiltIn(mode), nearest) << mode;
}

} // namespace
} // namespace pcl_bsh
