// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/neighbors/patch_spacings.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>

#include <pybind11/stl.h>

#include <optional>
#include <string>

namespace pcl_bsh::python {
namespace {

constexpr auto kClusters =
    R"(Which points belong together: those that a chain of points joins in steps of `distance` at most.

Parameters
----------
cloud : SphereHierarchy
distance : float
    Finite, >= 0; inclusive.

Returns
-------
Clusters
    `of` (records,) int32: the number of each point's cluster, -1 where it is not a finite point; `sizes` (clusters,).
    Clusters are numbered by their smallest rows.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> cloud = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [5, 0, 0], [1, 0, 0]]))
>>> found = pcl_bsh.euclidean_clusters(cloud, 1.0)
>>> found.of, found.sizes
(array([0, 1, 0], dtype=int32), array([2, 1], dtype=uint64))
)";

constexpr auto kSpacing =
    R"(How far points are from the nearest other place that has one, of a sample of at most 1,024 points.

Returns
-------
dict
    samples, median, and wide: nine of ten are no farther from a neighbour.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> pcl_bsh.spacing_of(pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [2, 0, 0]])))
{'samples': 2, 'median': 2.0, 'wide': 2.0}
)";

constexpr auto kPatches =
    R"(How wide the hole beside each sample of a surface is: what `collision_flags` takes as `spacings_of_b`.

Parameters
----------
cloud : SphereHierarchy
widest_gap : float, optional
    A wider gap is an opening, not a surface. Default: eight times the median spacing, which is too little for a
    spinning lidar.
threads : int, default 1

Returns
-------
ndarray of float32, (records,)
)";

} // namespace

void bindClusters(py::module_& module)
{
  py::class_<Clusters>(module, "Clusters", "The answer of `euclidean_clusters`.")
      .def_property_readonly("of", column(&Clusters::of))
      .def_property_readonly("sizes", column(&Clusters::sizes))
      .def_readonly("work", &Clusters::work)
      .def("__len__", [](const Clusters& found) { return found.sizes.size(); })
      .def("__repr__", [](const Clusters& found) { return "Clusters(" + std::to_string(found.sizes.size()) + ")"; });
  module.def(
      "euclidean_clusters",
      [](const Cloud& cloud, double distance) { return unlocked([&] { return euclideanClusters(cloud, distance); }); },
      kClusters, "cloud"_a, "distance"_a);
  module.def(
      "spacing_of",
      [](const Cloud& cloud) {
        const Spacing spacing = unlocked([&] { return spacingOf(cloud); });
        return py::dict("samples"_a = spacing.samples, "median"_a = spacing.median, "wide"_a = spacing.wide);
      },
      kSpacing, "cloud"_a);
  module.def(
      "patch_spacings",
      [](const Cloud& cloud, std::optional<double> widest_gap, unsigned threads) {
        return arrayFrom(
            unlocked([&] { return patchSpacings(cloud, widest_gap ? *widest_gap : usualGap(cloud), threads); }));
      },
      kPatches, "cloud"_a, "widest_gap"_a = py::none(), py::kw_only(), "threads"_a = 1);
}

} // namespace pcl_bsh::python
