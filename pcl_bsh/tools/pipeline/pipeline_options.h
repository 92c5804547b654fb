// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_pipeline.
#pragma once

#include <pcl_bsh/filters/pipeline/pipeline.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

inline constexpr auto pipeline_program = "pcl_bsh_pipeline";

enum class PipelineTask { run, validate, print_schema, print_stages };

struct PipelineOptions {
  std::filesystem::path document;
  PipelineTask task = PipelineTask::run;
  std::vector<OptionOverride> overrides;
  std::filesystem::path metadata; ///< empty: none
  unsigned threads = 0;
  bool progress = false;
  bool json = false; ///< what validation tells

  /// The name of the document in messages.
  std::string name() const { return document == "-" ? "standard input" : document.string(); }
};

/// The options, checked; none when only help was asked for. @throws UsageError
std::optional<PipelineOptions> parsePipelineOptions(int argc, char** argv);

} // namespace pcl_bsh::cli
