// SPDX-License-Identifier: BSD-3-Clause
// Triangles as VTK's cells, with values.
#include <pcl_bsh/vtk/surface_data.h>

#include <gmock/gmock.h>

#include <vtkCellData.h>
#include <vtkDataArray.h>

#include <stdexcept>

namespace pcl_bsh::vtk {
namespace {

constexpr double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(SurfaceData, HasACellAndItsValuePerTriangle)
{
  const auto data = surfaceData(viewOf(&corners[0][0], 4), {{0, 1, 2}, {0, 2, 3}});
  ASSERT_EQ(data->GetNumberOfCells(), 2);
  addTriangleArray(*data, "flags", std::vector<std::uint8_t>{0, 1});
  addTriangleArray(*data, "poses", std::vector<std::int32_t>{-1, 7});
  addTriangleArray(*data, "distance", std::vector<float>{0.5f, 0.25f});
  EXPECT_EQ(data->GetCellData()->GetArray("flags")->GetTuple1(1), 1.0);
  EXPECT_EQ(data->GetCellData()->GetArray("poses")->GetTuple1(0), -1.0);
  EXPECT_EQ(data->GetCellData()->GetArray("distance")->GetTuple1(1), 0.25);
}

TEST(SurfaceData, RefusesWhatIsNotThere)
{
  EXPECT_THROW(surfaceData(viewOf(&corners[0][0], 4), {{0, 1, 4}}), std::invalid_argument);
  const auto data = surfaceData(viewOf(&corners[0][0], 4), {{0, 1, 2}});
  EXPECT_THAT(
      [&] {
        addTriangleArray(*data, "flags", std::vector<std::uint8_t>{0, 1});
      },
      testing::ThrowsMessage<std::invalid_argument>("array flags: 2 values for 1 triangle: give one per triangle"));
}

} // namespace
} // namespace pcl_bsh::vtk
