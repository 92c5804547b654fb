// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/display.h>

#include <EGL/egl.h>
#include <X11/Xlib.h> // included here alone, as its macros are common words
#include <poll.h>

#include <mutex>

namespace pcl_bsh::vtk {

namespace {

/// Whether the server is still there: to close a connection that it has ended would end the program.
bool isOpen(Display* display)
{
  pollfd connection = {ConnectionNumber(display), POLLIN, 0};
  return poll(&connection, 1, 0) >= 0 && (connection.revents & (POLLHUP | POLLERR | POLLNVAL)) == 0;
}

} // namespace

bool haveDisplay()
{
  static std::mutex mutex;
  static Display* kept = nullptr;
  const std::lock_guard lock(mutex);
  Display* const display = XOpenDisplay(nullptr);
  if (!display) return false;
  if (kept && isOpen(kept)) XCloseDisplay(kept);
  kept = display;
  eglReleaseThread(); // GLX ends the program where EGL has this thread
  return true;
}

} // namespace pcl_bsh::vtk
