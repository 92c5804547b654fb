// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>

#include <pybind11/stl.h>

#include <cstddef>
#include <optional>
#include <string>

namespace pcl_bsh::python {
namespace {

constexpr auto kContacts = R"(The pairs of points that collide, nearest first, with their distances and normals.

A mesh is its surface here: what is inside of it, `collision_flags` tells with `solid`.

Parameters
----------
a, b : SphereHierarchy
clearance : float, default 0
most : int, optional
    Only so many, the nearest ones. There may be as many as points of a times points of b.
pose_a, pose_b : array_like, (4, 4) or (3, 4), optional
    Rigid transforms from the cloud to the world.
progress : callable, optional
    Called now and then with the fraction done; by returning False it stops the query, which raises `Cancelled`.

Returns
-------
Contacts
    Arrays `a`, `b` (rows), `distance` (less the points' radii), `normal` (k, 3) (from b's point to a's, in the world; 0
    where they coincide), and `complete`: no colliding pair was left out.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [0, 0, 3]]))
>>> b = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 1]]))
>>> found = pcl_bsh.nearest_contacts(a, b, 2.0)
>>> found.a, found.b, found.distance
(array([0, 1], dtype=int32), array([0, 0], dtype=int32), array([1., 2.]))
>>> found.normal[1]
array([0., 0., 1.])
)";

constexpr auto kPairsWithin = R"(The pairs of points that collide, in no particular order.

Parameters are those of `nearest_contacts`.

Returns
-------
ndarray of int32, (k, 2)
    Rows of a and b.

Raises
------
ValueError
    As `nearest_contacts`; where there are more than `most`, too.
)";

/// Contacts as columns.
struct Contacts {
  std::vector<std::uint32_t> a, b;
  std::vector<double> distance, normal;
  bool complete = true;
  Work work;
};

ContactsRequest requestOf(double clearance, const std::optional<std::size_t>& most, const ProgressLike& progress)
{
  ContactsRequest request;
  request.clearance = clearance;
  request.progress = progressOf(progress);
  if (most) request.most = *most;
  return request;
}

Contacts contactsOf(const Cloud& a, const Cloud& b, double clearance, std::optional<std::size_t> most,
                    const PoseLike& pose_a, const PoseLike& pose_b, const ProgressLike& progress)
{
  PythonQuestion asked(a, pose_a, b, pose_b);
  const ContactsRequest request = requestOf(clearance, most, progress);
  asked.question.clearance = clearance;
  const auto find = [&] {
    const ContactsResult found = nearestContacts(asked.a, asked.b, request);
    Contacts columns;
    columns.complete = found.complete;
    columns.work = found.work;
    for (const Contact& contact : found.contacts) {
      columns.a.push_back(contact.pair.a);
      columns.b.push_back(contact.pair.b);
      columns.distance.push_back(contact.distance);
      columns.normal.insert(columns.normal.end(), contact.normal.begin(), contact.normal.end());
    }
    return columns;
  };
  return asked.answer(find, [](const Contacts& found) { return nearestOf(found.distance); });
}

py::array_t<std::int32_t> pairsWithinOf(const Cloud& a, const Cloud& b, double clearance,
                                        std::optional<std::size_t> most, const PoseLike& pose_a, const PoseLike& pose_b,
                                        const ProgressLike& progress)
{
  PythonQuestion asked(a, pose_a, b, pose_b);
  const ContactsRequest request = requestOf(clearance, most, progress);
  asked.question.clearance = clearance;
  const PairsWithin found = asked.answer(
      [&] { return pairsWithin(asked.a, asked.b, request); },
      [](const PairsWithin& pairs) { return pairs.pairs.empty() ? nearestOf(std::vector<double>()) : 0.0; });
  if (!found.complete)
    throw py::value_error("pairs_within: there are more than " + counted(request.most, "pair") +
                          ": ask nearest_contacts() for the nearest, or for more");
  return arrayFrom(found.pairs);
}

} // namespace

void bindContacts(py::module_& module)
{
  py::class_<Contacts>(module, "Contacts", "The answer of `nearest_contacts`.")
      .def_property_readonly("a", column(&Contacts::a))
      .def_property_readonly("b", column(&Contacts::b))
      .def_property_readonly("distance", column(&Contacts::distance))
      .def_property_readonly("normal",
                             [](const py::object& self) {
                               const auto& found = self.cast<const Contacts&>();
                               return arrayIn(self, found.normal.data(), {static_cast<py::ssize_t>(found.a.size()), 3});
                             })
      .def_readonly("complete", &Contacts::complete, "No colliding pair was left out.")
      .def_readonly("work", &Contacts::work)
      .def("__len__", [](const Contacts& found) { return found.a.size(); })
      .def("__repr__", [](const Contacts& found) {
        return "Contacts(" + std::to_string(found.a.size()) + (found.complete ? ")" : ", the nearest)");
      });
  module.def("nearest_contacts", &contactsOf, kContacts, "a"_a, "b"_a, "clearance"_a = 0.0, py::kw_only(),
             "most"_a = py::none(), "pose_a"_a = py::none(), "pose_b"_a = py::none(), "progress"_a = py::none());
  module.def("pairs_within", &pairsWithinOf, kPairsWithin, "a"_a, "b"_a, "clearance"_a = 0.0, py::kw_only(),
             "most"_a = py::none(), "pose_a"_a = py::none(), "pose_b"_a = py::none(), "progress"_a = py::none());
}

} // namespace pcl_bsh::python
