// SPDX-License-Identifier: BSD-3-Clause
// Whether windows can be opened here.
#pragma once

#include <pcl_bsh/export.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// Whether the X server that DISPLAY names answers. Where it does not, VTK's ordinary windows end the program. The
/// connection stays open until the next call: a server that loses its only client begins anew, and meanwhile lets
/// nobody in. Where the server answers, EGL, which draws without a display, lets go of this thread, so that windows may
/// be opened.
bool haveDisplay();

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
