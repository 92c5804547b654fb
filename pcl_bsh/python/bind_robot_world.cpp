// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/robot_answers.h>
#include <pcl_bsh/python/robot_world.h>
#include <pcl_bsh/robot/robot_world.h>

#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::python {
namespace {

using robots::ClearanceResult;
using robots::MotionCheck;
using robots::StateCheck;
using Motions = std::vector<robots::RobotWorld::Motion>;

constexpr auto kWorld = R"(A robot among obstacles: whether it is free, how far from them, and whether a motion is free.

A state is free where each link is farther than the clearance from all obstacles, and from links that it is held against.
A motion is a straight line between two states, continuous joints going the shorter way; it is free where each of its
instants is. Nothing is sampled: answers hold for exact arithmetic on the given numbers. A state is undecided where it is
within rounding of the clearance, a motion only where its least gap is within the tolerance of it.

Parameters
----------
robot : Robot
obstacles : SphereHierarchy, ndarray (n, 3), or sequence of these
    Clouds, balls and surfaces, in one frame, the world's. They are kept. After a `refit` of one the next query sees it.
    A mesh is its surface: what is inside of one is not seen.
clearance : float, default 0
    Links this near to an obstacle collide, m, >= 0; inclusive. At 0, a finger passes between points that have no radii.
self_clearance : float, default 0
    Links this near to each other collide, m, >= 0; inclusive.
tolerance : float, default 1e-4
    Motions this near to the clearance may be undecided, m, > 0.
with_self : bool, default True
    Links are held against each other, save for parent and child, and for those that the SRDF disables.
base : array_like, (4, 4) or (3, 4), optional
    Pose of the robot's root in the world.
joint_uncertainties : array_like, (J,), optional
    How far each value of a state may be from the joint's true one, rad or m, >= 0. Where these or places of obstacles are
    uncertain, free and colliding hold for all that may be; the rest is undecided.

Raises
------
ValueError
    A length, a pose or an uncertainty without meaning; obstacles that are no points.

Warns
-----
UserWarning
    A link may slip through holes between points; obstacles of which no point, or not every one, is finite.

Notes
-----
Several threads may ask one world at once. See `Robot` for an example.
)";

constexpr auto kIsFree = R"(Whether states are certainly free: False where one collides or is undecided.

Parameters
----------
q : array_like, (J,) or (n, J)
    A state, or several.
threads : int, default 1
    0: all of the machine's; any number gives the same result.
progress : callable, optional
    Called now and then with the fraction done; by returning False it stops the query, which raises `Cancelled`.

Returns
-------
bool, or ndarray of bool, (n,)
    `check_states` tells collisions from what is undecided, and what meets.

Raises
------
ValueError
    Naming the state and the joint: a value that is not finite or is out of its limits; another number of values.
)";

constexpr auto kCheckStates = R"(The verdict of each state, and what collides.

Parameters are those of `is_free`.

Returns
-------
StateChecks
    Arrays of the shape (n,), or () of one state: `verdict` (a `Verdict`: 0 free, 1 colliding, 2 undecided), and what
    collides, or is undecided: `link` and its `shape`, and either `other_link` and `other_shape`, where the robot meets
    itself, or `obstacle` and its `record`. -1 stands for nothing.
)";

constexpr auto kIsMotionFree =
    R"(Whether motions are certainly free at every instant: False where one collides or is undecided.

Parameters
----------
q0, q1 : array_like, (J,) or (n, J)
    From these states to those; one of them goes with all of the others.
threads : int, default 1
progress : callable, optional
    As those of `is_free`.

Returns
-------
bool, or ndarray of bool, (n,)
    `check_motions` tells collisions from what is undecided, and how far a motion is free.

Raises
------
ValueError
    As `is_free`; q0 and q1 of different numbers of states.
)";

constexpr auto kCheckMotions =
    R"(The verdict of each motion, where it collides, what collides there, and how far it is free.

Parameters
----------
q0, q1 : array_like, (J,) or (n, J)
    As those of `is_motion_free`; so are `threads` and `progress`.
with_last_valid : bool, default False
    Also look for the first instant that is not free.

Returns
-------
MotionChecks
    Arrays of the shape (n,), or () of one motion: `verdict`; `fraction`, where it collides or is undecided, 1 where it is
    free; `last_valid`: it is certainly free up to there, 1 where it is free, else 0 unless it was asked for; and what
    collides there, as `check_states` tells it.
)";

constexpr auto kClearance = R"(How far states are from all that they may meet: obstacles, and links with `with_self`.

Parameters
----------
q : array_like, (J,) or (n, J)
limit : float, optional
    Greater gaps are not looked for: then the gap is from that to inf.
threads : int, default 1
progress : callable, optional
    As those of `is_free`.

Returns
-------
Clearances
    `gap`, (n, 2), or (2,) of one state: it is at least the first and at most the second number, less all radii and
    paddings, and negative inside of solids. Two solids that meet are at most at its upper end. And what is nearest, as
    `check_states` tells it; -1 where nothing is within the limit.

Raises
------
ValueError
    As `is_free`; a limit that is not a number.
)";

constexpr auto kSetObstaclePoses = R"(Moves the obstacles; hierarchies are not built anew.

Parameters
----------
poses : array_like, (n, 4, 4) or (n, 3, 4), or sequence of these
    One for each obstacle, in the world. Other obstacles (`set_obstacles`) stand where they are given.

Raises
------
ValueError
    Another number of poses; a pose that is not rigid.
)";

constexpr auto kAttach = R"(Hangs something on a link: a load in a gripper, or a tool.

It is a new link of `robot`, the last one, and is not held against the link that carries it, nor against `ignored`.

Parameters
----------
name : str
    The name of the new link.
link : str
    The link that carries it.
shapes : sequence of Shape
    In the frame of that link.
ignored : sequence of str, optional
    Links that it may touch: fingers.

Raises
------
ValueError
    A name that a link has; a link that is not there; a shape without a size.
)";

/// Asks the world as it is now, without the interpreter's lock. A state takes a microsecond, but the lock takes up to
/// five milliseconds where other threads want it. So without `progress` only unlocked() asks for Ctrl-C, after many
/// states.
template <class Ask>
auto askWorld(const PyWorld& world, unsigned threads, const ProgressLike& progress, const Ask& ask)
{
  const auto placed = world.placed;
  Effort effort(threads);
  if (!progress.is_none()) effort.progress = progressOf(progress);
  return unlocked([&] { return ask(*placed->now(), effort); });
}

Answers<StateCheck> checkStates(const PyWorld& world, const ArrayLike& q, unsigned threads,
                                const ProgressLike& progress)
{
  const States states = statesOf("q", q, *world.robot);
  return {askWorld(world, threads, progress,
                   [&](const robots::RobotWorld& now, const Effort& effort) {
                     return now.checkStates(states.rows, effort);
                   }),
          states.is_one};
}

Answers<MotionCheck> checkMotions(const PyWorld& world, const ArrayLike& q0, const ArrayLike& q1, bool with_last_valid,
                                  unsigned threads, const ProgressLike& progress)
{
  const States from = statesOf("q0", q0, *world.robot), to = statesOf("q1", q1, *world.robot);
  const std::size_t count = from.is_one ? to.rows.size() : from.rows.size();
  if (!to.is_one && to.rows.size() != count)
    throw InvalidInput(Input::motion, "q1", "has " + counted(to.rows.size(), "state"),
                       "give as many as q0 has, " + std::to_string(count) + ", or one");
  Motions motions;
  for (std::size_t i = 0; i < count; ++i)
    motions.push_back({from.rows[from.is_one ? 0 : i], to.rows[to.is_one ? 0 : i]});
  return {askWorld(world, threads, progress,
                   [&](const robots::RobotWorld& now, const Effort& effort) {
                     return now.checkMotions(motions, with_last_valid, effort);
                   }),
          from.is_one && to.is_one};
}

Answers<ClearanceResult> clearancesOf(const PyWorld& world, const ArrayLike& q, std::optional<double> limit,
                                      unsigned threads, const ProgressLike& progress)
{
  const States states = statesOf("q", q, *world.robot);
  const double within = limit.value_or(std::numeric_limits<double>::infinity());
  return {askWorld(world, threads, progress,
                   [&](const robots::RobotWorld& now, const Effort& effort) {
                     return now.clearances(states.rows, within, effort);
                   }),
          states.is_one};
}

} // namespace

void bindRobotWorld(py::module_& module)
{
  py::class_<PyWorld>(module, "RobotWorld", kWorld)
      .def(py::init(&makeWorld), "robot"_a, "obstacles"_a = py::tuple(), py::kw_only(), "clearance"_a = 0.0,
           "self_clearance"_a = 0.0, "tolerance"_a = 1e-4, "with_self"_a = true, "base"_a = py::none(),
           "joint_uncertainties"_a = py::none())
      .def_property_readonly("robot", [](const PyWorld& world) { return world.robot; })
      .def_property_readonly("obstacles", [](const PyWorld& world) { return world.obstacles; })
      .def_property_readonly("base", [](const PyWorld& world) { return arrayOf(world.options.base); })
      .def("set_obstacles", &setObstacles, "obstacles"_a, "Other obstacles, as `RobotWorld` takes them.")
      .def("set_obstacle_poses", &setObstaclePoses, kSetObstaclePoses, "poses"_a)
      .def("set_base", &setBase, "base"_a, "Moves the whole robot: the pose of its root in the world.")
      .def("attach", &attachTo, kAttach, "name"_a, "link"_a, "shapes"_a, "ignored"_a = py::tuple())
      .def("detach", &detachFrom, "name"_a, "Takes off what `attach` added last, by its name.")
      .def(
          "is_free",
          [](const PyWorld& world, const ArrayLike& q, unsigned threads, const ProgressLike& progress) {
            return freeOnes(checkStates(world, q, threads, progress));
          },
          kIsFree, "q"_a, py::kw_only(), "threads"_a = 1, "progress"_a = py::none())
      .def("check_states", &checkStates, kCheckStates, "q"_a, py::kw_only(), "threads"_a = 1, "progress"_a = py::none())
      .def(
          "is_motion_free",
          [](const PyWorld& world, const ArrayLike& q0, const ArrayLike& q1, unsigned threads,
             const ProgressLike& progress) { return freeOnes(checkMotions(world, q0, q1, false, threads, progress)); },
          kIsMotionFree, "q0"_a, "q1"_a, py::kw_only(), "threads"_a = 1, "progress"_a = py::none())
      .def("check_motions", &checkMotions, kCheckMotions, "q0"_a, "q1"_a, py::kw_only(), "with_last_valid"_a = false,
           "threads"_a = 1, "progress"_a = py::none())
      .def("clearance", &clearancesOf, kClearance, "q"_a, "limit"_a = py::none(), py::kw_only(), "threads"_a = 1,
           "progress"_a = py::none())
      .def("__repr__", [](const PyWorld& world) {
        return "RobotWorld(" + world.robot->robot.name + ", " + counted(world.obstacles.size(), "obstacle") + ")";
      });
}

} // namespace pcl_bsh::python
