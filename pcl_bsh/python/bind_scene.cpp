// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/callback.h>
#include <pcl_bsh/scene/scene.h>

#include <pybind11/stl.h>

#include <mutex>
#include <string>
#include <type_traits>

namespace pcl_bsh::python {
namespace {

constexpr auto kScene = R"(Many objects in motion, and only the effects that are asked for.

Parameters
----------
clearance : float, default 0
    In the clouds' unit; inclusive.
any, flags, first_contact, swept, self_collisions : bool
    Which pairs of objects collide; which points do; when, since the last query, a pair first meets; which points meet
    another object anywhere on this way; parts of one object that collide.
distance : float, optional
    The smallest distance of each pair that is no farther apart than this; inf: of every pair.
contacts : int, optional
    At most so many for each pair of parts, the nearest.
response : {"none", "stop", "slide"}
    What a moving object does where it meets another.
gravity : float, optional
    Objects follow the ground, and climb or sink by this step height at most.
down : array_like, (3,), default (0, 0, -1)
    Of gravity.
test_pairs : bool, default True
    False: only pairs for which a rule asks.
accuracy : Accuracy or str, default exact
    Of any, flags, distance and self_collisions.
tolerance : float, default 1e-4
    Of first contacts, swept motion and responses, in the clouds' unit; > 0.
voxel_edge : float, default 0
    Of the grid over the scene; 0: from the sizes of what moves.
threads : int, default 1
deform : float, optional
    Points of objects may move, by `Scene.deform`: the spheres of a voxel, or of all, are built anew once they have grown
    by this factor on average; >= 1.

Notes
-----
Several threads may call one scene: one after the other has its turn.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> scene = pcl_bsh.Scene(clearance=0.1, any=True, response="stop")
>>> wall = scene.add("wall", pcl_bsh.SphereHierarchy(np.array([[5.0, 0, 0]])), fixed=True)
>>> ball = scene.add("ball", pcl_bsh.SphereHierarchy(np.zeros((1, 3))), motion=pcl_bsh.VelocityMotion([1, 0, 0]))
>>> result = scene.step(10.0)
>>> result.outcomes[0]["touched"], round(float(scene.pose("ball")[0, 3]), 3)
(True, 4.9)
)";

/// Scenes are not for several threads at once.
struct SharedScene {
  explicit SharedScene(const SceneOptions& options) : scene(options) {}
  Scene scene;
  std::mutex mutex;
};

/// Calls use(scene) without the interpreter's lock, when no other thread does.
template <class Use>
auto inTurn(SharedScene& shared, Use&& use)
{
  return unlocked([&] {
    const std::lock_guard<std::mutex> turn(shared.mutex);
    return use(shared.scene);
  });
}

Response responseOf(const std::string& text)
{
  if (text == "none") return Response::none;
  if (text == "stop") return Response::stop;
  if (text == "slide") return Response::slide;
  throw InvalidInput(Input::scene, "response", "`" + text + "` is none", "give \"none\", \"stop\" or \"slide\"");
}

std::unique_ptr<SharedScene> makeScene(double clearance, bool any, bool flags, std::optional<double> distance,
                                       std::optional<std::size_t> contacts, bool first_contact, bool swept,
                                       bool self_collisions, const std::string& response, std::optional<double> gravity,
                                       const py::object& down, bool test_pairs, const py::object& accuracy,
                                       double tolerance, double voxel_edge, unsigned threads,
                                       std::optional<double> deform)
{
  SceneOptions options;
  options.effects.any = any;
  options.effects.flags = flags;
  options.effects.distance = distance;
  options.effects.contacts = contacts;
  options.effects.first_contact = first_contact;
  options.effects.swept = swept;
  options.effects.self = self_collisions;
  options.effects.response = responseOf(response);
  options.effects.deform = deform;
  if (gravity) {
    options.effects.gravity.emplace();
    options.effects.gravity->step_height = *gravity;
    if (!down.is_none()) options.effects.gravity->down = vectorOf("down", down);
  }
  options.clearance = clearance;
  options.test_pairs = test_pairs;
  options.accuracy = accuracyOf(accuracy);
  options.tolerance = tolerance;
  options.voxel_edge = voxel_edge;
  options.threads = threads;
  return std::make_unique<SharedScene>(options);
}

Motion motionOf(const py::object& motion)
{
  if (motion.is_none()) return NoMotion{};
  if (py::isinstance<VelocityMotion>(motion)) return motion.cast<VelocityMotion>();
  if (py::isinstance<CircularMotion>(motion)) return motion.cast<CircularMotion>();
  return motion.cast<WaypointMotion>();
}

/// A hierarchy, or parts: (name, hierarchy) or (name, hierarchy, pose) each.
std::vector<ScenePart> partsOf(const std::string& name, const py::object& cloud)
{
  if (py::isinstance<SphereHierarchy>(cloud))
    return {{name, cloud.cast<std::shared_ptr<SphereHierarchy>>(), Eigen::Isometry3d::Identity()}};
  std::vector<ScenePart> parts;
  for (const py::handle item : cloud) {
    const auto part = item.cast<py::tuple>();
    if (part.size() != 2 && part.size() != 3)
      throw InvalidInput(Input::scene, name, "has a part of " + counted(part.size(), "value"),
                         "give (name, hierarchy) or (name, hierarchy, pose)");
    const py::object pose = part.size() == 3 ? py::object(part[2]) : py::none();
    parts.push_back(
        {part[0].cast<std::string>(), part[1].cast<std::shared_ptr<SphereHierarchy>>(), poseOf(name, pose)});
  }
  return parts;
}

ObjectId addObject(SharedScene& shared, const std::string& name, const py::object& cloud, const py::object& pose,
                   bool fixed, const std::string& group, const py::object& motion,
                   std::vector<std::pair<std::uint32_t, std::uint32_t>> adjacent)
{
  SceneObject object;
  object.name = name;
  object.group = group;
  object.parts = partsOf(name, cloud);
  object.pose = poseOf("pose", pose);
  object.fixed = fixed;
  object.motion = motionOf(motion);
  object.adjacent = std::move(adjacent);
  return inTurn(shared, [&](Scene& scene) { return scene.add(std::move(object)); });
}

/// An object's number, or its name.
ObjectId idOf(SharedScene& shared, const py::object& object)
{
  const bool named = py::isinstance<py::str>(object);
  const auto name = named ? object.cast<std::string>() : std::string();
  const auto number = named ? ObjectId{} : object.cast<ObjectId>();
  return inTurn(shared, [&](Scene& scene) {
    if (!named && number >= scene.size())
      throw InvalidInput(Input::scene, "object", "there is no object " + std::to_string(number),
                         "there are " + std::to_string(scene.size()) + ", counted from 0");
    if (!named) return number;
    const std::optional<ObjectId> found = scene.find(name);
    if (!found)
      throw InvalidInput(Input::scene, "object", "there is no object `" + name + "`",
                         "give a name that add() was given");
    return *found;
  });
}

void requirePart(const Scene& scene, ObjectId object, std::uint32_t part)
{
  if (part >= scene[object].parts.size())
    throw InvalidInput(Input::scene, "part", "there is no part " + std::to_string(part),
                       "the object has " + std::to_string(scene[object].parts.size()) + ", counted from 0");
}

PairRule ruleOf(const std::optional<bool>& tested, const std::optional<double>& clearance)
{
  return {tested, clearance};
}

void bindMotions(py::module_& module)
{
  py::class_<VelocityMotion>(module, "VelocityMotion",
                             "Straight on, by `linear` each second, turning about its own origin by `angular` (axis "
                             "times radians each second), both as the world sees them.")
      .def(py::init([](const py::object& linear, const py::object& angular) {
             VelocityMotion motion;
             motion.linear = vectorOf("linear", linear);
             if (!angular.is_none()) motion.angular = vectorOf("angular", angular);
             return motion;
           }),
           py::arg("linear"), py::arg("angular") = py::none());
  py::class_<CircularMotion>(module, "CircularMotion",
                             "Around an axis of the world, by `speed` radians each second; turning=False keeps the "
                             "rotation, as a gondola does.")
      .def(py::init([](const py::object& center, const py::object& axis, double speed, bool turning) {
             return CircularMotion{vectorOf("center", center), vectorOf("axis", axis), speed, turning};
           }),
           py::arg("center"), py::arg("axis"), py::arg("speed"), py::arg("turning") = true);
  py::class_<WaypointMotion>(
      module, "WaypointMotion",
      "From pose to pose (m, 4, 4) at ascending times (m,) in seconds; at rest before and after.")
      .def(py::init([](std::vector<double> times, const py::object& poses) {
             return WaypointMotion{std::move(times), posesOf("poses", poses)};
           }),
           py::arg("times"), py::arg("poses"));
}

} // namespace

void bindScene(py::module_& module)
{
  bindMotions(module);
  bindSceneResult(module);
  const auto none = py::none();
  py::class_<SharedScene>(module, "Scene", kScene)
      .def(py::init(&makeScene), py::kw_only(), py::arg("clearance") = 0.0, py::arg("any") = false,
           py::arg("flags") = false, py::arg("distance") = none, py::arg("contacts") = none,
           py::arg("first_contact") = false, py::arg("swept") = false, py::arg("self_collisions") = false,
           py::arg("response") = "none", py::arg("gravity") = none, py::arg("down") = none,
           py::arg("test_pairs") = true, py::arg("accuracy") = none, py::arg("tolerance") = 1e-4,
           py::arg("voxel_edge") = 0.0, py::arg("threads") = 1, py::arg("deform") = none)
      .def("add", &addObject, py::arg("name"), py::arg("cloud"), py::arg("pose") = none, py::kw_only(),
           py::arg("fixed") = false, py::arg("group") = "", py::arg("motion") = none,
           py::arg("adjacent") = std::vector<std::pair<std::uint32_t, std::uint32_t>>{},
           "Adds an object, and returns its number. `cloud` is a SphereHierarchy, or a list of parts: (name, "
           "hierarchy) or "
           "(name, hierarchy, pose). `adjacent` lists pairs of parts that self_collisions does not compare.")
      .def("__len__", [](SharedScene& s) { return inTurn(s, [](Scene& scene) { return scene.size(); }); })
      .def_property_readonly(
          "time", [](SharedScene& s) { return inTurn(s, [](Scene& scene) { return scene.time(); }); },
          "Seconds stepped so far.")
      .def(
          "find",
          [](SharedScene& s, const std::string& name) {
            return inTurn(s, [&](Scene& scene) { return scene.find(name); });
          },
          py::arg("name"), "The number of the object of that name, or None.")
      .def(
          "pose",
          [](SharedScene& s, const py::object& object) {
            const ObjectId id = idOf(s, object);
            return arrayOf(inTurn(s, [&](Scene& scene) { return scene[id].pose; }));
          },
          py::arg("object"), "Where an object stands now, (4, 4); `object` is its number or name.")
      .def(
          "set_pose",
          [](SharedScene& s, const py::object& object, const py::object& pose) {
            const ObjectId id = idOf(s, object);
            const Eigen::Isometry3d to = poseOf("pose", pose);
            inTurn(s, [&](Scene& scene) { scene.setPose(id, to); });
          },
          py::arg("object"), py::arg("pose"), "Takes an object somewhere, whatever is in between.")
      .def(
          "set_part_pose",
          [](SharedScene& s, const py::object& object, std::uint32_t part, const py::object& pose) {
            const ObjectId id = idOf(s, object);
            const Eigen::Isometry3d to = poseOf("pose", pose);
            inTurn(s, [&](Scene& scene) {
              requirePart(scene, id, part);
              scene.setPartPose(id, part, to);
            });
          },
          py::arg("object"), py::arg("part"), py::arg("pose"), "Moves a part within its object.")
      .def(
          "deform",
          [](SharedScene& s, const py::object& object, const py::object& xyz, std::uint32_t part,
             const py::object& radii, const py::object& uncertainties, bool copy) {
            const ObjectId id = idOf(s, object);
            return dictOf(whileNoneComputes(
                [&] {
                  requirePart(s.scene, id, part);
                  const PointsView& before = s.scene[id].parts[part].hierarchy->view();
                  return movedView(before, {xyz, radii, py::none(), 0.0, uncertainties, copy});
                },
                [&](const MovedView& moved) { return s.scene.deform(id, part, moved.now); }));
          },
          py::arg("object"), py::arg("xyz"), py::arg("part") = 0, py::kw_only(), py::arg("radii") = none,
          py::arg("uncertainties") = none, py::arg("copy") = false,
          "The points of a part have moved: as `SphereHierarchy.refit`, with the scene's factor; in every object that "
          "shares the hierarchy.")
      .def(
          "set_motion",
          [](SharedScene& s, const py::object& object, const py::object& motion) {
            const ObjectId id = idOf(s, object);
            const Motion next = motionOf(motion);
            inTurn(s, [&](Scene& scene) { scene.setMotion(id, next); });
          },
          py::arg("object"), py::arg("motion"), "How an object moves from now on; None: at rest.")
      .def(
          "set_rule",
          [](SharedScene& s, const py::object& a, const py::object& b, std::optional<bool> tested,
             std::optional<double> clearance) {
            const ObjectId id_a = idOf(s, a), id_b = idOf(s, b);
            inTurn(s, [&](Scene& scene) { scene.setRule(id_a, id_b, ruleOf(tested, clearance)); });
          },
          py::arg("a"), py::arg("b"), py::kw_only(), py::arg("tested") = none, py::arg("clearance") = none,
          "What holds for a pair of objects, over what holds for their groups.")
      .def(
          "set_group_rule",
          [](SharedScene& s, const std::string& a, const std::string& b, std::optional<bool> tested,
             std::optional<double> clearance) {
            inTurn(s, [&](Scene& scene) { scene.setGroupRule(a, b, ruleOf(tested, clearance)); });
          },
          py::arg("a"), py::arg("b"), py::kw_only(), py::arg("tested") = none, py::arg("clearance") = none,
          "What holds for pairs of objects of two groups.")
      .def(
          "query", [](SharedScene& s) { return inTurn(s, [](Scene& scene) { return scene.query(); }); },
          "The effects at the present poses.")
      .def(
          "step", [](SharedScene& s, double dt) { return inTurn(s, [&](Scene& scene) { return scene.step(dt); }); },
          py::arg("dt"),
          "Moves every object along its motion for `dt` seconds, as response and gravity allow, and queries.")
      .def("__repr__", [](SharedScene& s) {
        return inTurn(s, [](Scene& scene) { return "Scene(" + counted(scene.size(), "object") + ")"; });
      });
}

} // namespace pcl_bsh::python
