// SPDX-License-Identifier: BSD-3-Clause
// Clouds, where they collide, and the spheres that find it: in a window, as a picture, or as files for ParaView.
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/viewer/content/view_content.h>
#include <pcl_bsh/tools/viewer/view_options.h>
#include <pcl_bsh/tools/viewer/viewer.h>

#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/scenes/scene_file.h>
#include <pcl_bsh/vtk/display.h>
#include <pcl_bsh/vtk/write_data.h>

namespace {

using namespace pcl_bsh;

/// Checks all that can be checked before the first cloud is loaded.
void check(const viewer::Options& options)
{
  cli::CommandFiles files = options.files;
  if (options.scene) {
    const io::SceneFile scene = io::readSceneFile(*options.scene);
    for (const auto& [what, path] : scene.files()) files.reads("--scene", path);
  }
  files.requireApart();
  if (options.screenshot) files::requireWritable(*options.screenshot);
  if (options.export_to) pcl_bsh::vtk::requireWritableData(*options.export_to);
  if (!options.screenshot && !options.export_to && !pcl_bsh::vtk::haveDisplay())
    throw std::runtime_error("DISPLAY: no X server answers there, so no window can open: set DISPLAY, or give "
                             "--screenshot FILE.png, which needs none");
}

int show(const viewer::Options& options)
{
  check(options);
  const std::unique_ptr<viewer::ViewContent> content = viewer::makeViewContent(options);
  if (options.screenshot || options.export_to)
    viewer::drawFiles(*content);
  else
    viewer::Viewer(*content).run();
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(viewer::program, viewer::parseOptions, show, argc, argv);
}
