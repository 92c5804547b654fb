// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/scene/scene.h>

#include <pybind11/stl.h>

#include <string>
#include <vector>

namespace pcl_bsh::python {
namespace {

py::tuple tripleOf(const Eigen::Vector3d& v)
{
  return py::make_tuple(v.x(), v.y(), v.z());
}

py::dict dictOf(const PartPair& pair)
{
  py::dict named;
  named["a"] = pair.a;
  named["b"] = pair.b;
  named["part_a"] = pair.part_a;
  named["part_b"] = pair.part_b;
  return named;
}

py::dict dictOf(const CollidingPair& pair)
{
  py::dict named = dictOf(static_cast<const PartPair&>(pair));
  named["witness"] = py::make_tuple(pair.witness.a, pair.witness.b);
  return named;
}

py::dict dictOf(const DistantPair& pair)
{
  py::dict named = dictOf(static_cast<const PartPair&>(pair));
  named["distance"] = pair.distance;
  named["interval"] = tupleOf(pair.interval);
  named["pair"] = py::make_tuple(pair.pair.a, pair.pair.b);
  return named;
}

py::dict dictOf(const PartFirstContact& pair)
{
  py::dict named = dictOf(static_cast<const PartPair&>(pair));
  named["fraction"] = pair.fraction;
  named["pair"] = py::make_tuple(pair.pair.a, pair.pair.b);
  return named;
}

py::dict dictOf(const ContactPair& pair)
{
  py::dict named = dictOf(static_cast<const PartPair&>(pair));
  py::list contacts;
  for (const Contact& contact : pair.contacts) {
    py::dict one;
    one["pair"] = py::make_tuple(contact.pair.a, contact.pair.b);
    one["distance"] = contact.distance;
    one["normal"] = tripleOf(contact.normal);
    contacts.append(one);
  }
  named["contacts"] = contacts;
  named["complete"] = pair.complete;
  return named;
}

py::dict dictOf(const FlaggedPart& part)
{
  py::dict named;
  named["object"] = part.object;
  named["part"] = part.part;
  named["colliding"] = part.colliding;
  named["undecided"] = part.undecided;
  named["flags"] = py::array_t<std::uint8_t>(static_cast<py::ssize_t>(part.flags.size()), part.flags.data());
  return named;
}

py::dict dictOf(const SelfCollision& pair)
{
  py::dict named;
  named["object"] = pair.object;
  named["part_a"] = pair.part_a;
  named["part_b"] = pair.part_b;
  named["witness"] = py::make_tuple(pair.witness.a, pair.witness.b);
  return named;
}

py::dict dictOf(const Leg& leg)
{
  py::dict named;
  named["from"] = arrayOf(leg.from);
  named["to"] = arrayOf(leg.to);
  named["center"] = tripleOf(leg.center);
  named["turn"] = tripleOf(leg.turn);
  return named;
}

py::dict dictOf(const SweptMotion& motion)
{
  py::dict named;
  named["object"] = motion.object;
  named["part"] = motion.part ? py::object(py::int_(*motion.part)) : py::none();
  named["leg"] = dictOf(motion.leg);
  return named;
}

py::dict dictOf(const UnsweptObject& unswept)
{
  py::dict named;
  named["object"] = unswept.object;
  named["added"] = unswept.added;
  named["reshaped"] = unswept.reshaped;
  named["detoured"] = unswept.detoured;
  return named;
}

py::dict dictOf(const Outcome& outcome)
{
  py::dict named;
  named["object"] = outcome.object;
  named["touched"] = outcome.touched;
  named["against"] = outcome.touched ? py::object(py::int_(outcome.against)) : py::none();
  named["stuck"] = outcome.stuck;
  named["grounded"] = outcome.grounded;
  named["wanted"] = outcome.wanted;
  named["travelled"] = outcome.travelled;
  py::list legs;
  for (const Leg& leg : outcome.legs) legs.append(dictOf(leg));
  named["legs"] = legs;
  return named;
}

/// A property with a dict for each entry of one of the result's vectors.
template <class T>
auto listed(std::vector<T> SceneResult::*entries)
{
  return [entries](const SceneResult& result) {
    py::list list;
    for (const T& entry : result.*entries) list.append(dictOf(entry));
    return list;
  };
}

} // namespace

void bindSceneResult(py::module_& module)
{
  py::class_<SceneResult>(
      module, "SceneResult",
      "What a scene computed: a list of dicts for each effect, empty unless it was asked for. Objects "
      "and parts are numbers, in the order in which they were added.")
      .def_readonly("time", &SceneResult::time, "Of the scene, seconds.")
      .def_property_readonly("any", listed(&SceneResult::any), "a, b, part_a, part_b, witness.")
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
      .def_property_readonly("self_collisions", listed(&SceneResult::self), "object, part_a, part_b, witness.")
      .def_property_readonly("outcomes", listed(&SceneResult::outcomes),
                             "Of moved objects, with a response or gravity: object, touched, against, stuck, grounded, "
                             "wanted, travelled, legs (as in swept_motions).")
      .def("__repr__", [](const SceneResult& result) {
        return "SceneResult(time=" + std::string(py::str(py::float_(result.time))) +
               ", colliding pairs=" + std::to_string(result.any.size()) + ")";
      });
}

} // namespace pcl_bsh::python
