// SPDX-License-Identifier: BSD-3-Clause
// Runs a pipeline of point cloud filters, read from a JSON file.
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/pipeline/pipeline_options.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <iostream>
#include <optional>

namespace {

using namespace pcl_bsh;
using cli::PipelineTask;

void validate(const cli::PipelineOptions& options)
{
  cli::checkTold(options.json, {{"pipeline", options.name()}, {"valid", false}},
                 [&] { Pipeline::read(options.document, options.overrides).validate(); });
  if (options.json)
    cli::writeJson(std::cout, {{"pipeline", options.name()}, {"valid", true}});
  else
    std::cout << options.name() << " is valid\n";
}

/// A line per stage on stderr, as PCL's tools write them.
void printProgress(const StageProgress& stage)
{
  if (!stage.done) return;
  std::cerr << "> [" << stage.finished << "/" << stage.stages << "] " << stage.tag << ": " << stage.type << " [done, "
            << static_cast<long>(stage.seconds * 1000) << " ms : " << counted(stage.points, "point") << "]\n";
}

/// Progress and warnings go to stderr, and metadata to the file that the options name.
void runStages(Pipeline& pipeline, const cli::PipelineOptions& options)
{
  if (!options.metadata.empty()) {
    pipeline.reserve("--metadata", options.metadata);
    files::requireWritable(options.metadata);
  }
  std::size_t stages = 0;
  pipeline.setProgress([&](const StageProgress& stage) {
    stages = stage.stages;
    if (options.progress) printProgress(stage);
  });

  std::optional<cli::Step> step; // with a line per stage, it would be printed twice
  if (!options.progress) step.emplace("Running " + options.name());
  const PipelineResult result = pipeline.run();
  if (step) step->done(counted(stages, "stage"));

  cli::warn(cli::pipeline_program, result.warnings);
  if (options.metadata.empty()) return;
  files::replaceFile(options.metadata, [&](std::ostream& out) { out << result.metadata; });
}

int run(const cli::PipelineOptions& options)
{
  if (options.task == PipelineTask::print_schema) {
    std::cout << pipeline::jsonSchema();
    return 0;
  }
  if (options.task == PipelineTask::print_stages) {
    std::cout << pipeline::stageDocumentation();
    return 0;
  }
  if (options.task == PipelineTask::validate) {
    validate(options);
    return 0;
  }
  Pipeline pipeline = Pipeline::read(options.document, options.overrides);
  pipeline.setNumberOfThreads(options.threads);
  runStages(pipeline, options);
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(cli::pipeline_program, cli::parsePipelineOptions, run, argc, argv);
}
