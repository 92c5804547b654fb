// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/tools/viewer/options.h>

#include <vtkBoundingBox.h>
#include <vtkRenderer.h>

namespace pcl_bsh::viewer {

/// Puts the camera where it sees the whole box, or where it is given.
/// @param aspect width of the picture divided by its height, of which the box may take `free_width`
void look(vtkRenderer& renderer, const Camera& camera, const vtkBoundingBox& seen, double aspect, double free_width);

} // namespace pcl_bsh::viewer
