// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/callback.h>

#include <algorithm>
#include <string>

namespace pcl_bsh::python {
namespace {

constexpr auto kRadius = R"(radius_search(cloud, queries, radius, *, most=0, sorted=True, threads=1)
--

All points with |p - query| <= radius.

Parameters
----------
cloud : SphereHierarchy
    Radii of its points play no part.
queries : array_like, (m, 3), or one point (3,)
    float32 or float64. A query that is not finite has no neighbour.
radius : float
    >= 0; inclusive; may be infinite.
most : int, default 0
    Only so many, the nearest ones; 0: all.
sorted : bool, default True
    By distance, equal distances by row; else in any order, but always the same one.
threads : int, default 1
    0: all of the machine's.

Returns
-------
Neighbors
    Flat arrays with offsets; ``found[i]`` is (indices, squared_distances) of query i. Of one point these two arrays.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> cloud = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]]))
>>> found = pcl_bsh.radius_search(cloud, np.array([[0.0, 0, 0], [9, 9, 9]]), 1.0)
>>> found.offsets, found.indices
(array([0, 2, 2]), array([0, 1], dtype=int32))
>>> pcl_bsh.radius_search(cloud, [3.0, 0, 0], 2.0)
(array([2, 1], dtype=int32), array([0., 4.], dtype=float32))
)";

constexpr auto kNearest = R"(nearest_k_search(cloud, queries, k, *, threads=1)
--

The k nearest points, or all when there are fewer.

Parameters are those of `radius_search`, and k, the number of neighbours.

Returns
-------
Neighbors
    As `radius_search`.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> cloud = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]]))
>>> pcl_bsh.nearest_k_search(cloud, [2.0, 0, 0], 2)
(array([1, 2], dtype=int32), array([1., 1.], dtype=float32))
)";

constexpr auto kAny = R"(any_in_radius(cloud, queries, radius, *, threads=1)
--

Does any point lie within the radius of each query? A bool for one point, else an ndarray of uint8, (m,).

Parameters are those of `radius_search`.
)";

constexpr auto kBox = R"(box_search(cloud, low, high)
--

The rows with low <= p <= high on each axis, ascending: an ndarray of int32. Bounds may be infinite, not NaN.
)";

/// NeighborLists, flat.
struct FlatNeighbors {
  std::vector<std::int64_t> offsets = {0};
  std::vector<std::int32_t> indices;
  std::vector<float> squared_distances;
};

FlatNeighbors flatten(const NeighborLists& lists)
{
  FlatNeighbors flat;
  flat.offsets.reserve(lists.indices.size() + 1);
  for (const auto& list : lists.indices)
    flat.offsets.push_back(flat.offsets.back() + static_cast<std::int64_t>(list.size()));
  flat.indices.reserve(static_cast<std::size_t>(flat.offsets.back()));
  flat.squared_distances.reserve(static_cast<std::size_t>(flat.offsets.back()));
  for (const auto& list : lists.indices) flat.indices.insert(flat.indices.end(), list.begin(), list.end());
  for (const auto& list : lists.squared_distances)
    flat.squared_distances.insert(flat.squared_distances.end(), list.begin(), list.end());
  return flat;
}

/// Whether it is one point, (3,), rather than a list of them.
bool isOnePoint(const py::object& queries)
{
  return !(py::isinstance<py::array>(queries) && py::reinterpret_borrow<py::array>(queries).dtype().has_fields()) &&
         py::array::ensure(queries) && py::array::ensure(queries).ndim() == 1;
}

py::tuple arraysOf(Neighbors&& found)
{
  return py::make_tuple(arrayFrom(std::move(found.indices)), arrayFrom(std::move(found.squared_distances)));
}

py::object radiusSearchOf(const SphereHierarchy& cloud, const py::object& queries, double radius, std::size_t most,
                          bool sorted, unsigned threads)
{
  const RadiusOptions options{most, sorted};
  if (isOnePoint(queries)) {
    const Point3 query = point3Of("queries", queries);
    Neighbors found;
    unlocked([&] { return radiusSearch(cloud, query, radius, found, options); });
    return arraysOf(std::move(found));
  }
  py::array kept;
  const PointsView view = viewForCall("queries", queries, kept);
  return py::cast(unlocked([&] {
    NeighborLists found;
    radiusSearch(cloud, view, radius, found, options, threads);
    return flatten(found);
  }));
}

py::object nearestSearchOf(const SphereHierarchy& cloud, const py::object& queries, std::size_t k, unsigned threads)
{
  if (isOnePoint(queries)) {
    const Point3 query = point3Of("queries", queries);
    Neighbors found;
    unlocked([&] { return nearestKSearch(cloud, query, k, found); });
    return arraysOf(std::move(found));
  }
  py::array kept;
  const PointsView view = viewForCall("queries", queries, kept);
  return py::cast(unlocked([&] {
    NeighborLists found;
    nearestKSearch(cloud, view, k, found, threads);
    return flatten(found);
  }));
}

py::object anyInRadiusOf(const SphereHierarchy& cloud, const py::object& queries, double radius, unsigned threads)
{
  if (isOnePoint(queries)) {
    const Point3 query = point3Of("queries", queries);
    return py::bool_(unlocked([&] { return anyInRadius(cloud, query, radius); }));
  }
  py::array kept;
  const PointsView view = viewForCall("queries", queries, kept);
  return arrayFrom(unlocked([&] { return flagAnyInRadius(cloud, view, radius, threads); }));
}

py::tuple neighborsOf(const py::object& self, py::ssize_t i)
{
  const auto& found = self.cast<const FlatNeighbors&>();
  const auto queries = static_cast<py::ssize_t>(found.offsets.size()) - 1;
  if (i < 0) i += queries;
  if (i < 0 || i >= queries) throw py::index_error("there are " + std::to_string(queries) + " queries");
  const auto begin = found.offsets[static_cast<std::size_t>(i)], end = found.offsets[static_cast<std::size_t>(i) + 1];
  const std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(end - begin)};
  return py::make_tuple(arrayIn(self, found.indices.data() + begin, shape),
                        arrayIn(self, found.squared_distances.data() + begin, shape));
}

} // namespace

void bindNeighbors(py::module_& module)
{
  py::class_<FlatNeighbors>(module, "Neighbors", "The neighbours of many queries, in flat arrays.")
      .def_property_readonly(
          "offsets", [](const py::object& self) { return arrayIn(self, self.cast<const FlatNeighbors&>().offsets); },
          "(m + 1,) int64: those of query i are at [offsets[i], offsets[i + 1]).")
      .def_property_readonly(
          "indices", [](const py::object& self) { return arrayIn(self, self.cast<const FlatNeighbors&>().indices); },
          "int32: rows of the cloud.")
      .def_property_readonly(
          "squared_distances",
          [](const py::object& self) { return arrayIn(self, self.cast<const FlatNeighbors&>().squared_distances); },
          "float32, rounded once.")
      .def("__len__", [](const FlatNeighbors& found) { return found.offsets.size() - 1; })
      .def("__getitem__", &neighborsOf)
      .def("__repr__", [](const FlatNeighbors& found) {
        return "Neighbors(" + std::to_string(found.indices.size()) + " of " + std::to_string(found.offsets.size() - 1) +
               " queries)";
      });
  module.def("radius_search", &radiusSearchOf, kRadius, py::arg("cloud"), py::arg("queries"), py::arg("radius"),
             py::kw_only(), py::arg("most") = 0, py::arg("sorted") = true, py::arg("threads") = 1);
  module.def("nearest_k_search", &nearestSearchOf, kNearest, py::arg("cloud"), py::arg("queries"), py::arg("k"),
             py::kw_only(), py::arg("threads") = 1);
  module.def("any_in_radius", &anyInRadiusOf, kAny, py::arg("cloud"), py::arg("queries"), py::arg("radius"),
             py::kw_only(), py::arg("threads") = 1);
  module.def(
      "box_search",
      [](const SphereHierarchy& cloud, const py::object& low, const py::object& high) {
        const Point3 least = point3Of("low", low), most = point3Of("high", high);
        std::vector<std::int32_t> indices;
        unlocked([&] { return boxSearch(cloud, least, most, indices); });
        return arrayFrom(std::move(indices));
      },
      kBox, py::arg("cloud"), py::arg("low"), py::arg("high"));
}

} // namespace pcl_bsh::python
