// SPDX-License-Identifier: BSD-3-Clause
// Points so far off that a picture with them shows nothing of the others: a sensor's "no return", written as a number.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace pcl_bsh::viewer {

/// The cloud without the points that lie more than a thousand times as far from its bulk (99 of 100 points, along each
/// axis) as that is large; the cloud itself where there are none, or the bulk is one place.
vtkSmartPointer<vtkPolyData> withoutFarPoints(vtkPolyData& cloud);

} // namespace pcl_bsh::viewer
