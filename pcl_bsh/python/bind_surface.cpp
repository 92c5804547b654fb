// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/asked.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <string>

namespace pcl_bsh::python {
namespace {

constexpr auto kCover =
    R"(Balls that hold every point of a mesh's triangles and hardly more, so that every query answers for the surface.

Parameters
----------
vertices : array_like, (n, 3), float32 or float64
triangles : array_like of int, (t, 3)
    Rows of the vertices.
tolerance : float
    How far a ball may reach beyond the surface; > 0. Free is farther than the clearance from the surface, colliding is
    within clearance + tolerance.
triangles_apart : bool, default False
    Each ball holds parts of one triangle only.
progress : callable, optional
    Called now and then with the fraction done; False stops, and raises `Cancelled`.

Returns
-------
SurfaceCover
    `centers` (m, 3) float64, `radii` (m,) float32, `triangles` (m,) uint32: the one that each centre lies on. Its
    `hierarchy()` is what queries take.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> cover = pcl_bsh.cover_surface(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), [[0, 1, 2]], 0.05)
>>> plate = cover.hierarchy()
>>> scan = pcl_bsh.SphereHierarchy(np.array([[0.25, 0.25, 0.2], [0.25, 0.25, 0.5]]))
>>> pcl_bsh.collision_flags(scan, plate, clearance=0.3)
array([1, 0], dtype=uint8)
)";

/// Owns a cover for the hierarchy of its balls.
class KeptCover : public Owner {
public:
  std::shared_ptr<const SurfaceCover> cover;
};

std::shared_ptr<SurfaceCover> coverOf(const ArrayLike& vertices, const ArrayLike& triangles, double tolerance,
                                      bool triangles_apart, const ProgressLike& progress)
{
  py::array kept;
  const PointsView view = viewForCall("vertices", vertices, kept);
  const ArrayLock lock(kept); // progress may run Python code
  const std::vector<std::uint32_t> corners = recordsOf("triangles", triangles, 3);
  std::vector<Triangle> list;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) list.push_back({corners[i], corners[i + 1], corners[i + 2]});
  SurfaceRequest request;
  request.tolerance = tolerance;
  request.triangles_apart = triangles_apart;
  request.progress = progressOf(progress);
  return unlocked([&] { return std::make_shared<SurfaceCover>(coverSurface(view, list, request)); });
}

std::shared_ptr<Cloud> hierarchyOf(const std::shared_ptr<SurfaceCover>& cover, unsigned threads)
{
  auto owner = std::make_shared<KeptCover>();
  owner->cover = cover;
  PointsView view = cover->view();
  view.owner = std::shared_ptr<const void>(owner, static_cast<const Owner*>(owner.get()));
  HierarchyOptions options;
  options.threads = threads;
  return unlocked([&] { return std::make_shared<Cloud>(view, options); });
}

} // namespace

void bindSurface(py::module_& module)
{
  py::class_<SurfaceCover, std::shared_ptr<SurfaceCover>>(module, "SurfaceCover", "The answer of `cover_surface`.")
      .def_property_readonly("centers",
                             [](const py::object& self) {
                               const auto& cover = self.cast<const SurfaceCover&>();
                               const double* const first = cover.centers.empty() ? nullptr : cover.centers[0].data();
                               return arrayIn(self, first, {static_cast<py::ssize_t>(cover.centers.size()), 3});
                             })
      .def_property_readonly("radii", column(&SurfaceCover::radii))
      .def_property_readonly("triangles", column(&SurfaceCover::triangles))
      .def_readonly("tolerance", &SurfaceCover::tolerance)
      .def_readonly("area", &SurfaceCover::area, "Of all triangles.")
      .def("hierarchy", &hierarchyOf, py::kw_only(), "threads"_a = 1,
           "The hierarchy of the balls; it keeps them alive.")
      .def("__len__", [](const SurfaceCover& cover) { return cover.radii.size(); })
      .def("__repr__", [](const SurfaceCover& cover) {
        return "SurfaceCover(" + counted(cover.radii.size(), "ball") + ", tolerance " + numberText(cover.tolerance) +
               ")";
      });
  module.def("cover_surface", &coverOf, kCover, "vertices"_a, "triangles"_a, "tolerance"_a, py::kw_only(),
             "triangles_apart"_a = false, "progress"_a = py::none());
}

} // namespace pcl_bsh::python
