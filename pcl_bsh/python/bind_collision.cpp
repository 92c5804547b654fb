// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>
#include <pcl_bsh/python/typed.h>
#include <pcl_bsh/question/enclosed.h>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace pcl_bsh::python {
namespace {

constexpr auto kCollisionFlags =
    R"(Which points collide with something of the other cloud?

Parameters
----------
a, b : SphereHierarchy
clearance : float, default 0
pose_a, pose_b : array_like, (4, 4) or (3, 4), optional
    Rigid transforms from the cloud to the world.
side : {"a", "b", "both"}
    The clouds whose points are flagged.
accuracy : Accuracy or str, default exact
threads : int, default 1
**options of collisions
spacings_of_b : ndarray of float32, (records of b,), optional
    How far the samples of b's surface are apart (`patch_spacings`): what is free, but no farther from a point of b than
    the clearance and half of its spacing, is `Verdict.SPARSE`.

Returns
-------
ndarray of uint8, (records,)
    A `Verdict` for each point: 0 free, 1 colliding, 2 undecided (where the accuracy stops early or places are
    uncertain), 3 sparse. With ``side="both"`` a tuple of both arrays.

Raises
------
ValueError
    A clearance that is negative or not finite, a pose that is not rigid within 1e-6, a text that names no accuracy.

Warns
-----
UserWarning
    Facts that the flags do not tell: a cloud without a finite point, or with some that are not; float32 coordinates that
    are coarse for the clearance; points so far apart that surfaces may touch between them; clouds that are so far from
    each other that their frames are not one, perhaps. All queries of two clouds warn of the same facts.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [1, 0, 0]]))
>>> b = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0.5]]))
>>> pcl_bsh.collision_flags(a, b, clearance=0.5)
array([1, 0], dtype=uint8)
>>> move = np.eye(4); move[0, 3] = 1
>>> pcl_bsh.collision_flags(a, b, clearance=0.5, pose_b=move)
array([0, 1], dtype=uint8)
)";

constexpr auto kCollidingIndices =
    R"(The rows that collide, ascending: for large clouds of which few points do.

Parameters are those of `collision_flags`, except `spacings_of_b`, `density` and `seen`.

Returns
-------
ndarray of int32
    With ``side="both"`` a tuple of both arrays. Undecided points are not among them: see `collision_flags`.

Raises
------
ValueError
    As `collision_flags`; where points stay undecided, too, for then a list of those that collide would say they are
    free.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [1, 0, 0]]))
>>> pcl_bsh.colliding_indices(a, pcl_bsh.SphereHierarchy(np.array([[1.0, 0, 0.5]])), 0.5)
array([1], dtype=int32)
)";

constexpr auto kAnyCollision =
    R"(Does any pair of points collide? Ends at the first one.

Parameters are those of `collision_flags`, except `side`, `spacings_of_b`, `density` and `seen`.

Returns
-------
AnyCollision
    True where a condition is asked for and a pair collides. An undecided one is neither, and raises.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
>>> b = pcl_bsh.SphereHierarchy(np.array([[0.0, 3, 4]]))
>>> bool(pcl_bsh.any_collision(a, b, 5.0)), bool(pcl_bsh.any_collision(a, b, 4.9))
(True, False)
>>> pcl_bsh.any_collision(a, b, 5.0).pair
(0, 0)
)";

constexpr auto kClosestPair = R"(The smallest distance of two clouds, and the pair of points that realises it.

Parameters
----------
a, b : SphereHierarchy
max_distance : float, optional
    No pair that is farther apart is looked for, so that what is beyond costs little. Inclusive.
pose_a, pose_b, accuracy, threads, solid, input_solid
    As of `collision_flags`.

Returns
-------
ClosestPair
    `distance` (less the points' radii; negative of what a solid holds, the depth of the deepest; infinity when a cloud is
    empty, or no pair is within `max_distance`), rows `a` and `b` (None when there is no pair; of
    several pairs the smallest), and the `interval` that holds the distance for certain.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
>>> b = pcl_bsh.SphereHierarchy(np.array([[0.0, 30, 40], [0, 3, 4]]))
>>> pair = pcl_bsh.closest_pair(a, b)
>>> pair.distance, pair.a, pair.b
(5.0, 0, 1)
>>> pcl_bsh.closest_pair(a, b, max_distance=4.0).distance
inf
)";

bool isNotBoth(py::handle side)
{
  return py::isinstance<py::str>(side) && side.cast<std::string>() != "both";
}

using OneSide = As<"Literal['a', 'b']", isNotBoth>;
using BothSides = As<"Literal['both']">;

Flagged sideOf(const std::string& text)
{
  if (text == "a") return Flagged::a;
  if (text == "b") return Flagged::b;
  if (text == "both") return Flagged::both;
  throw InvalidInput(Input::result, "side", "`" + text + "` is none", "give \"a\", \"b\" or \"both\"");
}

/// Arrays of one side, or of both.
template <class Sides, class Value>
auto arraysOf(std::vector<Value>&& a, std::vector<Value>&& b, Flagged side)
{
  if constexpr (std::is_same_v<Sides, BothSides>)
    return std::pair(arrayFrom(std::move(a)), arrayFrom(std::move(b)));
  else
    return arrayFrom(std::move(side == Flagged::a ? a : b));
}

/// The question about collisions at one pose each.
PythonQuestion collisionsAsked(const Cloud& a, const Cloud& b, double clearance, const PoseLike& pose_a,
                               const PoseLike& pose_b, const AccuracyLike& accuracy, unsigned threads,
                               const py::kwargs& options)
{
  PythonQuestion asked(a, pose_a, b, pose_b);
  asked.question.clearance = clearance;
  asked.question.accuracy = accuracyOf(accuracy);
  asked.question.threads = threads;
  asked.set(options, QuestionKind::collisions);
  return asked;
}

/// Refuses `seen` for an answer without verdicts of b's points: only these can be unseen.
void refuseSeen(const PythonQuestion& asked)
{
  if (asked.question.seen)
    throw InvalidOption("seen", "is about points of b, which this does not tell",
                        "ask collision_flags() with side=\"b\" or \"both\"");
}

template <class Sides>
auto collisionFlagsOf(const Cloud& a, const Cloud& b, double clearance, const PoseLike& pose_a, const PoseLike& pose_b,
                      const Sides& side, const AccuracyLike& accuracy, unsigned threads,
                      const As<"Optional[npt.NDArray[np.float32]]">& spacings_of_b, const py::kwargs& options)
{
  PythonQuestion asked = collisionsAsked(a, b, clearance, pose_a, pose_b, accuracy, threads, options);
  const Flagged flagged = sideOf(side.template cast<std::string>());
  Question& question = asked.question;
  if (flagged == Flagged::a) refuseSeen(asked);
  question.wanted.flags = flagged != Flagged::b;
  question.wanted.obstacle_flags = flagged != Flagged::a;
  question.wanted.spacings = true;
  if (!spacings_of_b.is_none()) {
    const py::array_t<float> spacings = floatsOf("spacings_of_b", spacings_of_b, viewNow(b).count);
    asked.obstacle.setPatches({spacings.data(), spacings.data() + spacings.size()});
    question.density = true;
  }
  Answer found = asked.answer();
  return arraysOf<Sides>(std::move(found.collisions.flags), std::move(found.obstacle_flags), flagged);
}

template <class Sides>
auto collidingIndicesOf(const Cloud& a, const Cloud& b, double clearance, const PoseLike& pose_a,
                        const PoseLike& pose_b, const Sides& side, const AccuracyLike& accuracy, unsigned threads,
                        const py::kwargs& options)
{
  PythonQuestion asked = collisionsAsked(a, b, clearance, pose_a, pose_b, accuracy, threads, options);
  const Flagged flagged = sideOf(side.template cast<std::string>());
  refuseSeen(asked);
  asked.question.wanted.indices = flagged != Flagged::b;
  asked.question.wanted.obstacle_indices = flagged != Flagged::a;
  CollidingIndices found = asked.answer().indices;
  const std::size_t undecided = found.undecided_a.size() + found.undecided_b.size();
  if (undecided > 0)
    throw InvalidInput(Input::accuracy, "colliding_indices",
                       counted(undecided, "point is", "points are") + " undecided",
                       "ask collision_flags(), whose answer says which");
  return arraysOf<Sides>(std::move(found.a), std::move(found.b), flagged);
}

AnyResult anyCollisionOf(const Cloud& a, const Cloud& b, double clearance, const PoseLike& pose_a,
                         const PoseLike& pose_b, const AccuracyLike& accuracy, unsigned threads,
                         const py::kwargs& options)
{
  PythonQuestion asked = collisionsAsked(a, b, clearance, pose_a, pose_b, accuracy, threads, options);
  refuseSeen(asked);
  asked.question.wanted.any = true;
  return asked.answer().any;
}

bool isColliding(const AnyResult& result)
{
  if (result.verdict == Verdict::undecided)
    throw InvalidInput(Input::result, "any_collision", "undecided is neither colliding nor free",
                       "look at `verdict`, or ask more exactly");
  return result.verdict == Verdict::colliding;
}

DistanceResult closestPairOf(const Cloud& a, const Cloud& b, const PoseLike& pose_a, const PoseLike& pose_b,
                             std::optional<double> max_distance, const AccuracyLike& accuracy, unsigned threads,
                             bool solid, bool input_solid)
{
  PythonQuestion asked(a, pose_a, b, pose_b);
  asked.question.solid = solid;
  asked.question.input_solid = input_solid;
  DistanceRequest request;
  if (max_distance) request.max_distance = *max_distance;
  request.accuracy = accuracyOf(accuracy);
  request.threads = asked.question.threads = threads;
  const auto find = [&] {
    DistanceResult found = closestPair(asked.a, asked.b, request);
    addEnclosed(asked.question, asked.input, asked.obstacle, found);
    return found;
  };
  return asked.answer(find, [](const DistanceResult& found) { return found.distance; });
}

/// A property for one of the pair's rows.
auto row(std::uint32_t PointPair::*of)
{
  return [of](const DistanceResult& result) { return result.pair ? std::optional((*result.pair).*of) : std::nullopt; };
}

std::string textOf(const AnyResult& result)
{
  const char* const names[] = {"FREE", "COLLIDING", "UNDECIDED", "SPARSE"};
  std::string text = std::string("AnyCollision(") + names[static_cast<std::size_t>(result.verdict)];
  if (result.pair) text += ", pair " + std::string(py::str(py::cast(tupleOf(*result.pair))));
  return text + ")";
}

std::string textOf(const DistanceResult& result)
{
  std::string text = "ClosestPair(" + numberText(result.distance);
  if (result.pair) text += ", rows " + std::string(py::str(py::cast(tupleOf(*result.pair))));
  return text + ")";
}

} // namespace

void bindCollision(py::module_& module)
{
  const auto none = py::none();
  py::class_<AnyResult>(module, "AnyCollision", "The answer of `any_collision`.")
      .def_property_readonly("verdict", [](const AnyResult& result) { return verdictOf(result.verdict); })
      .def_property_readonly(
          "pair", [](const AnyResult& result) { return tupleOf(result.pair); },
          "A colliding pair of rows (a, b), the first that the search met; or None.")
      .def_property_readonly(
          "interval", [](const AnyResult& result) { return tupleOf(result.interval); },
          "(lower, upper): holds the distance of the clouds, as far as the search had to learn it.")
      .def_readonly("work", &AnyResult::work)
      .def("__bool__", &isColliding)
      .def("__repr__", [](const AnyResult& result) { return textOf(result); });
  py::class_<DistanceResult>(module, "ClosestPair", "The answer of `closest_pair`.")
      .def_readonly("distance", &DistanceResult::distance)
      .def_property_readonly("a", row(&PointPair::a))
      .def_property_readonly("b", row(&PointPair::b))
      .def_property_readonly(
          "interval", [](const DistanceResult& result) { return tupleOf(result.interval); },
          "(lower, upper): holds the distance for certain.")
      .def_readonly("work", &DistanceResult::work)
      .def("__repr__", [](const DistanceResult& result) { return textOf(result); });

  const auto define = [&](const char* name, auto function, const char* text, const auto& side, auto... more) {
    module.def(name, function, text, "a"_a, "b"_a, "clearance"_a = 0.0, py::kw_only(), "pose_a"_a = none,
               "pose_b"_a = none, side, "accuracy"_a = none, "threads"_a = 1, more...);
  };
  define("collision_flags", &collisionFlagsOf<OneSide>, kCollisionFlags, "side"_a = "a", "spacings_of_b"_a = none);
  define("collision_flags", &collisionFlagsOf<BothSides>, "", "side"_a, "spacings_of_b"_a = none);
  define("colliding_indices", &collidingIndicesOf<OneSide>, kCollidingIndices, "side"_a = "a");
  define("colliding_indices", &collidingIndicesOf<BothSides>, "", "side"_a);
  module.def("any_collision", &anyCollisionOf, kAnyCollision, "a"_a, "b"_a, "clearance"_a = 0.0, py::kw_only(),
             "pose_a"_a = none, "pose_b"_a = none, "accuracy"_a = none, "threads"_a = 1);
  module.def("closest_pair", &closestPairOf, kClosestPair, "a"_a, "b"_a, py::kw_only(), "pose_a"_a = none,
             "pose_b"_a = none, "max_distance"_a = none, "accuracy"_a = none, "threads"_a = 1, "solid"_a = false,
             "input_solid"_a = false);
}

} // namespace pcl_bsh::python
