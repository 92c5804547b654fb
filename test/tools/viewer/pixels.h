// SPDX-License-Identifier: BSD-3-Clause
// Pictures as numbers, a display of one's own, and a few clouds to look at.
#pragma once

#include "tools/programs/program_run.h"

#include <pcl_bsh/tools/viewer/actors/palette.h>
#include <pcl_bsh/tools/viewer/content/view_content.h>
#include <pcl_bsh/tools/viewer/render_view.h>
#include <pcl_bsh/tools/viewer/view_options.h>

#include <pcl_bsh/vtk/display.h>
#include <pcl_bsh/vtk/offscreen_window.h>

#include <gtest/gtest.h>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace pcl_bsh::viewer {

/// Rows from the bottom up, three bytes a pixel.
struct Pixels {
  int width = 0, height = 0;
  std::vector<unsigned char> bytes;

  Color at(int x, int y) const
  {
    const auto i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {bytes[i], bytes[i + 1], bytes[i + 2]};
  }

  /// Counts pixels of a square around (x, y) for which ask(x, y) holds.
  template <class Ask>
  std::size_t countIf(int x, int y, int reach, const Ask& ask) const
  {
    std::size_t found = 0;
    for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
      for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u) found += ask(u, v) ? 1 : 0;
    return found;
  }

  std::size_t countNear(const Color& color, int x, int y, int reach, int off = 8) const
  {
    return countIf(x, y, reach, [&](int u, int v) {
      const Color c = at(u, v);
      return std::abs(c[0] - color[0]) <= off && std::abs(c[1] - color[1]) <= off && std::abs(c[2] - color[2]) <= off;
    });
  }
  std::size_t count(const Color& color, int off = 8) const { return countNear(color, 0, 0, 1 << 20, off); }

  std::size_t differing(const Pixels& other, int x = 0, int y = 0, int reach = 1 << 20) const
  {
    return countIf(x, y, reach, [&](int u, int v) { return at(u, v) != other.at(u, v); });
  }
};

inline Pixels pixelsOf(vtkRenderWindow& window)
{
  window.Render();
  Pixels pixels;
  pixels.width = window.GetSize()[0];
  pixels.height = window.GetSize()[1];
  vtkNew<vtkUnsignedCharArray> data;
  window.GetPixelData(0, 0, pixels.width - 1, pixels.height - 1, 0, data);
  pixels.bytes.assign(data->GetPointer(0), data->GetPointer(0) + data->GetNumberOfValues());
  return pixels;
}

inline Pixels readPng(const std::filesystem::path& path)
{
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData* const image = reader->GetOutput();
  Pixels pixels;
  pixels.width = image->GetDimensions()[0];
  pixels.height = image->GetDimensions()[1];
  const auto* const data = static_cast<const unsigned char*>(image->GetScalarPointer());
  pixels.bytes.assign(data, data + 3 * static_cast<std::size_t>(pixels.width * pixels.height));
  return pixels;
}

/// A view without a display that is asked where clouds are drawn.
struct OffscreenView {
  explicit OffscreenView(const Options& options) : content(makeViewContent(options))
  {
    window = vtk::makeOffscreenWindow(options.width, options.height);
    window->AddRenderer(renderer);
    view = std::make_unique<RenderView>(*content, *renderer);
  }

  Pixels draw() { return pixelsOf(*window); }

  /// Where a point of the world lands, in pixels from the lower left.
  std::array<int, 2> seen(const double* p)
  {
    renderer->SetWorldPoint(p[0], p[1], p[2], 1.0);
    renderer->WorldToDisplay();
    const double* const at = renderer->GetDisplayPoint();
    return {static_cast<int>(std::lround(at[0])), static_cast<int>(std::lround(at[1]))};
  }

  std::unique_ptr<ViewContent> content;
  vtkNew<vtkRenderer> renderer;
  vtkSmartPointer<vtkRenderWindow> window;
  std::unique_ptr<RenderView> view;
};

/// An X server of the test's own, for as long as it lives; DISPLAY names it.
class Xvfb {
public:
  Xvfb()
  {
    constexpr int attempts = 5; // one that begins while that of another test ends may not answer
    for (int attempt = 1; !start() && attempt < attempts; ++attempt) stop();
  }
  ~Xvfb() { stop(); }
  Xvfb(const Xvfb&) = delete;
  Xvfb& operator=(const Xvfb&) = delete;

private:
  /// @return whether it answers
  bool start()
  {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    server_ = fork();
    if (server_ == 0) {
      close(ends[0]);
      prctl(PR_SET_PDEATHSIG, SIGKILL); // a test that crashes must not leave it behind, with ctest's pipe
      const std::string number = std::to_string(ends[1]);
      (void)!freopen("/dev/null", "w", stderr);
      execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "800x600x24", nullptr);
      _exit(127);
    }
    close(ends[1]);
    std::string display;
    for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) display += c;
    close(ends[0]);
    if (display.empty()) throw std::runtime_error("Xvfb does not start: install the package xvfb");
    setenv("DISPLAY", (":" + display).c_str(), 1);
    return vtk::haveDisplay();
  }

  void stop() const
  {
    unsetenv("DISPLAY");
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
  }

  pid_t server_ = -1;
};

/// A floor of 4 x 4 with colours and intensity, a ball of radius 0.25, and a path that dips into the floor.
class ViewTest : public testing::Test {
protected:
  static std::string floorPly()
  {
    std::ostringstream text;
    constexpr int side = 81;
    text
        << "ply\nformat ascii 1.0\nelement vertex " << side * side
        << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty "
           "uchar blue\nproperty float intensity\nend_header\n";
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j)
        text << 0.05 * i - 2 << ' ' << 0.05 * j - 2 << ' ' << 0.001 * ((i * 7 + j * 3) % 10) << ' '
             << (i < side / 2 ? "255 0 0 " : "0 0 255 ") << i << '\n';
    return text.str();
  }

  static std::string ballXyz()
  {
    std::ostringstream text;
    for (int i = 0; i < 1500; ++i) {
      const double z = 1 - 2 * (i + 0.5) / 1500, turn = 2.399963 * i, r = std::sqrt(1 - z * z);
      text << 0.25 * r * std::cos(turn) << ' ' << 0.25 * r * std::sin(turn) << ' ' << 0.25 * z << '\n';
    }
    return text.str();
  }

  io::TemporaryFolder folder;
  std::filesystem::path floor = folder.write("floor.ply", floorPly());
  std::filesystem::path ball = folder.write("ball.xyz", ballXyz());
  std::filesystem::path path = folder.write("path.txt", "1 0 0 -1 0 1 0 0 0 0 1 1\n1 0 0 0 0 1 0 0 0 0 1 0.2\n"
                                                        "1 0 0 1 0 1 0 0 0 0 1 0.1\n1 0 0 1.5 0 1 0 0 0 0 1 1\n");
};

} // namespace pcl_bsh::viewer
