// SPDX-License-Identifier: BSD-3-Clause
// Pipelines of point cloud filters, written as JSON in PDAL's grammar.
//
//   pcl_bsh::Pipeline pipeline = pcl_bsh::Pipeline::read("flag.json");
//   pipeline.validate();                     // all that can be known without reading points
//   pcl_bsh::PipelineResult result = pipeline.run();
//
// {"pipeline": ["hall.pcd",
//               {"type": "filters.voxel_grid", "leaf_size": 0.02},
//               {"type": "filters.bsh_flag", "obstacle": "robot.pcd", "clearance": 0.05},
//               "marked.pcd"]}
//
// Comments are allowed. A string is a file to read or, when last, to write. Without `inputs`, a stage reads the one
// before it. STAGES.md lists the stages and their options.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/pipeline/stage_cloud.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

namespace pipeline {
struct Graph;
}

/// what() reads `DOCUMENT: TAG: /pipeline/2/leaf_size: what is wrong: what to do`; parts that do not apply are absent.
class PipelineError : public std::runtime_error {
public:
  /// @param line bytes that would break or steer a terminal's line are replaced
  explicit PipelineError(std::string line);
};

/// One option of one stage, given after the document was written.
struct OptionOverride {
  std::string tag; ///< as the document has it or, for a stage without tag, type and number: filters_voxel_grid1
  std::string option;
  std::string value; ///< as in JSON; a text needs no quotes
};

/// Progress of a stage.
struct StageProgress {
  std::string tag;
  std::string type;
  bool done = false;      ///< otherwise it begins
  std::size_t points = 0; ///< that came out
  double seconds = 0;
  std::size_t finished = 0; ///< stages done so far
  std::size_t stages = 0;   ///< of all
};

/// Results of a run, beside the files that it wrote.
struct PipelineResult {
  std::map<std::string, pipeline::StageCloudPtr> clouds; ///< by tag: what no other stage read
  std::vector<std::string> warnings;                     ///< `TAG: text`
  std::string metadata;                                  ///< JSON: what ran and what it took; a pipeline to run again
};

/// A document that was understood: it can be validated, run and stopped.
class Pipeline {
public:
  /// @param name how errors call the document
  /// @throws PipelineError for anything that is wrong with the document itself
  static Pipeline parse(std::string_view json, const std::vector<OptionOverride>& overrides = {},
                        const std::string& name = "pipeline");

  /// Reads a file, or standard input as `-`. @throws PipelineError also when it cannot be read
  static Pipeline read(const std::filesystem::path& file, const std::vector<OptionOverride>& overrides = {});

  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;
  ~Pipeline();

  /// Lets the reader with that tag give this cloud instead of reading its file. The pipeline holds it until it ends.
  /// @throws PipelineError when no reader has that tag
  void setCloud(const std::string& tag, pipeline::StageCloudPtr cloud);

  /// Names a file that the caller is going to write, so that validate() and run() refuse it where a stage or the
  /// document itself is in that file. @param name how errors call it
  void reserve(const std::string& name, const std::filesystem::path& file);

  /// How many stages run at once, and threads read LAZ; 0: as many as the machine has (default). Results are the same.
  void setNumberOfThreads(unsigned threads);

  /// Called when a stage begins and when it is done, one call at a time, from whichever thread runs it. It may call
  /// cancel(). An exception that it throws ends the run and comes out of run(), once the stages that run by then are
  /// done.
  void setProgress(std::function<void(const StageProgress&)> progress);

  /// Checks that no file is written over another of the pipeline, that input files are there, that their headers have
  /// the fields that are needed, and that outputs can be written. No points are read. @throws PipelineError
  void validate();

  /// Validates, then runs. A cloud is freed once its last reader is done. Can be called again, after an error too.
  /// @throws PipelineError when a stage fails; of several, the first in the document. Cancelled
  ///   (pcl_bsh/base/cancelled.h) when cancel() was called; what the progress callback throws
  PipelineResult run();

  /// May be called from any thread and from the progress callback: run() begins no more stages, collision queries along
  /// trajectories stop, and run() throws Cancelled. Each call ends at most one run: the present one or, without one,
  /// the next. Files are complete or as they were.
  void cancel() noexcept;

private:
  explicit Pipeline(std::unique_ptr<pipeline::Graph> graph);
  std::unique_ptr<pipeline::Graph> graph_;
};

namespace pipeline {

/// A JSON schema (draft 7) of pipeline documents with the stages of this program, for editors.
std::string jsonSchema();

/// The table of stages and their options, as Markdown.
std::string stageDocumentation();

} // namespace pipeline

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
