// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/offscreen_window.h>

#include <gtest/gtest.h>

#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkStringOutputWindow.h>

#include <cstdlib>
#include <string>

namespace pcl_bsh::vtk {
namespace {

/// All but one, which every window without a display gives.
TEST(OffscreenWindow, ErrorsOfDrawingAreTold)
{
  unsetenv("DISPLAY");
  const auto window = makeOffscreenWindow(20, 10);
  const vtkSmartPointer<vtkOutputWindow> before = vtkOutputWindow::GetInstance();
  vtkNew<vtkStringOutputWindow> heard;
  vtkOutputWindow::SetInstance(heard);
  std::string expected = "ERROR: GLEW could not be initialized: No GLX display", other = "no memory is left";
  window->InvokeEvent(vtkCommand::ErrorEvent, expected.data());
  EXPECT_EQ(heard->GetOutput(), "");
  window->InvokeEvent(vtkCommand::ErrorEvent, other.data());
  EXPECT_NE(heard->GetOutput().find(other), std::string::npos);
  vtkOutputWindow::SetInstance(before);
}

} // namespace
} // namespace pcl_bsh::vtk
