// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/display.h>

#include <X11/Xlib.h> // here alone: its macros are everywhere

namespace pcl_bsh::vtk {

bool haveDisplay()
{
  Display* const display = XOpenDisplay(nullptr);
  if (display) XCloseDisplay(display);
  return display != nullptr;
}

} // namespace pcl_bsh::vtk
