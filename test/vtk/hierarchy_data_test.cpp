// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/hierarchy_data.h>
#include <pcl_bsh/vtk/write_data.h>

#include "io/clouds/samples.h"
#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include <cmath>
#include <stdexcept>

namespace pcl_bsh::vtk {
namespace {

using test::makePoints;
using test::Shape;

class HierarchyData : public testing::Test {
protected:
  double value(vtkPolyData& data, const char* name, vtkIdType i) const
  {
    return data.GetPointData()->GetArray(name)->GetTuple1(i);
  }

  test::Random random{5};
  test::Cloud cloud{makePoints(Shape::sphere, 6000, 1.0, random)};
  SphereHierarchy hierarchy{cloud.view(), [] {
                              HierarchyOptions made;
                              made.voxel_edge = 0.5;
                              return made;
                            }()};
};

TEST_F(HierarchyData, SpheresOfEachLevelHoldAllPoints)
{
  const unsigned deepest = deepestLevel(hierarchy);
  ASSERT_GE(deepest, 2u);
  double radius_above = 1e9;
  for (unsigned level = 0; level <= deepest; ++level) {
    const auto spheres = sphereData(hierarchy, level);
    double points = 0, largest = 0, lowest = 0;
    for (vtkIdType i = 0; i < spheres->GetNumberOfPoints(); ++i) {
      points += value(*spheres, "points", i);
      largest = std::max(largest, value(*spheres, "radius", i));
      lowest = std::max(lowest, value(*spheres, "level", i));
      EXPECT_LT(value(*spheres, "voxel", i), static_cast<double>(hierarchy.statistics().voxels));
    }
    EXPECT_EQ(lowest, level) << "leaves above it keep their own";
    EXPECT_EQ(points, 6000) << "level " << level;
    EXPECT_LE(largest, radius_above);
    radius_above = largest;
    for (std::uint32_t record = 0; record < 6000; record += 97) {
      const Point3 p = cloud.view().point(record);
      bool held = false;
      for (vtkIdType i = 0; i < spheres->GetNumberOfPoints() && !held; ++i) {
        const double* const c = spheres->GetPoint(i);
        held = std::hypot(p[0] - c[0], p[1] - c[1], p[2] - c[2]) <= value(*spheres, "radius", i) * (1 + 1e-6);
      }
      EXPECT_TRUE(held) << "level " << level << ", point " << record;
    }
  }
  EXPECT_EQ(sphereData(hierarchy, deepest)->GetNumberOfPoints(),
            sphereData(hierarchy, deepest + 5)->GetNumberOfPoints());
}

TEST_F(HierarchyData, LevelZeroBuildsNothing)
{
  sphereData(hierarchy, 0);
  voxelBoxes(hierarchy);
  cellBoxes(hierarchy, 0);
  EXPECT_EQ(hierarchy.statistics().voxels_built, 0u);
}

TEST_F(HierarchyData, GlyphsReachAsFarAsTheirSpheres)
{
  const auto spheres = sphereData(hierarchy, 0);
  const auto glyphs = sphereGlyphs(*spheres, 24);
  double low = 1e9;
  for (vtkIdType i = 0; i < spheres->GetNumberOfPoints(); ++i)
    low = std::min(low, spheres->GetPoint(i)[2] - value(*spheres, "radius", i));
  EXPECT_NEAR(glyphs->GetBounds()[4], low, 1e-5) << "the poles are corners";
  EXPECT_NE(glyphs->GetPointData()->GetArray("radius"), nullptr);
}

TEST_F(HierarchyData, VoxelsAreCubesOfTheGridAndHoldTheirCells)
{
  const auto cubes = voxelBoxes(hierarchy);
  const auto voxels = static_cast<vtkIdType>(hierarchy.statistics().voxels);
  ASSERT_EQ(cubes->GetNumberOfPoints(), 8 * voxels);
  ASSERT_EQ(cubes->GetNumberOfLines(), 12 * voxels);
  const auto cells = cellBoxes(hierarchy, 2);
  ASSERT_GT(cells->GetNumberOfPoints(), cubes->GetNumberOfPoints());
  vtkDataArray* const voxel_of = cells->GetCellData()->GetArray("voxel");
  for (vtkIdType cell = 0; cell < cells->GetNumberOfPoints() / 8; ++cell) {
    const auto voxel = static_cast<vtkIdType>(voxel_of->GetTuple1(12 * cell));
    for (int k = 0; k < 3; ++k) {
      const double low = cubes->GetPoint(8 * voxel)[k], high = cubes->GetPoint(8 * voxel + 7)[k];
      EXPECT_EQ(high - low, 0.5);
      EXPECT_EQ(std::remainder(low, 0.5), 0.0);
      EXPECT_GE(cells->GetPoint(8 * cell)[k], low - 1e-4);
      EXPECT_LE(cells->GetPoint(8 * cell + 7)[k], high + 1e-4);
    }
  }
}

TEST_F(HierarchyData, FilesReadBack)
{
  const io::TemporaryFolder folder;
  const auto spheres = sphereData(hierarchy, 1);
  writeVtp(*spheres, folder / "spheres.vtp");
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder / "spheres.vtp").c_str());
  reader->Update();
  ASSERT_EQ(reader->GetOutput()->GetNumberOfPoints(), spheres->GetNumberOfPoints());
  for (const char* name : {"radius", "level", "voxel", "points"})
    for (vtkIdType i = 0; i < spheres->GetNumberOfPoints(); ++i)
      ASSERT_EQ(value(*reader->GetOutput(), name, i), value(*spheres, name, i));

  for (int again = 0; again < 2; ++again) { // replacing what is there
    writeVtm({{"spheres", spheres}, {"voxels", voxelBoxes(hierarchy)}}, folder / "all.vtm");
    vtkNew<vtkXMLMultiBlockDataReader> blocks;
    blocks->SetFileName((folder / "all.vtm").c_str());
    blocks->Update();
    auto* const all = vtkMultiBlockDataSet::SafeDownCast(blocks->GetOutput());
    ASSERT_EQ(all->GetNumberOfBlocks(), 2u);
    EXPECT_EQ(vtkPolyData::SafeDownCast(all->GetBlock(0))->GetNumberOfPoints(), spheres->GetNumberOfPoints());
    EXPECT_STREQ(all->GetMetaData(1u)->Get(vtkCompositeDataSet::NAME()), "voxels");
  }
  EXPECT_EQ(folder.files(), 3u) << "spheres.vtp, all.vtm, the folder all";
}

TEST_F(HierarchyData, AFolderThatIsNotThereIsAnError)
{
  const io::TemporaryFolder folder;
  EXPECT_THROW(writeVtp(*sphereData(hierarchy, 0), folder / "none" / "a.vtp"), std::runtime_error);
  EXPECT_THROW(writeVtm({}, folder / "none" / "a.vtm"), std::runtime_error);
  EXPECT_EQ(folder.files(), 0u);
}

TEST(HierarchyDataTrace, HasASphereOfEachTest)
{
  std::vector<TracedSphere> traced(2);
  traced[0] = {{500000.125, 1, 2}, 0.5, -1, SphereFate::opened};
  traced[1] = {{3, 4, 5}, 0.25, 7, SphereFate::pruned};
  const auto data = traceData(traced);
  ASSERT_EQ(data->GetNumberOfPoints(), 2);
  for (vtkIdType i = 0; i < 2; ++i) {
    const TracedSphere& sphere = traced[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) EXPECT_EQ(data->GetPoint(i)[k], sphere.center[static_cast<std::size_t>(k)]);
    EXPECT_EQ(data->GetPointData()->GetArray("radius")->GetTuple1(i), sphere.radius);
    EXPECT_EQ(data->GetPointData()->GetArray("level")->GetTuple1(i), sphere.level);
    EXPECT_EQ(data->GetPointData()->GetArray("fate")->GetTuple1(i), static_cast<int>(sphere.fate));
  }
  EXPECT_EQ(sphereGlyphs(*data, 6)->GetBounds()[5], 5.25);
}

TEST(HierarchyDataEmpty, NothingGivesNothing)
{
  const SphereHierarchy nothing{PointsView{}};
  EXPECT_EQ(sphereData(nothing, 0)->GetNumberOfPoints(), 0);
  EXPECT_EQ(sphereData(nothing, 3)->GetNumberOfPoints(), 0);
  EXPECT_EQ(voxelBoxes(nothing)->GetNumberOfPoints(), 0);
  EXPECT_EQ(deepestLevel(nothing), 0u);
}

} // namespace
} // namespace pcl_bsh::vtk
