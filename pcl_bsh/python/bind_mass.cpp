// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/manifold/mass.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>

namespace pcl_bsh::python {
namespace {

constexpr auto kMass = R"(Mass, centre and inertia of what a closed mesh encloses, or of a cloud of balls.

Integrals are exact, and each number is rounded once.

Parameters
----------
cloud : SphereHierarchy
    Triangles that close: a shell within another that is turned inward is a hollow. Or points with radii: all balls are
    summed, and where they overlap each counts.
density : float, default 1
    Mass of a unit of volume; > 0.

Returns
-------
MassProperties
    `mass`, `center` (3,), and `inertia` (3, 3) about the centre, in the cloud's frame.

Raises
------
ValueError
    A mesh that does not close, with the number of its open edges and the first of them; a volume of 0; points without
    radii; a density that is not finite and above 0.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> balls = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [2, 0, 0]]), radii=np.full(2, 0.5, np.float32))
>>> of = pcl_bsh.mass_properties(balls, density=3 / np.pi)
>>> of.mass, of.center, of.inertia.diagonal()
(1.0, array([1., 0., 0.]), array([0.1, 1.1, 1.1]))
)";

MassProperties massPropertiesOf(const Cloud& cloud, double density)
{
  return unlocked([&] {
    const PointsView& view = cloud.view();
    return view.triangles ? massOf(Solid(*view.triangles), density) : massOf(view, density);
  });
}

} // namespace

void bindMass(py::module_& module)
{
  py::class_<MassProperties>(module, "MassProperties", "The answer of `mass_properties`.")
      .def_readonly("mass", &MassProperties::mass)
      .def_property_readonly(
          "center",
          [](const py::object& self) { return arrayIn(self, self.cast<const MassProperties&>().center.data(), {3}); })
      .def_property_readonly(
          "inertia",
          [](const py::object& self) {
            return arrayIn(self, self.cast<const MassProperties&>().inertia.data(), {3, 3}); // symmetric
          },
          "About the centre, along the axes of the cloud's frame.")
      .def("with_mass", &MassProperties::withMass, "A body of the same shape and another mass.", "mass"_a)
      .def("__repr__", [](const MassProperties& of) { return "MassProperties(mass=" + numberText(of.mass) + ")"; });
  module.def("mass_properties", &massPropertiesOf, kMass, "cloud"_a, "density"_a = 1.0);
}

} // namespace pcl_bsh::python
