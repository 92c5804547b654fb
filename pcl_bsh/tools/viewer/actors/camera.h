// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "visibility.h"

#include <pcl_bsh/tools/viewer/view_options.h>

#include <vtkBoundingBox.h>
#include <vtkRenderer.h>

#include <span>

namespace pcl_bsh::viewer {

/// Puts the camera where it sees the whole box, or where it is given.
/// @param aspect width of the picture divided by its height, of which the box may take `free_width`
/// @param things for Camera::Kind::colliding, which looks from the side that sees most of their marks. It takes the
///   slanted one where no other side shows clearly more
void look(vtkRenderer& renderer, const Camera& camera, const vtkBoundingBox& seen, double aspect, double free_width,
          std::span<const Drawn> things = {});

} // namespace pcl_bsh::viewer
