// SPDX-License-Identifier: BSD-3-Clause
// Runs a pipeline and reports its progress.
#pragma once

#include "pipeline_options.h"

namespace pcl_bsh::cli {

/// Runs the pipeline; progress and warnings go to stderr, and metadata to the file that the options name.
void runPipeline(const char* program, Pipeline& pipeline, const PipelineOptions& options);

} // namespace pcl_bsh::cli
