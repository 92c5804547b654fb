// SPDX-License-Identifier: BSD-3-Clause
// Runs a pipeline of point cloud filters, read from a JSON file.
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/pipeline/pipeline_options.h>
#include <pcl_bsh/tools/pipeline/run.h>

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
  cli::runPipeline(cli::pipeline_program, pipeline, options);
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(cli::pipeline_program, [&] {
    const std::optional<cli::PipelineOptions> options = cli::parsePipelineOptions(argc, argv);
    return options ? run(*options) : 0;
  });
}
