// SPDX-License-Identifier: BSD-3-Clause
// A surface, lit, so that its shape is seen.
#pragma once

#include "palette.h"
#include <pcl_bsh/tools/viewer/content/viewed_cloud.h>

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

namespace pcl_bsh::viewer {

/// Of the cloud's triangles, in one colour. Cannot be picked: what is asked about is the balls of its cover.
/// @pre viewed.surface has triangles
vtkSmartPointer<vtkActor> addSurface(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color);

} // namespace pcl_bsh::viewer
