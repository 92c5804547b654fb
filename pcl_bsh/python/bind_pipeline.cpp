// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/pipeline.h>
#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/arrays/record_array.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/threads/callback.h>

#include <pybind11/stl.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>

namespace pcl_bsh::python {
namespace {

constexpr auto kRun = R"(Runs a chain of filters, in PDAL's grammar; STAGES.md lists the stages and their options.

Parameters
----------
document : dict, list or str
    ``{"pipeline": [...]}``, the list alone, or JSON. Paths and arrays may stand in it as they are.
clouds : dict of str to ndarray, optional
    For each tag of a reader the records that it gives instead of reading its file: structured, or (n, 3).
threads : int, default 0
    How many stages may run at once, and threads read a LAZ file; 0: all of the machine's threads.
validate_only : bool, default False
    Check options, files and fields without reading a point.
progress : callable, optional
    Called with a dict (tag, type, done, points, seconds, finished, stages) when a stage begins and when it is done. By
    returning False it stops the run, which raises `Cancelled`. Ctrl-C ends the run, too.

Returns
-------
PipelineRun
    `clouds`: for each tag whose cloud no other stage read, its records; `warnings`; `metadata`, a dict: a pipeline to
    run again.

Raises
------
PipelineError
    A ValueError that names the stage, the place in the document, and what to do.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> scan = np.random.default_rng(1).random((1000, 3))
>>> run = pcl_bsh.run_pipeline(
...     [{"type": "readers.pcd", "filename": "scan.pcd", "tag": "scan"},
...      {"type": "filters.voxel_grid", "leaf_size": 0.5, "tag": "thin"}], {"scan": scan})
>>> len(run.clouds["thin"])
8
)";

struct PipelineRun {
  As<"Dict[str, npt.NDArray[np.void]]"> clouds = py::dict();
  std::vector<std::string> warnings;
  py::dict metadata;
};

/// A document as JSON. Values that JSON lacks become lists by NumPy's tolist(), or texts.
std::string textOf(const py::object& document)
{
  if (py::isinstance<py::str>(document)) return document.cast<std::string>();
  const py::object whole = py::isinstance<py::dict>(document) ? document : py::dict("pipeline"_a = document);
  const py::cpp_function otherwise([](const py::object& value) -> py::object {
    if (py::hasattr(value, "tolist")) return value.attr("tolist")();
    return py::str(value);
  });
  return py::module_::import("json").attr("dumps")(whole, "default"_a = otherwise).cast<std::string>();
}

py::dict dictOf(const StageProgress& stage)
{
  return py::dict("tag"_a = stage.tag, "type"_a = stage.type, "done"_a = stage.done, "points"_a = stage.points,
                  "seconds"_a = stage.seconds, "finished"_a = stage.finished, "stages"_a = stage.stages);
}

/// Stages may run for long without a report, so another thread runs them, and this one listens for Ctrl-C.
PipelineResult runUntilInterrupted(Pipeline& pipeline)
{
  std::future<PipelineResult> run = std::async(std::launch::async, [&] { return pipeline.run(); });
  for (;;) {
    if (run.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready) return run.get();
    if (isEnding()) {
      pipeline.cancel();
      continue;
    }
    const Locked lock;
    if (PyErr_CheckSignals() == 0) continue;
    const py::error_already_set interrupt;
    {
      const Unlocked unlocked; // a callback may wait for the lock
      pipeline.cancel();
      run.wait();
    }
    throw interrupt;
  }
}

PipelineRun runPipeline(const As<"Union[str, Mapping[str, Any], Sequence[Any]]">& document,
                        const As<"Optional[Mapping[str, npt.NDArray[Any]]]">& clouds, unsigned threads,
                        bool validate_only, const As<"Optional[Callable[[Dict[str, Any]], Any]]">& progress)
{
  Pipeline pipeline = Pipeline::parse(textOf(document));
  if (!clouds.is_none()) {
    for (const auto& [tag, records] : clouds.cast<py::dict>()) {
      auto given = std::make_shared<pipeline::StageCloud>();
      given->cloud = cloudFrom(py::str(tag), py::reinterpret_borrow<py::object>(records));
      pipeline.setCloud(py::str(tag), given);
    }
  }
  pipeline.setNumberOfThreads(threads);
  if (!progress.is_none()) {
    pipeline.setProgress([&](const StageProgress& stage) {
      if (isEnding()) return pipeline.cancel();
      const Locked lock;
      if (isFalse(called(progress, dictOf(stage)))) pipeline.cancel();
    });
  }
  PipelineRun run;
  PipelineResult result;
  unlocked([&] {
    if (validate_only)
      pipeline.validate();
    else
      result = runUntilInterrupted(pipeline);
  });
  for (auto& [tag, cloud] : result.clouds) {
    pcl::PCLPointCloud2 own = pipeline::ownCloud(std::move(cloud))->cloud;
    run.clouds[py::str(tag)] = recordsFrom(std::move(own));
  }
  run.warnings = result.warnings;
  if (!result.metadata.empty()) run.metadata = py::module_::import("json").attr("loads")(result.metadata);
  return run;
}

} // namespace

void bindPipeline(py::module_& module)
{
  py::register_exception<PipelineError>(module, "PipelineError", PyExc_ValueError).attr("__doc__") =
      "The fault of a pipeline, in one line: stage, place in the document, what to do.";
  py::class_<PipelineRun>(module, "PipelineRun", "The answer of `run_pipeline`.")
      .def_readonly("clouds", &PipelineRun::clouds)
      .def_readonly("warnings", &PipelineRun::warnings)
      .def_readonly("metadata", &PipelineRun::metadata)
      .def("__repr__", [](const PipelineRun& run) {
        return "PipelineRun(clouds=" + std::string(py::str(py::list(run.clouds))) +
               ", warnings=" + std::to_string(run.warnings.size()) + ")";
      });
  module.def("run_pipeline", &runPipeline, kRun, "document"_a, "clouds"_a = py::none(), py::kw_only(), "threads"_a = 0,
             "validate_only"_a = false, "progress"_a = py::none());
}

} // namespace pcl_bsh::python
