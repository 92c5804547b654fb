// SPDX-License-Identifier: BSD-3-Clause
#include "run.h"

#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <iostream>
#include <optional>
#include <string>

namespace pcl_bsh::cli {
namespace {

/// A line per stage on stderr, as PCL's tools write them.
void printProgress(const StageProgress& stage)
{
  if (!stage.done) return;
  std::cerr << "> [" << stage.finished << "/" << stage.stages << "] " << stage.tag << ": " << stage.type << " [done, "
            << static_cast<long>(stage.seconds * 1000) << " ms : " << counted(stage.points, "point") << "]\n";
}

} // namespace

void runPipeline(const char* program, Pipeline& pipeline, const PipelineOptions& options)
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

  std::optional<Step> step; // with a line per stage, it would be printed twice
  if (!options.progress) step.emplace("Running " + options.name());
  const PipelineResult result = pipeline.run();
  if (step) step->done(counted(stages, "stage"));

  warn(program, result.warnings);
  if (options.metadata.empty()) return;
  files::replaceFile(options.metadata, [&](std::ostream& out) { out << result.metadata; });
}

} // namespace pcl_bsh::cli
