// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/scene/scene.h>

#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::python {
namespace {

py::tuple tripleOf(const Eigen::Vector3d& v)
{
  return py::make_tuple(v.x(), v.y(), v.z());
}

template <class T>
std::vector<py::dict> listOf(const std::vector<T>& entries);

/// A pair of parts, and what more there is of the pair.
template <class... More>
py::dict dictOf(const PartPair& pair, More... more)
{
  return py::dict("a"_a = pair.a, "b"_a = pair.b, "part_a"_a = pair.part_a, "part_b"_a = pair.part_b,
                  std::move(more)...);
}

py::dict dictOf(const CollidingPair& pair)
{
  return dictOf(pair, "pair"_a = tupleOf(pair.pair));
}

py::dict dictOf(const DistantPair& pair)
{
  return dictOf(pair, "distance"_a = pair.distance, "interval"_a = tupleOf(pair.interval),
                "pair"_a = tupleOf(pair.pair));
}

py::dict dictOf(const PartFirstContact& pair)
{
  return dictOf(pair, "fraction"_a = pair.fraction, "pair"_a = tupleOf(pair.pair));
}

py::dict dictOf(const Contact& contact)
{
  return py::dict("pair"_a = tupleOf(contact.pair), "distance"_a = contact.distance,
                  "normal"_a = tripleOf(contact.normal));
}

py::dict dictOf(const ContactPair& pair)
{
  return dictOf(pair, "contacts"_a = listOf(pair.contacts), "complete"_a = pair.complete);
}

py::dict dictOf(const FlaggedPart& part)
{
  const py::array_t<std::uint8_t> flags(static_cast<py::ssize_t>(part.flags.size()), bytesOf(part.flags));
  return py::dict("object"_a = part.object, "part"_a = part.part, "colliding"_a = part.colliding,
                  "undecided"_a = part.undecided, "flags"_a = flags);
}

py::dict dictOf(const SelfCollision& pair)
{
  return py::dict("object"_a = pair.object, "part_a"_a = pair.part_a, "part_b"_a = pair.part_b,
                  "pair"_a = tupleOf(pair.pair));
}

py::dict dictOf(const Leg& leg)
{
  return py::dict("from"_a = arrayOf(leg.from), "to"_a = arrayOf(leg.to), "center"_a = tripleOf(leg.center),
                  "turn"_a = tripleOf(leg.turn));
}

py::dict dictOf(const SweptMotion& motion)
{
  return py::dict("object"_a = motion.object, "part"_a = motion.part, "leg"_a = dictOf(motion.leg));
}

py::dict dictOf(const UnsweptObject& unswept)
{
  return py::dict("object"_a = unswept.object, "added"_a = unswept.added, "reshaped"_a = unswept.reshaped,
                  "detoured"_a = unswept.detoured);
}

py::dict dictOf(const Outcome& outcome)
{
  const auto against = outcome.touched ? std::optional(outcome.against) : std::nullopt;
  return py::dict("object"_a = outcome.object, "touched"_a = outcome.touched, "against"_a = against,
                  "stuck"_a = outcome.stuck, "grounded"_a = outcome.grounded, "wanted"_a = outcome.wanted,
                  "travelled"_a = outcome.travelled, "legs"_a = listOf(outcome.legs));
}

template <class T>
std::vector<py::dict> listOf(const std::vector<T>& entries)
{
  std::vector<py::dict> list;
  for (const T& entry : entries) list.push_back(dictOf(entry));
  return list;
}

/// A property with a dict for each entry of one of the result's vectors.
template <class T>
auto listed(std::vector<T> SceneResult::*entries)
{
  return [entries](const SceneResult& result) { return listOf(result.*entries); };
}

} // namespace

void bindSceneResult(py::module_& module)
{
  py::class_<SceneResult>(
      module, "SceneResult",
      "The answer of a scene: a list of dicts for each effect, empty unless it was asked for. Objects "
      "and parts are numbers, in the order in which they were added.")
      .def_readonly("time", &SceneResult::time, "Time of the scene, seconds.")
      .def_property_readonly("any", listed(&SceneResult::any), "a, b, part_a, part_b, pair.")
      .def_property_readonly("undecided", listed(&SceneResult::undecided), "a, b, part_a, part_b.")
      .def_property_readonly("flags", listed(&SceneResult::flags), "object, part, colliding, undecided, flags.")
      .def_property_readonly("distance", listed(&SceneResult::distance),
                             "a, b, part_a, part_b, distance, interval, pair.")
      .def_property_readonly("contacts", listed(&SceneResult::contacts), "a, b, part_a, part_b, contacts, complete.")
      .def_property_readonly("first_contact", listed(&SceneResult::first_contact),
                             "a, b, part_a, part_b, fraction of the way from the last query, pair.")
      .def_property_readonly("certain_contact", listed(&SceneResult::certain_contact),
                             "As first_contact, of what collides for certain; the same where no points are uncertain.")
      .def_property_readonly("swept", listed(&SceneResult::swept), "object, part, colliding, undecided, flags.")
      .def_property_readonly(
          "swept_motions", listed(&SceneResult::swept_motions),
          "The motions that first_contact and swept look at: object, part (None: the whole), leg "
          "(from, to: (4, 4); center, which goes straight, in the frame that these place; turn: axis "
          "times radians).")
      .def_property_readonly("unswept", listed(&SceneResult::unswept),
                             "Objects that did more than that since the last query: object, added (looked at where it "
                             "stands), reshaped (how its points got from their former places is not looked at), "
                             "detoured (it may have gone another way than its leg).")
      .def_property_readonly("self_collisions", listed(&SceneResult::self), "object, part_a, part_b, pair.")
      .def_property_readonly("outcomes", listed(&SceneResult::outcomes),
                             "Moved objects, with a response or gravity: object, touched, against, stuck, grounded, "
                             "wanted, travelled, legs (as in swept_motions).")
      .def("__repr__", [](const SceneResult& result) {
        return "SceneResult(time=" + numberText(result.time) +
               ", colliding pairs=" + std::to_string(result.any.size()) + ")";
      });
}

} // namespace pcl_bsh::python
