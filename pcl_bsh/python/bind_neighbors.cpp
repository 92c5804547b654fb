// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>

#include <string>
#include <type_traits>
#include <utility>

namespace pcl_bsh::python {
namespace {

constexpr auto kRadius = R"(All points with |p - query| <= radius.

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

Returns
-------
Neighbors
    Flat arrays with offsets; ``found[i]`` is (indices, squared_distances) of query i. A query of one point returns these two arrays.

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

constexpr auto kNearest = R"(The k nearest points, or all when there are fewer.

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

constexpr auto kAny =
    R"(Does any point lie within the radius of each query? A bool for one point, else an ndarray of uint8, (m,).

Parameters are those of `radius_search`.
)";

constexpr auto kBox =
    R"(The rows with low <= p <= high on each axis, ascending: an ndarray of int32. Bounds may be infinite, not NaN.
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
bool isOnePoint(py::handle queries)
{
  const py::array array = py::array::ensure(queries);
  return array && array.ndim() == 1 && !array.dtype().has_fields();
}

using Point = As<"Sequence[float]", isOnePoint>;
using Points = As<"npt.NDArray[Any]">; // its type does not tell one point from many: `accepts` does

using Found = std::pair<py::array_t<std::int32_t>, py::array_t<float>>;

/// Results of search(query, found) about one point.
template <class Search>
Found foundOf(const Point& queries, Search&& search)
{
  const Point3 query = point3Of("queries", queries);
  Neighbors found;
  unlocked([&] { return search(query, found); });
  return {arrayFrom(std::move(found.indices)), arrayFrom(std::move(found.squared_distances))};
}

/// Results of search(queries, found) about many points.
template <class Search>
As<"Any"> foundOf(const Points& queries, Search&& search)
{
  py::array kept;
  const PointsView view = viewForCall("queries", queries, kept);
  return py::cast(unlocked([&] {
    NeighborLists found;
    search(view, found);
    return flatten(found);
  }));
}

template <class Queries>
auto radiusSearchOf(const Cloud& cloud, const Queries& queries, double radius, std::size_t most, bool sorted,
                    unsigned threads)
{
  return foundOf(queries, [&](const auto& at, auto& found) {
    if constexpr (std::is_same_v<Queries, Point>)
      radiusSearch(cloud, at, radius, found, {most, sorted});
    else
      radiusSearch(cloud, at, radius, found, {most, sorted}, threads);
  });
}

template <class Queries>
auto nearestSearchOf(const Cloud& cloud, const Queries& queries, std::size_t k, unsigned threads)
{
  return foundOf(queries, [&](const auto& at, auto& found) {
    if constexpr (std::is_same_v<Queries, Point>)
      nearestKSearch(cloud, at, k, found);
    else
      nearestKSearch(cloud, at, k, found, threads);
  });
}

bool anyAboutPoint(const Cloud& cloud, const Point& queries, double radius, unsigned /*threads*/)
{
  const Point3 query = point3Of("queries", queries);
  return unlocked([&] { return anyInRadius(cloud, query, radius); });
}

As<"Any"> anyAboutEach(const Cloud& cloud, const Points& queries, double radius, unsigned threads)
{
  py::array kept;
  const PointsView view = viewForCall("queries", queries, kept);
  return arrayFrom(unlocked([&] { return flagAnyInRadius(cloud, view, radius, threads); }));
}

Found neighborsOf(const py::object& self, py::ssize_t i)
{
  const auto& found = self.cast<const FlatNeighbors&>();
  const auto queries = static_cast<py::ssize_t>(found.offsets.size()) - 1;
  if (i < 0) i += queries;
  if (i < 0 || i >= queries) throw py::index_error("there are " + std::to_string(queries) + " queries");
  const auto begin = found.offsets[static_cast<std::size_t>(i)], end = found.offsets[static_cast<std::size_t>(i) + 1];
  const std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(end - begin)};
  return {arrayIn(self, found.indices.data() + begin, shape),
          arrayIn(self, found.squared_distances.data() + begin, shape)};
}

} // namespace

void bindNeighbors(py::module_& module)
{
  py::class_<FlatNeighbors>(module, "Neighbors", "The neighbours of many queries, in flat arrays.")
      .def_property_readonly("offsets", column(&FlatNeighbors::offsets),
                             "(m + 1,) int64: those of query i are at [offsets[i], offsets[i + 1]).")
      .def_property_readonly("indices", column(&FlatNeighbors::indices), "int32: rows of the cloud.")
      .def_property_readonly("squared_distances", column(&FlatNeighbors::squared_distances), "float32, rounded once.")
      .def("__len__", [](const FlatNeighbors& found) { return found.offsets.size() - 1; })
      .def("__getitem__", &neighborsOf)
      .def("__repr__", [](const FlatNeighbors& found) {
        return "Neighbors(" + std::to_string(found.indices.size()) + " of " + std::to_string(found.offsets.size() - 1) +
               " queries)";
      });
  const auto define = [&](const char* name, auto of_one, auto of_many, const char* text, auto... arguments) {
    module.def(name, of_one, text, "cloud"_a, "queries"_a, arguments..., "threads"_a = 1);
    module.def(name, of_many, "", "cloud"_a, "queries"_a, arguments..., "threads"_a = 1);
  };
  const auto radius = "radius"_a;
  const py::kw_only rest;
  define("radius_search", &radiusSearchOf<Point>, &radiusSearchOf<Points>, kRadius, radius, rest, "most"_a = 0,
         "sorted"_a = true);
  define("nearest_k_search", &nearestSearchOf<Point>, &nearestSearchOf<Points>, kNearest, "k"_a, rest);
  define("any_in_radius", &anyAboutPoint, &anyAboutEach, kAny, radius, rest);
  module.def(
      "box_search",
      [](const Cloud& cloud, const ArrayLike& low, const ArrayLike& high) {
        const Point3 least = point3Of("low", low), most = point3Of("high", high);
        std::vector<std::int32_t> indices;
        unlocked([&] { return boxSearch(cloud, least, most, indices); });
        return arrayFrom(std::move(indices));
      },
      kBox, "cloud"_a, "low"_a, "high"_a);
}

} // namespace pcl_bsh::python
