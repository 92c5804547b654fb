// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/callback.h>

#include <pybind11/stl.h>

#include <cstddef>
#include <optional>
#include <string>

namespace pcl_bsh::python {
namespace {

constexpr auto kContacts = R"(contacts(a, b, clearance=0.0, *, most=None, pose_a=None, pose_b=None)
--

The pairs of points that collide, nearest first, with their distances and normals.

Parameters
----------
a, b : SphereHierarchy
clearance : float, default 0
    In the clouds' unit; inclusive.
most : int, optional
    Only so many, the nearest ones. There may be as many as points of a times points of b.
pose_a, pose_b : array_like, (4, 4) or (3, 4), optional
    Rigid transforms from the cloud to the world.

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
>>> found = pcl_bsh.contacts(a, b, 2.0)
>>> found.a, found.b, found.distance
(array([0, 1], dtype=uint32), array([0, 0], dtype=uint32), array([1., 2.]))
>>> found.normal[1]
array([0., 0., 1.])
)";

constexpr auto kPairsWithin = R"(pairs_within(a, b, clearance=0.0, *, most=None, pose_a=None, pose_b=None)
--

The pairs of points that collide, in no particular order.

Parameters are those of `contacts`.

Returns
-------
ndarray of uint32, (k, 2)
    Rows of a and b.

Raises
------
ValueError
    As `contacts`; where there are more than `most`, too.
)";

/// Contacts as columns.
struct Contacts {
  std::vector<std::uint32_t> a, b;
  std::vector<double> distance, normal;
  bool complete = true;
  Work work;
};

ContactsRequest requestOf(double clearance, const std::optional<std::size_t>& most)
{
  ContactsRequest request;
  request.clearance = clearance;
  if (most) request.most = *most;
  return request;
}

Contacts contactsOf(const SphereHierarchy& a, const SphereHierarchy& b, double clearance,
                    std::optional<std::size_t> most, const py::object& pose_a, const py::object& pose_b)
{
  const Placed placed_a(a, poseOf("pose_a", pose_a)), placed_b(b, poseOf("pose_b", pose_b));
  const ContactsRequest request = requestOf(clearance, most);
  return unlocked([&] {
    const ContactsResult found = nearestContacts(placed_a, placed_b, request);
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
  });
}

py::object pairsWithinOf(const SphereHierarchy& a, const SphereHierarchy& b, double clearance,
                         std::optional<std::size_t> most, const py::object& pose_a, const py::object& pose_b)
{
  const Placed placed_a(a, poseOf("pose_a", pose_a)), placed_b(b, poseOf("pose_b", pose_b));
  const ContactsRequest request = requestOf(clearance, most);
  const PairsWithin found = unlocked([&] { return pairsWithin(placed_a, placed_b, request); });
  if (!found.complete)
    throw py::value_error("pairs_within: there are more than " + counted(request.most, "pair") +
                          ": ask contacts() for the nearest, or for more");
  py::array_t<std::uint32_t> pairs({static_cast<py::ssize_t>(found.pairs.size()), py::ssize_t{2}});
  std::uint32_t* record = pairs.mutable_data();
  for (const PointPair& pair : found.pairs) {
    *record++ = pair.a;
    *record++ = pair.b;
  }
  return pairs;
}

} // namespace

void bindContacts(py::module_& module)
{
  py::class_<Contacts>(module, "Contacts", "The answer of `contacts`.")
      .def_property_readonly("a", [](const py::object& self) { return arrayIn(self, self.cast<const Contacts&>().a); })
      .def_property_readonly("b", [](const py::object& self) { return arrayIn(self, self.cast<const Contacts&>().b); })
      .def_property_readonly(
          "distance", [](const py::object& self) { return arrayIn(self, self.cast<const Contacts&>().distance); })
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
  module.def("contacts", &contactsOf, kContacts, py::arg("a"), py::arg("b"), py::arg("clearance") = 0.0, py::kw_only(),
             py::arg("most") = py::none(), py::arg("pose_a") = py::none(), py::arg("pose_b") = py::none());
  module.def("pairs_within", &pairsWithinOf, kPairsWithin, py::arg("a"), py::arg("b"), py::arg("clearance") = 0.0,
             py::kw_only(), py::arg("most") = py::none(), py::arg("pose_a") = py::none(),
             py::arg("pose_b") = py::none());
}

} // namespace pcl_bsh::python
