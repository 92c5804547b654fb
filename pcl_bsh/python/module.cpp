// SPDX-License-Identifier: BSD-3-Clause
// The extension module of the Python package pcl_bsh; package/pcl_bsh/__init__.py shows its names.
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/computing.h>
#include <pcl_bsh/version.h>

PYBIND11_MODULE(_core, module)
{
  using namespace pcl_bsh::python;
  pybind11::options options;
  options.disable_function_signatures(); // docstrings begin with one that Python's inspect reads
  options.disable_enum_members_docstring();
  module.attr("__version__") = PCL_BSH_VERSION_TEXT;
  takeTurnsWithInterpreter();
  bindWords(module);
  bindHierarchy(module);
  bindCollision(module);
  bindContacts(module);
  bindDistances(module);
  bindNeighbors(module);
  bindClusters(module);
  bindTrajectory(module);
  bindClashes(module);
  bindManyPoses(module);
  bindSurface(module);
  bindScene(module);
  bindFiles(module);
  bindPipeline(module);
}
