// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>

#include <pybind11/stl.h>

#include <optional>
#include <string>

namespace pcl_bsh::python {
namespace {

constexpr auto kHierarchy = R"(The bounding-sphere hierarchy of one cloud, in the cloud's own frame.

Points are sorted when it is made; spheres are built where queries come. Points that are not finite are left out. One
hierarchy may be asked by several threads at once.

Parameters
----------
xyz : array_like, (n, 3) or records with fields x, y, z
    float32 or float64 in this machine's byte order; other types are refused. Records may have any shape, as those of an
    organised cloud, (height, width); they are numbered row by row. It is read where it is, whatever its strides, and kept
    alive. Only rows that run backwards or lie over each other are copied, and records of several dimensions where the
    step from one to the next is not always the same (`in_place` tells).
radii : array_like of float32, (n,), optional
    Each point is a ball; finite, >= 0.
indices : array_like of int, (k,), optional
    Only these rows are points.
uncertainty : float, default 0
    How far each point may truly be from where it was measured, in the cloud's unit. Verdicts then hold wherever the
    points are.
uncertainties : array_like of float32, (n,), optional
    Added to `uncertainty`, for each point.
pose_uncertainty : str or 1, 2 or 5 numbers, optional
    How far every pose of the cloud may truly be off, on top: a length, an angle in radians, and the place x, y, z of the
    cloud that it turns about; or ``"covariance=SIGMAS:"`` and 36 numbers.
copy : bool, default False
    Keep a copy, and leave the arrays as they are.
voxel_edge : float, default 0
    Edge of a voxel; 0: from the density of the points.
threads : int, default 1
    For sorting; 0: all of the machine's.

Raises
------
ValueError
    Another shape or type; radii or uncertainties that are negative or not finite; indices outside the array.

Notes
-----
The points must not change while the hierarchy lives, so the arrays that it reads, and those that are their ``base``, are
read-only meanwhile (``flags.writeable`` is False, and True again when the last hierarchy that reads some of their memory
is gone). Other views that were made before can still write: do not use them, or give ``copy=True``.

An array that holds the hierarchy which reads it is freed by Python's garbage collector. ``os.fork`` waits until the
queries of other threads are done; so does the interpreter's end, for at most ten seconds.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> hall = pcl_bsh.SphereHierarchy(np.random.default_rng(1).random((1000, 3)))
>>> hall
SphereHierarchy(1000 points, float64)
)";

constexpr auto kOfTriangles = R"(The hierarchy of a mesh's triangles: every query takes it where points go.

Answers are exact for all of each triangle, and their records are triangles. A triangle may be a segment or a point; one
with a corner that is not finite is left out. The inside of a closed surface is no part of it.

Parameters
----------
vertices : array_like, (n, 3) or records with fields x, y, z
    As `xyz` of `SphereHierarchy`: read where they are.
triangles : array_like of int, (t, 3)
    Rows of the vertices; copied.
uncertainty : float, default 0
    How far each triangle may truly be from where it was measured.
pose_uncertainty : str or 1, 2 or 5 numbers, optional
    As of `SphereHierarchy`.
copy : bool, default False
    Keep a copy of the vertices, and leave the array as it is.
voxel_edge : float, default 0
    Edge of a voxel; 0: from the density of the triangles.
threads : int, default 1
    For sorting; 0: all of the machine's.

Raises
------
ValueError
    As `SphereHierarchy`; a triangle that names a row which is not there.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> plate = pcl_bsh.SphereHierarchy.of_triangles(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), [[0, 1, 2]])
>>> scan = pcl_bsh.SphereHierarchy(np.array([[0.25, 0.25, 0.2], [0.25, 0.25, 0.5]]))
>>> pcl_bsh.collision_flags(scan, plate, clearance=0.3)
array([1, 0], dtype=uint8)
)";

constexpr auto kRefit = R"(The points have moved: as many rows of the same type, other coordinates.

Trees stay as they are where they can, and their spheres are fitted to the points anew; answers are those of a new
hierarchy. It takes as long as measuring all spheres: for points that move a little, a part of what building takes.

Parameters
----------
xyz : array_like
    As that of `SphereHierarchy`; of triangles, their vertices. Not the array that the hierarchy reads now, which is read-only: that one is given back,
    and may be written to and given next.
radii, uncertainties : array_like of float32, (n,), optional
    None: as they were.
copy : bool, default False
    Keep a copy, and leave the arrays as they are.
most_growth : float, default 1.5
    A voxel's tree is dropped, and built on its next visit, when the radii of its leaves have grown by more than this
    factor on average.

Returns
-------
dict
    `sorted_anew`, `voxels_refitted`, `voxels_dropped`, `volumes_refitted`, `looseness`.

Raises
------
ValueError
    Another number or type of points. The hierarchy is then as it was.
RuntimeError
    Called by the `progress` of a query.

Notes
-----
It waits until no thread runs a query, of any hierarchy, and queries of other threads wait for it.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> here, there = np.zeros((1, 3)), np.ones((1, 3))
>>> ball = pcl_bsh.SphereHierarchy(here)
>>> report = ball.refit(there)
>>> here.flags.writeable, there.flags.writeable
(True, False)
>>> pcl_bsh.closest_pair(ball, pcl_bsh.SphereHierarchy(np.array([[1.0, 1.0, 3.0]]))).distance
2.0
)";

/// tp_traverse, for Python's collector: an array may refer to the hierarchy that keeps it.
int traverse(PyObject* self, visitproc visit, void* arg)
{
  Py_VISIT(Py_TYPE(self));
  auto* const instance = reinterpret_cast<py::detail::instance*>(self);
  if (!instance->simple_layout && !instance->nonsimple.status) return 0; // not made yet
  const auto held = instance->get_value_and_holder();
  if (!held.holder_constructed() || changesBegun() > 0) return 0;
  // A scene may hold it, too, and keeps it alive then. New holders are made with the interpreter's lock, so none comes
  // while the collector works.
  const auto& hierarchy = held.holder<std::shared_ptr<Cloud>>();
  if (hierarchy.use_count() != 1) return 0;
  const KeptArrays* const kept = arraysOf(hierarchy->view());
  return kept ? kept->traverse(visit, arg) : 0;
}

/// The collector breaks a cycle at the array, by clearing its attributes: tp_clear is not needed.
void setUpCollection(PyHeapTypeObject* heap_type)
{
  PyTypeObject& type = heap_type->ht_type;
  type.tp_flags |= Py_TPFLAGS_HAVE_GC;
  type.tp_traverse = &traverse;
  type.tp_dealloc = [](PyObject* self) {
    PyObject_GC_UnTrack(self);
    py::detail::pybind11_object_dealloc(self);
  };
}

std::size_t sizeOf(const Cloud& hierarchy)
{
  return unlocked([&] { return hierarchy.size(); });
}

std::string textOf(const Cloud& hierarchy)
{
  const PointsView view = viewNow(hierarchy);
  const std::size_t finite = sizeOf(hierarchy);
  std::string text = "SphereHierarchy(" + counted(finite, view.triangles ? "triangle" : "point");
  if (finite != view.size()) text += " of " + std::to_string(view.size());
  text += view.scalar == Scalar::float32 ? ", float32" : ", float64";
  if (view.areBalls()) text += ", with radii";
  if (view.isUncertain()) text += ", uncertain";
  return text + ")";
}

py::dict statisticsOf(const Cloud& hierarchy)
{
  const HierarchyStatistics statistics = unlocked([&] { return hierarchy.statistics(); });
  return py::dict("points"_a = statistics.points, "voxels"_a = statistics.voxels,
                  "voxels_built"_a = statistics.voxels_built, "nodes"_a = statistics.nodes,
                  "leaves"_a = statistics.leaves, "depth"_a = statistics.depth, "bytes"_a = statistics.bytes,
                  "voxel_edge"_a = statistics.voxel_edge, "requested_voxel_edge"_a = statistics.requested_voxel_edge,
                  "mean_leaf_points"_a = statistics.mean_leaf_points,
                  "mean_leaf_radius"_a = statistics.mean_leaf_radius);
}

py::dict refit(Cloud& hierarchy, const ArrayLike& xyz, const OptionalArray& radii, const OptionalArray& uncertainties,
               bool copy, double most_growth)
{
  return dictOf(whileNoneComputes(
      [&] {
        hierarchy.forget();
        return movedView(hierarchy.view(), {xyz, radii, py::none(), 0.0, uncertainties, copy});
      },
      [&](const MovedView& moved) { return hierarchy.refit(moved.now, most_growth); }));
}

std::shared_ptr<Cloud> make(const ArrayLike& xyz, const OptionalArray& radii, const OptionalArray& indices,
                            double uncertainty, const OptionalArray& uncertainties,
                            const PoseUncertaintyLike& pose_uncertainty, bool copy, double voxel_edge, unsigned threads)
{
  const PointsView view = viewOfPoints(
      "points", {xyz, radii, indices, uncertainty, uncertainties, copy, poseUncertaintyOf(pose_uncertainty)});
  HierarchyOptions options;
  options.voxel_edge = voxel_edge;
  options.threads = threads;
  return unlocked([&] { return std::make_shared<Cloud>(view, options); });
}

std::shared_ptr<Cloud> makeOfTriangles(const ArrayLike& vertices, const ArrayLike& triangles, double uncertainty,
                                       const PoseUncertaintyLike& pose_uncertainty, bool copy, double voxel_edge,
                                       unsigned threads)
{
  const std::vector<std::uint32_t> corners = recordsOf("triangles", triangles, 3);
  std::vector<Triangle> list;
  for (std::size_t i = 0; i < corners.size(); i += 3) list.push_back({corners[i], corners[i + 1], corners[i + 2]});
  const PointsView view = viewOfTriangles(
      {vertices, py::none(), py::none(), uncertainty, py::none(), copy, poseUncertaintyOf(pose_uncertainty)},
      std::move(list));
  HierarchyOptions options;
  options.voxel_edge = voxel_edge;
  options.threads = threads;
  return unlocked([&] { return std::make_shared<Cloud>(view, options); });
}

} // namespace

void bindHierarchy(py::module_& module)
{
  py::class_<Cloud, std::shared_ptr<Cloud>>(module, "SphereHierarchy", kHierarchy,
                                            py::custom_type_setup(&setUpCollection))
      .def(py::init(&make), "xyz"_a, py::kw_only(), "radii"_a = py::none(), "indices"_a = py::none(),
           "uncertainty"_a = 0.0, "uncertainties"_a = py::none(), "pose_uncertainty"_a = py::none(), "copy"_a = false,
           "voxel_edge"_a = 0.0, "threads"_a = 1)
      .def_static("of_triangles", &makeOfTriangles, kOfTriangles, "vertices"_a, "triangles"_a, py::kw_only(),
                  "uncertainty"_a = 0.0, "pose_uncertainty"_a = py::none(), "copy"_a = false, "voxel_edge"_a = 0.0,
                  "threads"_a = 1)
      .def("__len__", &sizeOf)
      .def("__repr__", [](const Cloud& hierarchy) { return textOf(hierarchy); })
      .def_property_readonly(
          "array",
          [](const Cloud& hierarchy) -> std::optional<py::array> {
            const PointsView view = viewNow(hierarchy);
            const KeptArrays* kept = arraysOf(view);
            if (!kept) return std::nullopt;
            return kept->points;
          },
          "The array that it reads: of triangles, their vertices.")
      .def_property_readonly(
          "in_place",
          [](const Cloud& hierarchy) {
            const PointsView view = viewNow(hierarchy);
            const KeptArrays* kept = arraysOf(view);
            return kept && kept->in_place;
          },
          "Whether it reads the caller's own memory.")
      .def_property_readonly(
          "records", [](const Cloud& hierarchy) { return viewNow(hierarchy).count; },
          "Rows of the array, or triangles: the length of arrays with a value for each.")
      .def_property_readonly(
          "coordinate_spacing",
          [](const Cloud& hierarchy) { return unlocked([&] { return hierarchy.coordinateSpacing(); }); },
          "The distance of neighbouring float32 numbers at the largest coordinate; 0 of float64.")
      .def(
          "build_all", [](const Cloud& hierarchy, unsigned threads) { unlocked([&] { hierarchy.buildAll(threads); }); },
          "threads"_a = 1, "Builds every sphere now. threads=0: all of the machine's.")
      .def("refit", &refit, kRefit, "xyz"_a, py::kw_only(), "radii"_a = py::none(), "uncertainties"_a = py::none(),
           "copy"_a = false, "most_growth"_a = 1.5)
      .def(
          "validate", [](const Cloud& hierarchy) { return unlocked([&] { return hierarchy.validate(); }).lines; },
          "Checks in exact arithmetic that every sphere holds its points; a list of defects, empty if it has none.")
      .def("statistics", &statisticsOf,
           "Sizes of the hierarchy, as a dict. Lengths in the cloud's unit; of the voxels built so far.");
}

} // namespace pcl_bsh::python
