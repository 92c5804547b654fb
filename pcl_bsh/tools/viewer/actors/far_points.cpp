// SPDX-License-Identifier: BSD-3-Clause
#include "far_points.h"

#include <pcl_bsh/vtk/cloud_data.h>

#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace pcl_bsh::viewer {
namespace {

constexpr double tail = 0.005; // of the points, at each end of an axis
constexpr double farthest = 1000.0;

struct Bulk {
  std::array<double, 3> low, high;
  double size = 0.0;
};

Bulk bulkOf(vtkPolyData& cloud)
{
  Bulk bulk;
  const auto count = static_cast<std::size_t>(cloud.GetNumberOfPoints());
  std::vector<double> along(count);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < count; ++i) along[i] = cloud.GetPoint(static_cast<vtkIdType>(i))[k];
    const auto at = [&](double share) {
      const auto nth = along.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(count - 1));
      std::nth_element(along.begin(), nth, along.end());
      return *nth;
    };
    bulk.low[k] = at(tail);
    bulk.high[k] = at(1.0 - tail);
    bulk.size = std::max(bulk.size, bulk.high[k] - bulk.low[k]);
  }
  return bulk;
}

} // namespace

vtkSmartPointer<vtkPolyData> withoutFarPoints(vtkPolyData& cloud)
{
  const vtkIdType count = cloud.GetNumberOfPoints();
  if (count == 0) return &cloud;
  const double* const bounds = cloud.GetBounds();
  const double size = std::max({bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]});
  const Bulk bulk = bulkOf(cloud);
  if (!(bulk.size > 0.0) || size <= farthest * bulk.size) return &cloud;
  vtkDataArray& index = *cloud.GetPointData()->GetArray("index");
  std::vector<std::uint8_t> near;
  for (vtkIdType i = 0; i < count; ++i) {
    const double* const p = cloud.GetPoint(i);
    const auto record = static_cast<std::size_t>(index.GetTuple1(i));
    near.resize(std::max(near.size(), record + 1));
    near[record] = 1;
    for (std::size_t k = 0; k < 3; ++k)
      if (bulk.low[k] - p[k] > farthest * bulk.size || p[k] - bulk.high[k] > farthest * bulk.size) near[record] = 0;
  }
  return vtk::subset(cloud, near);
}

} // namespace pcl_bsh::viewer
