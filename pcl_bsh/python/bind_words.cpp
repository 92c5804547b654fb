// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/typed.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/work.h>

#include <exception>
#include <string>

namespace pcl_bsh::python {
namespace {

namespace py = pybind11;

constexpr auto kAccuracy = R"(How sure an answer has to be, and so what it may cost.

Every query takes one as `accuracy`, or the text that makes it: ``"exact"``, ``"tolerance=LENGTH"``,
``"level=N"``, ``"pairs=N"`` or ``"time=SECONDS"``. A query that stops early leaves points undecided, or returns
intervals that hold the truth.

Parameters
----------
text : str
    As above.

Raises
------
ValueError
    Where the text is another.

Examples
--------
>>> import pcl_bsh
>>> pcl_bsh.Accuracy("tolerance=0.01")
Accuracy('tolerance=0.01')
>>> pcl_bsh.Accuracy.time(0.001).stops_early
True
)";

py::handle& verdicts()
{
  static py::handle type; // never freed: the interpreter may be gone by then
  return type;
}

std::string workText(const Work& work)
{
  return "Work(node_pairs=" + std::to_string(work.node_pairs) + ", leaf_pairs=" + std::to_string(work.leaf_pairs) +
         ", exact_decisions=" + std::to_string(work.exact_decisions) + ", updates=" + std::to_string(work.updates()) +
         ", voxels_built=" + std::to_string(work.voxels_built) + ")";
}

} // namespace

VerdictMember verdictOf(Verdict verdict)
{
  return verdicts()(static_cast<int>(verdict));
}

void bindWords(py::module_& module)
{
  py::dict members;
  members["FREE"] = static_cast<int>(Verdict::free);
  members["COLLIDING"] = static_cast<int>(Verdict::colliding);
  members["UNDECIDED"] = static_cast<int>(Verdict::undecided);
  members["SPARSE"] = static_cast<int>(Verdict::sparse);
  members["UNSEEN"] = static_cast<int>(Verdict::unseen);
  verdicts() = py::module_::import("enum").attr("IntEnum")("Verdict", members, "module"_a = "pcl_bsh").release();
  verdicts().attr("__doc__") =
      "Values in arrays of flags: 0 free, 1 colliding, 2 undecided, 3 free, but within the clearance and half the "
      "spacing there of a point, so not scanned densely enough, 4 free, but seen by no scanner.";
  module.attr("Verdict") = verdicts();

  py::register_exception_translator([](std::exception_ptr error) { // a TypeError, as Python's for arguments
    try {
      std::rethrow_exception(error);
    }
    catch (const py::cast_error&) {
      PyErr_SetString(PyExc_TypeError, "an argument has another type than the docstring says");
    }
  });
  py::register_exception<Cancelled>(module, "Cancelled", PyExc_RuntimeError).attr("__doc__") =
      "A callback asked a query to stop. Everything may be asked again.";

  py::class_<Accuracy>(module, "Accuracy", kAccuracy)
      .def(py::init(&Accuracy::parse), "text"_a = "exact")
      .def_static("exact", &Accuracy::exact, "The answer of exact arithmetic on the given numbers.")
      .def_static("tolerance", &Accuracy::tolerance, "length"_a,
                  "Pairs in (clearance, clearance + length] may go either way; distances are within `length`.")
      .def_static("level", &Accuracy::level, "depth"_a, "Spheres below the voxels are opened down to this level.")
      .def_static("node_pairs", &Accuracy::nodePairs, "count"_a, "Stops after about so many sphere tests.")
      .def_static("time", &Accuracy::time, "seconds"_a, "Stops when the seconds are spent.")
      .def_property_readonly("is_exact", &Accuracy::isExact)
      .def_property_readonly("stops_early", &Accuracy::stopsEarly, "Whether answers may stay undecided.")
      .def("__str__", &Accuracy::text)
      .def("__eq__",
           [](const Accuracy& a, const py::object& other) {
             return py::isinstance<Accuracy>(other) && a.text() == other.cast<const Accuracy&>().text();
           })
      .def("__hash__", [](const Accuracy& a) { return py::hash(py::str(a.text())); })
      .def("__repr__", [](const Accuracy& accuracy) { return "Accuracy('" + accuracy.text() + "')"; });

  py::class_<Work>(module, "Work", "Counted cost of a query: free of noise.")
      .def_readonly("node_pairs", &Work::node_pairs, "Tests of the bounding volumes of two nodes.")
      .def_readonly("volumes_carried", &Work::volumes_carried, "Bounding volumes carried into another frame.")
      .def_readonly("volumes_built", &Work::volumes_built)
      .def_readonly("voxels_built", &Work::voxels_built)
      .def_readonly("leaf_pairs", &Work::leaf_pairs, "Pairs of leaves whose points were compared.")
      .def_readonly("exact_decisions", &Work::exact_decisions, "Pairs that float arithmetic could not decide.")
      .def_property_readonly("updates", &Work::updates, "All updates of bounding volumes, as the paper counts them.")
      .def("__repr__", &workText);
}

} // namespace pcl_bsh::python
