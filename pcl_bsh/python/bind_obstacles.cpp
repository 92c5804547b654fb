// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>
#include <pcl_bsh/python/typed.h>
#include <pcl_bsh/question/obstacle_names.h>
#include <pcl_bsh/question/obstacles.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::python {
namespace {

constexpr auto kCollideObstacles =
    R"(Which points collide with any of several obstacles, and how each obstacle stands?

Parameters
----------
a : SphereHierarchy
obstacles : mapping of str to SphereHierarchy
    By their names. The name 'input' is that of `a`.
clearance : float, default 0
    The clearance of each obstacle that `clearances` does not name.
pose_a : array_like, (4, 4) or (3, 4), optional
poses : mapping of str to array_like, optional
    Rigid transforms from obstacles to the world, by names; others stand where they are given.
clearances : mapping of str to float, optional
solids : mapping of str to bool, optional
    In place of `solid`: whether an obstacle counts with what its faces enclose.
between : bool, default False
    Obstacles are compared with each other, too. Where they are more than 32, pairs that are free are not told.
overlap : bool, default False
    With `between`: the area of each surface inside another obstacle that is a solid.
ignore : sequence of str, optional
    Pairs that are not compared, "FIRST:SECOND", of names of obstacles or 'input'; * is any letters, and a
    backslash stands before a colon within a name.
accuracy : Accuracy or str, default exact
threads : int, default 1
progress : callable, optional
    Called now and then with the fraction done; by returning False it stops the query, which raises `Cancelled`.
**options of collisions

Returns
-------
ObstaclesAnswer

Raises
------
ValueError
    As `collision_flags`; no obstacle, a name that no obstacle has, a pattern that no name matches.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> hall = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [9, 0, 0]]))
>>> crate = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0.5]]))
>>> move = np.eye(4); move[0, 3] = 4
>>> found = pcl_bsh.collide_obstacles(hall, {"press": crate, "mill": crate}, 0.5, poses={"mill": move}, between=True)
>>> found.flags
array([1, 0], dtype=uint8)
>>> found.each["press"].colliding, found.each["mill"].colliding
(1, 0)
>>> found.between[0].first, found.between[0].second, found.between[0].closest.distance
('press', 'mill', 4.0)
)";

using Names = std::vector<std::string>;
using HierarchiesByName = As<"Mapping[str, SphereHierarchy]">;
using PosesByName = As<"Optional[Mapping[str, npt.ArrayLike]]">;
using LengthsByName = As<"Optional[Mapping[str, float]]">;
using SwitchesByName = As<"Optional[Mapping[str, bool]]">;
using PatternsLike = As<"Optional[Sequence[str]]">;

/// The answer about one of several obstacles, with its name.
struct NamedAnswer : ObstacleAnswer {
  std::string name;
};

/// A pair of obstacles, with their names.
struct NamedPair : ObstaclePair {
  std::string first_name, second_name;
};

struct ObstaclesFound {
  Names names;
  ObstaclesAnswer answer;
  std::vector<NamedPair> between;
};

std::optional<std::pair<double, double>> endsOf(const std::optional<Interval>& area)
{
  return area ? std::optional(std::pair{area->lower, area->upper}) : std::nullopt;
}

/// Calls use(number, value) for each obstacle that a mapping names.
/// @throws InvalidInput for a name that no obstacle has
template <class Use>
void forEachNamed(const char* argument, const py::object& values, const Names& names, const Use& use)
{
  if (values.is_none()) return;
  for (const auto& item : values.attr("items")()) {
    const auto pair = py::cast<std::pair<std::string, py::object>>(item);
    const auto found = std::find(names.begin(), names.end(), pair.first);
    if (found == names.end())
      throw InvalidInput(Input::points, argument, "'" + pair.first + "' is no obstacle", "give one of their names");
    try {
      use(static_cast<std::size_t>(found - names.begin()), pair.second);
    }
    catch (const py::cast_error&) {
      throw py::type_error(argument + ("['" + pair.first + "']: is no such value"));
    }
  }
}

/// The strings of a sequence, which is no string itself.
Names patternsOf(const py::object& patterns)
{
  if (patterns.is_none()) return {};
  if (py::isinstance<py::str>(patterns))
    throw InvalidInput(Input::points, "ignore", "is a text", "give a list: [\"FIRST:SECOND\"]");
  return py::cast<Names>(patterns);
}

ObstaclesFound collideObstaclesOf(const Cloud& a, const HierarchiesByName& obstacles, double clearance,
                                  const PoseLike& pose_a, const PosesByName& poses, const LengthsByName& clearances,
                                  const SwitchesByName& solids, bool between, bool overlap, const PatternsLike& ignore,
                                  const AccuracyLike& accuracy, unsigned threads, const ProgressLike& progress,
                                  const py::kwargs& options)
{
  ObstaclesFound found;
  std::vector<PlacedShape> shapes;
  for (const auto& item : obstacles.attr("items")()) {
    const auto pair = py::cast<std::pair<std::string, py::object>>(item);
    if (!py::isinstance<Cloud>(pair.second))
      throw py::type_error("obstacles['" + pair.first + "']: is no SphereHierarchy");
    found.names.push_back(pair.first);
    shapes.push_back({py::cast<const Cloud&>(pair.second).named(pair.first)});
  }
  checkObstacleNames(found.names);
  forEachNamed("poses", poses, found.names, [&](std::size_t i, const py::object& pose) {
    shapes[i].pose = poseOf("poses['" + found.names[i] + "']", pose);
  });
  forEachNamed("clearances", clearances, found.names,
               [&](std::size_t i, const py::object& length) { shapes[i].clearance = py::cast<double>(length); });
  forEachNamed("solids", solids, found.names,
               [&](std::size_t i, const py::object& solid) { shapes[i].solid = py::cast<bool>(solid); });
  const IgnoredPairs ignored(patternsOf(ignore), found.names);
  for (std::size_t i = 0; i < shapes.size(); ++i) shapes[i].ignores_input = ignored.holds(kInputName, found.names[i]);

  Question question;
  question.pose_of_input = poseOf("pose_a", pose_a);
  question.clearance = clearance;
  question.accuracy = accuracyOf(accuracy);
  question.threads = threads;
  question.progress = progressOf(progress);
  setOptions(question, options, QuestionKind::collisions);
  if (question.seen)
    throw InvalidOption("seen", "is about points of obstacles, which this does not tell",
                        "ask collision_flags() about each");
  question.wanted.flags = question.wanted.closest = question.wanted.spacings = true;
  question.wanted.overlap = overlap;
  Shape input = a.named("a");
  std::vector<ObstaclePair> pairs;
  unlocked([&] {
    found.answer = ask(question, input, shapes);
    if (between)
      pairs = askBetween(question, shapes, [&](std::uint32_t i, std::uint32_t k) {
        return !ignored.holds(found.names[i], found.names[k]);
      });
    return true;
  });
  for (const ObstaclePair& pair : pairs) {
    NamedPair named;
    static_cast<ObstaclePair&>(named) = pair;
    named.first_name = found.names[pair.first];
    named.second_name = found.names[pair.second];
    found.between.push_back(std::move(named));
  }
  for (const Warning& warning : found.answer.all.warnings) warn(warning.text);
  return found;
}

As<"Dict[str, ObstacleAnswer]"> eachOf(const ObstaclesFound& found)
{
  py::dict each;
  for (std::size_t i = 0; i < found.names.size(); ++i) {
    NamedAnswer one;
    static_cast<ObstacleAnswer&>(one) = found.answer.each[i];
    one.name = found.names[i];
    each[py::str(one.name)] = one;
  }
  return {each};
}

std::optional<std::string> nameOfClosest(const ObstaclesFound& found)
{
  if (found.answer.closest == kNothing) return std::nullopt;
  return found.names[found.answer.closest];
}

} // namespace

void bindObstacles(py::module_& module)
{
  py::class_<NamedAnswer>(module, "ObstacleAnswer", "How an obstacle of several stands to the input.")
      .def_readonly("name", &NamedAnswer::name)
      .def_readonly("asked", &NamedAnswer::asked, "False where it ignores the input: the rest says nothing.")
      .def_property_readonly("verdict", [](const NamedAnswer& one) { return verdictOf(one.verdict); })
      .def_readonly("colliding", &NamedAnswer::colliding, "Rows of the input.")
      .def_readonly("undecided", &NamedAnswer::undecided)
      .def_readonly("sparse", &NamedAnswer::sparse)
      .def_readonly("closest", &NamedAnswer::closest,
                    "The smallest distance and its rows: of the input and of the obstacle.")
      .def("__repr__", [](const NamedAnswer& one) {
        return "ObstacleAnswer('" + one.name + "', " + counted(one.colliding, "point") + ", distance " +
               numberText(one.closest.distance) + ")";
      });
  py::class_<NamedPair>(module, "ObstaclePair", "How two obstacles stand to each other.")
      .def_readonly("first", &NamedPair::first_name)
      .def_readonly("second", &NamedPair::second_name)
      .def_readonly("clearance", &NamedPair::clearance, "The greater of theirs.")
      .def_property_readonly("verdict", [](const NamedPair& pair) { return verdictOf(pair.verdict); })
      .def_readonly("closest", &NamedPair::closest)
      .def_property_readonly(
          "first_within", [](const NamedPair& pair) { return endsOf(pair.first_within); },
          "With `overlap`, the area of the first's surface inside the second, a solid: an interval that holds it.")
      .def_property_readonly(
          "second_within", [](const NamedPair& pair) { return endsOf(pair.second_within); }, "The other way.")
      .def("__repr__", [](const NamedPair& pair) {
        return "ObstaclePair('" + pair.first_name + "', '" + pair.second_name + "', distance " +
               numberText(pair.closest.distance) + ")";
      });
  py::class_<ObstaclesFound>(module, "ObstaclesAnswer", "The answer of `collide_obstacles`.")
      .def_property_readonly(
          "flags",
          [](const py::object& self) {
            return arrayIn(self, self.cast<const ObstaclesFound&>().answer.all.collisions.flags);
          },
          "uint8: a Verdict for each row of the input, the gravest of all obstacles.")
      .def_property_readonly("colliding",
                             [](const ObstaclesFound& found) { return found.answer.all.collisions.colliding; })
      .def_property_readonly(
          "closest", [](const ObstaclesFound& found) { return found.answer.all.closest; },
          "The smallest distance of all obstacles.")
      .def_property_readonly("closest_obstacle", &nameOfClosest, "Its name; None where there is no such distance.")
      .def_property_readonly("each", &eachOf, "By name, in the order in which obstacles were given.")
      .def_readonly("between", &ObstaclesFound::between, "Each two that were compared with each other.")
      .def_property_readonly("work", [](const ObstaclesFound& found) { return found.answer.all.work; })
      .def("__repr__", [](const ObstaclesFound& found) {
        return "ObstaclesAnswer(" + counted(found.names.size(), "obstacle") + ", " +
               counted(found.answer.all.collisions.colliding, "point") + ")";
      });
  const auto none = py::none();
  module.def("collide_obstacles", &collideObstaclesOf, kCollideObstacles, "a"_a, "obstacles"_a, "clearance"_a = 0.0,
             py::kw_only(), "pose_a"_a = none, "poses"_a = none, "clearances"_a = none, "solids"_a = none,
             "between"_a = false, "overlap"_a = false, "ignore"_a = none, "accuracy"_a = none, "threads"_a = 1,
             "progress"_a = none);
}

} // namespace pcl_bsh::python
