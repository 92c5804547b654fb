// SPDX-License-Identifier: BSD-3-Clause
// A window to draw into which is not shown, with or without a display.
#pragma once

#include <pcl_bsh/export.h>

#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

#include <filesystem>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// A window of width x height pixels for vtkRenderers. Needs no display: without one it draws through EGL, where an
/// ordinary window of VTK would end the program.
/// @throws std::runtime_error when there is neither
vtkSmartPointer<vtkRenderWindow> makeOffscreenWindow(int width, int height);

/// Renders the window and writes it as a PNG file; through a temporary one, so that nothing is left half-written.
/// @throws std::runtime_error naming the file
void writePng(vtkRenderWindow& window, const std::filesystem::path& path);

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
