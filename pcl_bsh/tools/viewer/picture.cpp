// SPDX-License-Identifier: BSD-3-Clause
#include "picture.h"

#include "render_view.h"
#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/vtk/offscreen_window.h>

#include <vtkNew.h>
#include <vtkRenderer.h>

#include <iostream>

namespace pcl_bsh::viewer {

void drawFiles(const ViewContent& content)
{
  const Options& options = content.options();
  const auto window = vtk::makeOffscreenWindow(options.width, options.height);
  vtkNew<vtkRenderer> renderer;
  window->AddRenderer(renderer);
  RenderView view(content, *renderer);
  if (content.site()) {
    cli::Step step("Loading the tiles that the camera sees nearest");
    while (view.loadTile()) {
    }
    step.done(view.tilesText());
  }
  if (options.screenshot) {
    cli::Step step("Drawing " + options.screenshot->string());
    vtk::writePng(*window, *options.screenshot);
    step.done(std::to_string(options.width) + " x " + std::to_string(options.height) + " pixels");
    std::cout << "wrote " << options.screenshot->string() << '\n';
  }
  if (options.export_to) {
    view.exportTo(*options.export_to);
    std::cout << "wrote " << options.export_to->string() << '\n';
  }
}

} // namespace pcl_bsh::viewer
