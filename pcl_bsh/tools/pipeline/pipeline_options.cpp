// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline_options.h"

#include <pcl_bsh/tools/cli/command_line.h>

namespace pcl_bsh::cli {
namespace {

constexpr auto pipeline_footer =
    R"(PIPELINE.json is written in PDAL's grammar: {"pipeline": ["in.pcd", {"type": ...}, "out.pcd"]}.
--print-stages lists the stages and their options; --print-schema lets editors complete and check them.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: thin a scan, flag what is within 5 cm of a robot; then the same with other cubes.
  pcl_bsh_pipeline flag.json
  pcl_bsh_pipeline flag.json --stage.thin.leaf_size=0.1 --stage.robot.filename=other.pcd)";

/// --stage.TAG.OPTION=VALUE, or nothing when the argument is another one.
std::optional<OptionOverride> parseOverride(const std::string& argument)
{
  const std::string begin = "--stage.";
  if (argument.rfind(begin, 0) != 0) return std::nullopt;
  const std::size_t equals = argument.find('=');
  const std::size_t dot = argument.find('.', begin.size());
  if (dot == std::string::npos || equals == std::string::npos || dot > equals || dot == begin.size() ||
      dot + 1 == equals) {
    throw UsageError(argument + ": is not understood: write --stage.TAG.OPTION=VALUE");
  }
  return OptionOverride{argument.substr(begin.size(), dot - begin.size()), argument.substr(dot + 1, equals - dot - 1),
                        argument.substr(equals + 1)};
}

} // namespace

std::optional<PipelineOptions> parsePipelineOptions(int argc, char** argv)
{
  PipelineOptions options;
  std::vector<std::string> others; // CLI11 wants them from last to first
  for (int i = argc - 1; i > 0; --i) {
    if (auto given = parseOverride(argv[i])) {
      options.overrides.insert(options.overrides.begin(), std::move(*given));
    }
    else {
      others.emplace_back(argv[i]);
    }
  }

  bool validate = false, schema = false, stages = false;
  CLI::App app("Runs a pipeline of point cloud filters, read from a file.", pipeline_program);
  app.footer(pipeline_footer);
  app.add_option("PIPELINE.json", options.document, "the pipeline; - is standard input")->type_name("");
  app.add_flag("--validate", validate, "only check it: options, files, and the fields their headers name");
  app.add_flag("--json", options.json, "say so as JSON, for programs; a run has --metadata -");
  app.add_option("--stage.TAG.OPTION", "VALUE instead of what the pipeline says; write it with =, as often as needed")
      ->type_name("VALUE");
  app.add_option("--metadata", options.metadata,
                 "JSON file for what ran and what it took; itself a pipeline, to run it again;\n- is standard output")
      ->type_name("FILE");
  addThreads(app, options.threads,
             "stages at a time, and readers of a .laz; 0: as many as the machine has threads (default)");
  app.add_flag("--progress", options.progress, "a line for each stage that is done");
  app.add_flag("--print-schema", schema, "write the JSON schema of pipelines, and end");
  app.add_flag("--print-stages", stages, "write the table of stages and their options, and end");
  const bool wanted = understood(app, pipeline_program, std::move(others), [&] {
    if (options.document.empty() && !schema && !stages) throw CLI::RequiredError("PIPELINE.json");
  });
  if (!wanted) return std::nullopt;
  if (options.json && !validate) throw UsageError("--json: goes with --validate: add it, or give --metadata - instead");
  if (schema || stages) {
    options.task = schema ? PipelineTask::print_schema : PipelineTask::print_stages;
    return options;
  }
  if (validate) options.task = PipelineTask::validate;
  return options;
}

} // namespace pcl_bsh::cli
