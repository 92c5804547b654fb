// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/manifold/contact_manifold.h>
#include <pcl_bsh/manifold/parting.h>
#include <pcl_bsh/python/arrays/array_layout.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/of_clouds.h>

#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::python {
namespace {

constexpr auto kCollider = R"(A cloud that touches, made ready for one manifold after another.

Corners and edges of triangles are sorted, and the spacing of points is measured, once. After a `refit` of the cloud this
is done again.

Parameters
----------
cloud : SphereHierarchy
    Points, balls or triangles.
solid : bool, default False
    The triangles close, and what they enclose counts: gaps inside of them are negative.
normals : array_like of float, (n, 3), optional
    A normal for each point, outward, of any length but 0. None: planes are fitted to points nearby.

Raises
------
ValueError
    A solid of what has no faces; faces that do not close, with their open edges; normals of another number, or that have
    no direction.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> stone = pcl_bsh.Collider(pcl_bsh.SphereHierarchy(np.zeros((1, 3)), radii=np.ones(1, np.float32)))
>>> stone
Collider(1 point)
)";

constexpr auto kManifold = R"(The few contacts that hold a body: the deepest first, then those that span most area.

Parameters
----------
a, b : Collider or SphereHierarchy
    A hierarchy counts as `Collider(hierarchy)`, which is made for this call.
margin : float, default 0
    Contacts have a gap of at most this.
thickness : float, optional
    Taken from each distance; >= 0. None: half the larger spacing where both are points without radii, else 0.
most, most_patches : int, default 4
    Contacts of a patch; patches.
height : float, optional
    A patch has this over the plane of its first contact, both ways. None: twice the margin, the thickness and the size
    of the first gap together.
fit : float, optional
    Radius of planes that are fitted to points; > 0. None: four of the larger spacing.
same_within : float, optional
    A contact keeps its id where its place moved no farther, in one body's frame at least. None: twice the margin and
    the thickness.
previous : Manifold, optional
    The answer of the step before, of the same two: contacts that live on keep their ids. None: all are new.
pose_a, pose_b : array_like, (4, 4) or (3, 4), optional
    Rigid transforms from the cloud to the world.
progress : callable, optional
    Called now and then with the fraction done; by returning False it stops the query, which raises `Cancelled`.

Returns
-------
Manifold
    Arrays `a`, `b` (rows; of meshes triangles), `distance` (the gap; negative where a solid holds a place), `normal`
    (k, 3) (of the surface, from b to a, in the world), `place_a`, `place_b` (k, 3) (in the world; of balls on their
    surfaces), `residual` (of the fitted plane), `id`, `patch`; and `thickness`, that was in use. Contacts stand by patch.

Raises
------
ValueError
    A length that is negative or not finite; as `Collider`.

See Also
--------
nearest_contacts : all pairs of points that collide.
parting : how far to push a out of b.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> floor = pcl_bsh.SphereHierarchy.of_triangles(np.array([[-9.0, -9, 0], [9, -9, 0], [0, 9, 0]]), [[0, 1, 2]])
>>> feet = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [2, 0, 0], [0, 1, 0], [0.5, 0.25, 0]]))
>>> feet, floor = pcl_bsh.Collider(feet), pcl_bsh.Collider(floor)
>>> pose = np.eye(4); pose[2, 3] = 0.125
>>> now = pcl_bsh.contact_manifold(feet, floor, 0.25, pose_a=pose)
>>> now.a, now.distance, now.normal[0]
(array([0, 1, 2], dtype=int32), array([0.125, 0.125, 0.125]), array([0., 0., 1.]))
>>> pose[0, 3] = 0.1
>>> pcl_bsh.contact_manifold(feet, floor, 0.25, pose_a=pose, previous=now).id
array([1, 2, 3], dtype=int32)
)";

constexpr auto kParting = R"(How far to push one body out of another along a contact's normal.

Parameters
----------
a, b : Collider
    One of them at least is a solid.
manifold : Manifold
    The answer about these two, which stand where its query had them.
contact : int, default 0
    Which of its contacts.
tolerance : float
    The upper end is no farther than this above a way at which they meet; > 0.
most : float
    Longer ways are not looked for: then the upper end is inf; > 0.

Returns
-------
(float, float)
    At each way shorter than the first they meet, at the second they are apart.

Raises
------
ValueError
    Neither is a solid; a length that is not finite and above 0.
IndexError
    There is no such contact.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> corners = np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]])
>>> tank = pcl_bsh.SphereHierarchy.of_triangles(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
>>> tank, dot = pcl_bsh.Collider(tank, solid=True), pcl_bsh.Collider(pcl_bsh.SphereHierarchy(np.array([[1, 1, 0.25]])))
>>> found = pcl_bsh.contact_manifold(dot, tank)
>>> lower, upper = pcl_bsh.parting(dot, tank, found, tolerance=0.001, most=10)
>>> found.distance, 0.249 < lower <= 0.25 < upper < 0.252
(array([-0.25]), True)
)";

/// A collider, and the solid that it borrows.
struct MadeCollider {
  MadeCollider(const Cloud& cloud, bool is_solid, const std::vector<float>& normals)
  {
    if (is_solid) solid.emplace(*cloud.view().triangles);
    collider.emplace(cloud, solid ? &*solid : nullptr, NormalField{normals.empty() ? nullptr : normals.data()});
  }
  MadeCollider(const MadeCollider&) = delete;
  MadeCollider& operator=(const MadeCollider&) = delete;

  std::optional<Solid> solid;
  std::optional<Collider> collider;
};

/// Python's Collider.
struct PyCollider {
  PyCollider(const std::shared_ptr<Cloud>& of, bool solid, std::vector<float> normals)
  : cloud(of),
    is_solid(solid),
    made({of},
         [of, solid, field = std::move(normals)] { return std::make_shared<const MadeCollider>(*of, solid, field); })
  {
  }

  const std::shared_ptr<Cloud> cloud;
  const bool is_solid;
  const OfClouds<MadeCollider> made;
};

using ColliderLike = As<"Union[Collider, SphereHierarchy]">;

std::vector<float> normalsOf(const OptionalArray& normals, const PointsView& view)
{
  if (normals.is_none()) return {};
  const auto refuse = [](const std::string& wrong, const char* remedy) {
    throw InvalidInput(Input::points, "normals", wrong, remedy);
  };
  if (view.triangles) refuse("are those of points", "leave them out for triangles");
  const std::vector<double> rows = rowsOf("normals", normals, 3);
  if (rows.size() != 3 * view.count) refuse("are " + std::to_string(rows.size() / 3), "give one for each record");
  std::vector<float> field(rows.size());
  for (std::size_t i = 0; i < view.count; ++i) {
    const Eigen::Vector3d row(rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]);
    const double length = row.stableNorm();
    if (!(std::isfinite(length) && length > 0.0)) refuse("row " + std::to_string(i) + " has no direction", "give one");
    for (std::size_t k = 0; k < 3; ++k) field[3 * i + k] = static_cast<float>(rows[3 * i + k] / length);
  }
  return field;
}

std::shared_ptr<PyCollider> makeCollider(const std::shared_ptr<Cloud>& cloud, bool solid, const OptionalArray& normals)
{
  const PointsView view = viewNow(*cloud);
  if (solid && !view.triangles)
    throw InvalidInput(Input::surface, "solid", "the cloud has no faces", "make it by SphereHierarchy.of_triangles");
  auto collider = std::make_shared<PyCollider>(cloud, solid, normalsOf(normals, view));
  unlocked([&] { collider->made.now(); });
  return collider;
}

std::shared_ptr<PyCollider> colliderOf(const char* name, const ColliderLike& thing)
{
  if (py::isinstance<PyCollider>(thing)) return thing.cast<std::shared_ptr<PyCollider>>();
  if (py::isinstance<Cloud>(thing))
    return std::make_shared<PyCollider>(thing.cast<std::shared_ptr<Cloud>>(), false, std::vector<float>());
  throw py::type_error(std::string(name) + ": give a Collider or a SphereHierarchy");
}

Manifold manifoldOf(const ColliderLike& thing_a, const ColliderLike& thing_b, double margin,
                    std::optional<double> thickness, std::size_t most, std::size_t most_patches,
                    std::optional<double> height, std::optional<double> fit, std::optional<double> same_within,
                    const Manifold* previous, const PoseLike& pose_a, const PoseLike& pose_b,
                    const ProgressLike& progress)
{
  const std::shared_ptr<PyCollider> a = colliderOf("a", thing_a), b = colliderOf("b", thing_b);
  PythonQuestion asked(*a->cloud, pose_a, *b->cloud, pose_b);
  asked.question.clearance = margin;
  asked.question.input_solid = a->is_solid;
  asked.question.solid = b->is_solid;
  ManifoldRequest request;
  request.margin = margin;
  request.thickness = thickness;
  request.most = most;
  request.most_patches = most_patches;
  request.height = height;
  request.fit = fit;
  request.same_within = same_within;
  request.previous = previous;
  request.progress = progressOf(progress);
  const auto find = [&] {
    const auto made_a = a->made.now(), made_b = b->made.now();
    return contactManifold({*made_a->collider, asked.a.pose}, {*made_b->collider, asked.b.pose}, request);
  };
  return asked.answer(find, [](const Manifold& found) {
    std::vector<double> gaps;
    for (const Contact& contact : found.contacts) gaps.push_back(contact.distance);
    return nearestOf(gaps);
  });
}

std::pair<double, double> partingAlong(const PyCollider& a, const PyCollider& b, const Manifold& manifold,
                                       std::size_t contact, double tolerance, double most)
{
  if (contact >= manifold.contacts.size())
    throw py::index_error("contact: " + std::to_string(contact) + " is not among the manifold's " +
                          counted(manifold.contacts.size(), "contact"));
  return tupleOf(unlocked([&] {
    const auto made_a = a.made.now(), made_b = b.made.now();
    return partingOf({*made_a->collider, manifold.pose_a}, {*made_b->collider, manifold.pose_b},
                     manifold.contacts[contact], tolerance, most);
  }));
}

/// A read-only property: the array of a member of all contacts. @param columns numbers of each contact; 0:
/// one, in an array (k,)
template <py::ssize_t columns = 0, class Data>
auto ofContacts(const Data& data)
{
  return [data](const py::object& self) {
    const std::vector<Contact>& contacts = self.cast<const Manifold&>().contacts;
    static const Contact none;
    const auto* const first = data(contacts.empty() ? none : contacts.front());
    std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(contacts.size())}, strides = {sizeof(Contact)};
    if (columns > 0) {
      shape.push_back(columns);
      strides.push_back(sizeof(*first));
    }
    return arrayIn(self, first, std::move(shape), std::move(strides));
  };
}

} // namespace

void bindManifold(py::module_& module)
{
  py::class_<PyCollider, std::shared_ptr<PyCollider>>(module, "Collider", kCollider)
      .def(py::init(&makeCollider), "cloud"_a, py::kw_only(), "solid"_a = false, "normals"_a = py::none())
      .def_property_readonly("cloud", [](const PyCollider& collider) { return collider.cloud; })
      .def_property_readonly("solid", [](const PyCollider& collider) { return collider.is_solid; })
      .def_property_readonly(
          "spacing",
          [](const PyCollider& collider) { return unlocked([&] { return collider.made.now()->collider->spacing(); }); },
          "The median distance of neighbours; 0 of balls and triangles.")
      .def("__repr__", [](const PyCollider& collider) {
        const PointsView view = viewNow(*collider.cloud);
        return "Collider(" + counted(view.count, view.triangles ? "triangle" : "point") +
               (collider.is_solid ? ", solid)" : ")");
      });
  py::class_<Manifold>(module, "Manifold", "The answer of `contact_manifold`.")
      .def_property_readonly("a", ofContacts([](const Contact& contact) { return &contact.pair.a; }))
      .def_property_readonly("b", ofContacts([](const Contact& contact) { return &contact.pair.b; }))
      .def_property_readonly("distance", ofContacts([](const Contact& contact) { return &contact.distance; }))
      .def_property_readonly("normal", ofContacts<3>([](const Contact& contact) { return contact.normal.data(); }))
      .def_property_readonly("place_a", ofContacts<3>([](const Contact& contact) { return contact.place_a.data(); }))
      .def_property_readonly("place_b", ofContacts<3>([](const Contact& contact) { return contact.place_b.data(); }))
      .def_property_readonly("residual", ofContacts([](const Contact& contact) { return &contact.residual; }))
      .def_property_readonly("id", ofContacts([](const Contact& contact) { return &contact.id; }))
      .def_property_readonly("patch", ofContacts([](const Contact& contact) { return &contact.patch; }))
      .def_readonly("thickness", &Manifold::thickness, "The one in use.")
      .def_readonly("work", &Manifold::work)
      .def("__len__", [](const Manifold& found) { return found.contacts.size(); })
      .def("__repr__",
           [](const Manifold& found) { return "Manifold(" + counted(found.contacts.size(), "contact") + ")"; });
  module.def("contact_manifold", &manifoldOf, kManifold, "a"_a, "b"_a, "margin"_a = 0.0, py::kw_only(),
             "thickness"_a = py::none(), "most"_a = 4, "most_patches"_a = 4, "height"_a = py::none(),
             "fit"_a = py::none(), "same_within"_a = py::none(), "previous"_a = py::none(), "pose_a"_a = py::none(),
             "pose_b"_a = py::none(), "progress"_a = py::none());
  module.def("parting", &partingAlong, kParting, "a"_a, "b"_a, "manifold"_a, "contact"_a = 0, py::kw_only(),
             "tolerance"_a, "most"_a);
}

} // namespace pcl_bsh::python
