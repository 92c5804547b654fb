// SPDX-License-Identifier: BSD-3-Clause
// Runs a pipeline and tells how it goes.
#pragma once

#include "pipeline_options.h"
#include "program.h"
#include "step.h"

#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/filters/pipeline/pipeline.h>

#include <iostream>
#include <string>

namespace pcl_bsh::cli {

/// A line per stage on stderr, as PCL's tools write them.
inline void tellProgress(const StageProgress& stage)
{
  if (!stage.done) return;
  std::cerr << "> [" << stage.finished << "/" << stage.stages << "] " << stage.tag << ": " << stage.type << " [done, "
            << static_cast<long>(stage.seconds * 1000) << " ms : " << stage.points << " points]\n";
}

inline void runPipeline(const char* program, Pipeline& pipeline, const PipelineOptions& options)
{
  if (!options.metadata.empty()) {
    pipeline.reserve("--metadata", options.metadata);
    files::requireWritable(options.metadata);
  }
  std::size_t stages = 0;
  pipeline.setProgress([&](const StageProgress& stage) {
    stages = stage.stages;
    if (options.progress) tellProgress(stage);
  });

  std::optional<Step> step; // with a line per stage, it would tell the same twice
  if (!options.progress) step.emplace("Running " + options.name());
  const PipelineResult result = pipeline.run();
  if (step) step->done(std::to_string(stages) + " stages");

  warn(program, result.warnings);
  if (options.metadata.empty()) return;
  files::replaceFile(options.metadata, [&](std::ostream& out) { out << result.metadata; });
}

} // namespace pcl_bsh::cli
