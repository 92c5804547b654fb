// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/robots/ros_packages.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/robot_model.h>
#include <pcl_bsh/python/threads/callback.h>

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::python {
namespace {

using robots::Joint;

constexpr auto kRobot = R"(A robot with joints, from a URDF.

A state is an array with one value for each of `joints`, in radians or metres: (J,), or (n, J) for several.

Parameters
----------
urdf : str or path-like
    Joints are fixed, revolute, continuous or prismatic, and may mimic others. Boxes, cylinders and spheres are solid,
    meshes are surfaces, in metres; of each link its bodies for collisions count, or those to look at where it has none.
srdf : str or path-like, optional
    Pairs of links that are never held against each other, groups of joints, and states with names.
packages : dict of str to path, optional
    The folder that ``package://NAME/`` stands for. Others are looked for in the environment's ROS_PACKAGE_PATH.
padding : float or dict of str to float, default 0
    Links are as thick as if their shapes were so much larger all round: all of them, or those that are named; m, >= 0.

Raises
------
FileError
    A ValueError and an OSError: a file that is not there or is refused, a mesh that is not there, has no faces or is of
    another format.
ValueError
    A padding that is negative or not finite, or of a link that is not there; a joint without meaning.

Examples
--------
>>> import numpy as np, pcl_bsh, pathlib, tempfile
>>> text = '''<robot name="crane"><link name="post"/><link name="beam"><collision><origin xyz="1 0 0"/>
...   <geometry><box size="2 0.25 0.25"/></geometry></collision></link>
...   <joint name="turn" type="revolute"><parent link="post"/><child link="beam"/><axis xyz="0 0 1"/>
...   <limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>'''
>>> with tempfile.TemporaryDirectory() as folder:
...     file = pathlib.Path(folder, "crane.urdf")
...     written = file.write_text(text)
...     crane = pcl_bsh.Robot(file)
>>> crane.joints, crane.limits
(['turn'], array([[-3.,  3.]]))
>>> world = pcl_bsh.RobotWorld(crane, np.array([[0.0, 1.5, 0.0]]), clearance=0.25)
>>> world.is_free([0.0]), world.is_free([[0.0], [1.5]])
(True, array([ True, False]))
>>> found = world.check_motions([0.0], [3.0], with_last_valid=True)
>>> print(found.verdict == pcl_bsh.Verdict.COLLIDING, crane.links[found.link], 0.43 < found.last_valid < 0.45)
True beam True
)";

constexpr auto kState = R"(A state from values by the names of joints.

Parameters
----------
values : dict of str to float, optional
    In radians or metres.
named : str, optional
    The state of the SRDF whose values the other joints have. None: they are at 0.

Returns
-------
ndarray of float64, (J,)
    Its limits are looked at by the queries.

Raises
------
ValueError
    A joint that is not there, does not move or mimics another; a state that the SRDF has not.
)";

constexpr auto kShape = R"(A solid that `RobotWorld.attach` hangs on a link: a ball, a capsule, a cylinder or a box.

Lengths are in metres, > 0. Capsules and cylinders lie about z, and all are centred where `pose` puts them, in the link's
frame. A capsule's length is that between the centres of its ends.

Examples
--------
>>> import pcl_bsh
>>> pcl_bsh.Shape.capsule(0.02, 0.3)
Shape(capsule)
)";

constexpr auto kLinkPoses = R"(Where the links are, seen from the root.

Parameters
----------
q : array_like, (J,) or (n, J)

Returns
-------
ndarray of float64, (L, 4, 4) or (n, L, 4, 4)
    In the order of `links`.
)";

using Names = std::vector<std::string>;
using OptionalPath = As<"Union[None, str, os.PathLike[str]]">;
using Folders = std::optional<std::map<std::string, PathLike>>;
using PaddingLike = As<"Union[float, Mapping[str, float]]">;

void pad(robots::Robot& robot, const PaddingLike& padding)
{
  if (!py::isinstance<py::dict>(padding)) {
    const auto all = padding.cast<double>();
    for (robots::Link& link : robot.links) link.padding = all;
    return;
  }
  for (const auto& [link, length] : padding.cast<std::map<std::string, double>>())
    robot.links[robot.linkNamed(link)].padding = length;
}

std::shared_ptr<RobotModel> makeRobot(const PathLike& urdf, const OptionalPath& srdf, const Folders& packages,
                                      const PaddingLike& padding)
{
  std::map<std::string, std::filesystem::path> folders;
  if (packages)
    for (const auto& [name, folder] : *packages) folders[name] = pathOf(folder);
  const std::string file = pathOf(urdf), srdf_file = srdf.is_none() ? "" : pathOf(srdf);
  io::RobotGroups groups;
  robots::Robot robot = unlocked([&] {
    robots::Robot read = io::readRobot(file, folders, io::packagePath());
    if (!srdf_file.empty()) groups = io::readGroups(srdf_file, read);
    io::readMeshes(read);
    return read;
  });
  pad(robot, padding);
  return std::make_shared<RobotModel>(std::move(robot), std::move(groups));
}

const Joint& jointOf(const RobotModel& model, std::size_t variable)
{
  return *model.robot.links[model.kinematics.linkOfVariable(variable)].joint;
}

Names jointsOf(const RobotModel& model)
{
  Names names;
  for (std::size_t i = 0; i < model.kinematics.variables(); ++i) names.push_back(jointOf(model, i).name);
  return names;
}

Names linksOf(const RobotModel& model)
{
  Names names;
  for (const robots::Link& link : model.robot.links) names.push_back(link.name);
  return names;
}

py::array_t<double> limitsOf(const RobotModel& model)
{
  py::array_t<double> limits({static_cast<py::ssize_t>(model.kinematics.variables()), py::ssize_t{2}});
  double* number = limits.mutable_data();
  for (std::size_t i = 0; i < model.kinematics.variables(); ++i) {
    const Joint& joint = jointOf(model, i);
    const bool bounded = joint.kind != Joint::Kind::continuous;
    *number++ = bounded ? joint.lower : Joint().lower;
    *number++ = bounded ? joint.upper : Joint().upper;
  }
  return limits;
}

/// For the name of each group of joints, their columns in a state.
py::dict groupsOf(const RobotModel& model)
{
  const Names joints = jointsOf(model);
  py::dict groups;
  for (const auto& [name, members] : model.groups.joints) {
    std::vector<std::int64_t> columns;
    for (const std::string& joint : members)
      columns.push_back(std::find(joints.begin(), joints.end(), joint) - joints.begin());
    groups[py::str(name)] = arrayFrom(std::move(columns));
  }
  return groups;
}

py::dict statesByName(const RobotModel& model)
{
  py::dict states;
  for (const auto& [name, values] : model.groups.states)
    states[py::str(name)] = arrayFrom(stateOf(model.robot, values));
  return states;
}

py::array_t<double> stateOfValues(const RobotModel& model, std::optional<robots::JointValues> values,
                                  const std::optional<std::string>& named)
{
  robots::JointValues all = std::move(values).value_or(robots::JointValues());
  if (named) {
    const auto found = model.groups.states.find(*named);
    if (found == model.groups.states.end())
      throw InvalidInput(Input::motion, "state '" + *named + "'", "is not in the SRDF of " + model.robot.name,
                         "give a name that `states` has");
    all.insert(found->second.begin(), found->second.end());
  }
  return arrayFrom(stateOf(model.robot, all));
}

py::array_t<double> linkPosesOf(const RobotModel& model, const ArrayLike& q)
{
  const States states = statesOf("q", q, model);
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(model.robot.links.size()), 4, 4};
  if (!states.is_one) shape.insert(shape.begin(), static_cast<py::ssize_t>(states.rows.size()));
  py::array_t<double> poses(shape);
  double* number = poses.mutable_data();
  unlocked([&] {
    for (const robots::RobotState& state : states.rows)
      for (const Eigen::Isometry3d& pose : model.kinematics.linkPoses(state))
        for (int i = 0; i < 16; ++i) *number++ = pose.matrix()(i / 4, i % 4);
  });
  return poses;
}

template <class Form>
robots::Shape madeSolid(Form form, const PoseLike& given)
{
  return {std::move(form), rigidPoseOf("pose", given)};
}

} // namespace

void bindRobot(py::module_& module)
{
  using robots::Shape;
  py::class_<Shape>(module, "Shape", kShape)
      .def_static(
          "sphere", [](double radius, const PoseLike& pose) { return madeSolid(robots::Sphere{radius}, pose); },
          "radius"_a, "pose"_a = py::none(), "A ball.")
      .def_static(
          "capsule",
          [](double radius, double length, const PoseLike& pose) {
            return madeSolid(robots::Capsule{radius, length}, pose);
          },
          "radius"_a, "length"_a, "pose"_a = py::none(), "All within the radius of a segment about z.")
      .def_static(
          "cylinder",
          [](double radius, double length, const PoseLike& pose) {
            return madeSolid(robots::Cylinder{radius, length}, pose);
          },
          "radius"_a, "length"_a, "pose"_a = py::none(), "A cylinder with flat ends, about z.")
      .def_static(
          "box",
          [](const std::array<double, 3>& size, const PoseLike& pose) {
            return madeSolid(robots::Box{Eigen::Vector3d(size[0], size[1], size[2])}, pose);
          },
          "size"_a, "pose"_a = py::none(), "A box along the axes, of these three sizes.")
      .def("__repr__", [](const Shape& shape) {
        constexpr const char* names[] = {"box", "cylinder", "sphere", "mesh", "capsule"};
        return "Shape(" + std::string(names[shape.form.index()]) + ")";
      });
  py::class_<RobotModel, std::shared_ptr<RobotModel>>(module, "Robot", kRobot)
      .def(py::init(&makeRobot), "urdf"_a, "srdf"_a = py::none(), py::kw_only(), "packages"_a = py::none(),
           "padding"_a = 0.0)
      .def_property_readonly("name", [](const RobotModel& model) { return model.robot.name; })
      .def_property_readonly("links", &linksOf, "Names; the root first, parents before their children.")
      .def_property_readonly("joints", &jointsOf, "Names of those that move by themselves, in the order of a state.")
      .def_property_readonly("limits", &limitsOf, "(J, 2); -inf and inf of continuous joints.")
      .def_property_readonly("groups", &groupsOf, "The SRDF's, by name: the columns of a state that a group has.")
      .def_property_readonly("states", &statesByName, "The SRDF's, by name; joints that one does not name are at 0.")
      .def("state", &stateOfValues, kState, "values"_a = py::none(), py::kw_only(), "named"_a = py::none())
      .def("link_poses", &linkPosesOf, kLinkPoses, "q"_a)
      .def("__repr__", [](const RobotModel& model) {
        return "Robot(" + model.robot.name + ", " + counted(model.robot.links.size(), "link") + ", " +
               counted(model.kinematics.variables(), "joint") + ")";
      });
}

} // namespace pcl_bsh::python
