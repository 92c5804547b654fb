// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>
#include <pcl_bsh/question/warnings/scene_warnings.h>
#include <pcl_bsh/scene/scene.h>

#include <pybind11/stl.h>

#include <map>
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
    The motion of an object where it meets another.
gravity : float, optional
    Objects follow the ground, and climb or sink by this step height at most.
down : array_like, (3,), default (0, 0, -1)
    Direction of gravity.
test_pairs : bool, default True
    False: only pairs for which a rule asks.
accuracy : Accuracy or str, default exact
    Accuracy of any, flags, distance and self_collisions.
tolerance : float, default 1e-4
    Length by which first contacts, swept motion and responses may be off, in the clouds' unit; > 0.
voxel_edge : float, default 0
    Edge of a cell of the grid over the scene; 0: from the sizes of what moves.
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

using ObjectLike = As<"Union[int, str]">;
using MotionLike = As<"Union[None, VelocityMotion, CircularMotion, WaypointMotion]">;
using CloudLike = As<"Union[SphereHierarchy, Sequence[Union[Tuple[str, SphereHierarchy], "
                     "Tuple[str, SphereHierarchy, npt.ArrayLike]]]]">;

/// A scene, with a mutex because only one thread at a time may use it.
struct SharedScene {
  explicit SharedScene(const SceneOptions& options) : scene(options) {}
  Scene scene;
  std::mutex mutex;
  std::size_t told = 0; ///< objects whose warnings were given
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

/// The result of ask(scene); warns where objects were added since the last time.
template <class Ask>
SceneResult resultOf(SharedScene& shared, Ask&& ask)
{
  std::vector<std::string> warnings;
  SceneResult result = inTurn(shared, [&](Scene& scene) {
    SceneResult answer = ask(scene);
    if (shared.told == scene.size()) return answer;
    shared.told = scene.size();
    std::map<std::string, Shape> clouds;
    std::vector<NamedObject> objects;
    for (ObjectId id = 0; id < scene.size(); ++id) {
      const SceneObject& object = scene[id];
      objects.push_back({object.name, object.fixed, {}, object.pose, object.motion});
      for (const ScenePart& part : object.parts) {
        const std::string name = object.parts.size() == 1 ? object.name : object.name + "." + part.name;
        clouds.emplace(name, static_cast<const Cloud&>(*part.hierarchy).named(name));
        objects.back().parts.push_back({name, part.pose, part.solid});
      }
    }
    warnings = warningsOf(objects, clouds, scene.options().clearance, std::nullopt);
    if (auto untested = warningOfNoPairs(scene)) warnings.push_back(std::move(*untested));
    return answer;
  });
  for (const std::string& warning : warnings) warn(warning);
  return result;
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
                                       bool self_collisions, const As<"Literal['none', 'stop', 'slide']">& response,
                                       std::optional<double> gravity, const OptionalArray& down, bool test_pairs,
                                       const AccuracyLike& accuracy, double tolerance, double voxel_edge,
                                       unsigned threads, std::optional<double> deform)
{
  SceneOptions options;
  options.effects.any = any;
  options.effects.flags = flags;
  options.effects.distance = distance;
  options.effects.contacts = contacts;
  options.effects.first_contact = first_contact;
  options.effects.swept = swept;
  options.effects.self = self_collisions;
  options.effects.response = responseOf(response.cast<std::string>());
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

Motion motionOf(const MotionLike& motion)
{
  if (motion.is_none()) return NoMotion{};
  if (py::isinstance<VelocityMotion>(motion)) return motion.cast<VelocityMotion>();
  if (py::isinstance<CircularMotion>(motion)) return motion.cast<CircularMotion>();
  return motion.cast<WaypointMotion>();
}

/// A hierarchy, or parts: (name, hierarchy) or (name, hierarchy, pose) each.
std::vector<ScenePart> partsOf(const std::string& name, const CloudLike& cloud)
{
  if (py::isinstance<Cloud>(cloud))
    return {{name, cloud.cast<std::shared_ptr<Cloud>>(), Eigen::Isometry3d::Identity()}};
  std::vector<ScenePart> parts;
  for (const py::handle item : cloud) {
    const auto part = item.cast<py::tuple>();
    if (part.size() != 2 && part.size() != 3)
      throw InvalidInput(Input::scene, name, "has a part of " + counted(part.size(), "value"),
                         "give (name, hierarchy) or (name, hierarchy, pose)");
    const py::object pose = part.size() == 3 ? py::object(part[2]) : py::none();
    parts.push_back({part[0].cast<std::string>(), part[1].cast<std::shared_ptr<Cloud>>(), poseOf(name, pose)});
  }
  return parts;
}

ObjectId addObject(SharedScene& shared, const std::string& name, const CloudLike& cloud, const PoseLike& pose,
                   bool fixed, const std::string& group, const MotionLike& motion,
                   std::vector<std::pair<std::uint32_t, std::uint32_t>> adjacent, bool solid)
{
  SceneObject object;
  object.name = name;
  object.group = group;
  object.parts = partsOf(name, cloud);
  for (ScenePart& part : object.parts) part.solid = solid;
  object.pose = poseOf("pose", pose);
  object.fixed = fixed;
  object.motion = motionOf(motion);
  object.adjacent = std::move(adjacent);
  return inTurn(shared, [&](Scene& scene) { return scene.add(std::move(object)); });
}

/// An object's number, or its name.
ObjectId idOf(SharedScene& shared, const ObjectLike& object)
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

void bindMotions(py::module_& module)
{
  py::class_<VelocityMotion>(module, "VelocityMotion",
                             "Straight on, by `linear` each second, turning about its own origin by `angular` (axis "
                             "times radians each second), both as the world sees them.")
      .def(py::init([](const ArrayLike& linear, const OptionalArray& angular) {
             VelocityMotion motion;
             motion.linear = vectorOf("linear", linear);
             if (!angular.is_none()) motion.angular = vectorOf("angular", angular);
             return motion;
           }),
           "linear"_a, "angular"_a = py::none());
  py::class_<CircularMotion>(module, "CircularMotion",
                             "Around an axis of the world, by `speed` radians each second; turning=False keeps the "
                             "rotation, as a gondola does.")
      .def(py::init([](const ArrayLike& center, const ArrayLike& axis, double speed, bool turning) {
             return CircularMotion{vectorOf("center", center), vectorOf("axis", axis), speed, turning};
           }),
           "center"_a, "axis"_a, "speed"_a, "turning"_a = true);
  py::class_<WaypointMotion>(
      module, "WaypointMotion",
      "From pose to pose (m, 4, 4) at ascending times (m,) in seconds; at rest before and after.")
      .def(py::init([](std::vector<double> times, const ArrayLike& poses) {
             return WaypointMotion{std::move(times), posesOf("poses", poses)};
           }),
           "times"_a, "poses"_a);
}

} // namespace

void bindScene(py::module_& module)
{
  bindMotions(module);
  bindSceneResult(module);
  const auto none = py::none();
  py::class_<SharedScene>(module, "Scene", kScene)
      .def(py::init(&makeScene), py::kw_only(), "clearance"_a = 0.0, "any"_a = false, "flags"_a = false,
           "distance"_a = none, "contacts"_a = none, "first_contact"_a = false, "swept"_a = false,
           "self_collisions"_a = false, "response"_a = "none", "gravity"_a = none, "down"_a = none,
           "test_pairs"_a = true, "accuracy"_a = none, "tolerance"_a = 1e-4, "voxel_edge"_a = 0.0, "threads"_a = 1,
           "deform"_a = none)
      .def("add", &addObject, "name"_a, "cloud"_a, "pose"_a = none, py::kw_only(), "fixed"_a = false, "group"_a = "",
           "motion"_a = none, "adjacent"_a = std::vector<std::pair<std::uint32_t, std::uint32_t>>{}, "solid"_a = false,
           "Adds an object, and returns its number. `cloud` is a SphereHierarchy, or a list of parts: (name, "
           "hierarchy) or "
           "(name, hierarchy, pose). `adjacent` lists pairs of parts that self_collisions does not compare. "
           "`solid`: its meshes count with what their faces enclose, and they must close.")
      .def("__len__", [](SharedScene& s) { return inTurn(s, [](Scene& scene) { return scene.size(); }); })
      .def_property_readonly(
          "time", [](SharedScene& s) { return inTurn(s, [](Scene& scene) { return scene.time(); }); },
          "Seconds stepped so far.")
      .def(
          "find",
          [](SharedScene& s, const std::string& name) {
            return inTurn(s, [&](Scene& scene) { return scene.find(name); });
          },
          "name"_a, "The number of the object of that name, or None.")
      .def(
          "pose",
          [](SharedScene& s, const ObjectLike& object) {
            const ObjectId id = idOf(s, object);
            return arrayOf(inTurn(s, [&](Scene& scene) { return scene[id].pose; }));
          },
          "object"_a, "Where an object stands now, (4, 4); `object` is its number or name.")
      .def(
          "set_pose",
          [](SharedScene& s, const ObjectLike& object, const ArrayLike& pose) {
            const ObjectId id = idOf(s, object);
            const Eigen::Isometry3d to = poseOf("pose", pose);
            inTurn(s, [&](Scene& scene) { scene.setPose(id, to); });
          },
          "object"_a, "pose"_a, "Takes an object somewhere, whatever is in between.")
      .def(
          "set_part_pose",
          [](SharedScene& s, const ObjectLike& object, std::uint32_t part, const ArrayLike& pose) {
            const ObjectId id = idOf(s, object);
            const Eigen::Isometry3d to = poseOf("pose", pose);
            inTurn(s, [&](Scene& scene) {
              requirePart(scene, id, part);
              scene.setPartPose(id, part, to);
            });
          },
          "object"_a, "part"_a, "pose"_a, "Moves a part within its object.")
      .def(
          "deform",
          [](SharedScene& s, const ObjectLike& object, const ArrayLike& xyz, std::uint32_t part,
             const OptionalArray& radii, const OptionalArray& uncertainties, bool copy) {
            const ObjectId id = idOf(s, object);
            return dictOf(whileNoneComputes(
                [&] {
                  requirePart(s.scene, id, part);
                  Cloud& cloud = static_cast<Cloud&>(*s.scene[id].parts[part].hierarchy);
                  cloud.forget();
                  return movedView(cloud.view(), {xyz, radii, py::none(), 0.0, uncertainties, copy});
                },
                [&](const MovedView& moved) { return s.scene.deform(id, part, moved.now); }));
          },
          "object"_a, "xyz"_a, "part"_a = 0, py::kw_only(), "radii"_a = none, "uncertainties"_a = none,
          "copy"_a = false,
          "The points of a part have moved: as `SphereHierarchy.refit`, with the scene's factor; in every object that "
          "shares the hierarchy.")
      .def(
          "set_motion",
          [](SharedScene& s, const ObjectLike& object, const MotionLike& motion) {
            const ObjectId id = idOf(s, object);
            const Motion next = motionOf(motion);
            inTurn(s, [&](Scene& scene) { scene.setMotion(id, next); });
          },
          "object"_a, "motion"_a, "How an object moves from now on; None: at rest.")
      .def(
          "set_rule",
          [](SharedScene& s, const ObjectLike& a, const ObjectLike& b, std::optional<bool> tested,
             std::optional<double> clearance) {
            const ObjectId id_a = idOf(s, a), id_b = idOf(s, b);
            inTurn(s, [&](Scene& scene) { scene.setRule(id_a, id_b, {tested, clearance}); });
          },
          "a"_a, "b"_a, py::kw_only(), "tested"_a = none, "clearance"_a = none,
          "Sets the rule of a pair of objects, over the rules of their groups.")
      .def(
          "set_group_rule",
          [](SharedScene& s, const std::string& a, const std::string& b, std::optional<bool> tested,
             std::optional<double> clearance) {
            inTurn(s, [&](Scene& scene) { scene.setGroupRule(a, b, {tested, clearance}); });
          },
          "a"_a, "b"_a, py::kw_only(), "tested"_a = none, "clearance"_a = none,
          "Sets the rule of pairs of objects of two groups.")
      .def(
          "query", [](SharedScene& s) { return resultOf(s, [](Scene& scene) { return scene.query(); }); },
          "The effects at the present poses.")
      .def(
          "step", [](SharedScene& s, double dt) { return resultOf(s, [&](Scene& scene) { return scene.step(dt); }); },
          "dt"_a, "Moves every object along its motion for `dt` seconds, as response and gravity allow, and queries.")
      .def("__repr__", [](SharedScene& s) {
        return inTurn(s, [](Scene& scene) { return "Scene(" + counted(scene.size(), "object") + ")"; });
      });
}

} // namespace pcl_bsh::python
