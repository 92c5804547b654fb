// SPDX-License-Identifier: BSD-3-Clause
// Runs a pipeline of point cloud filters, read from a JSON file.
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/filters/pipeline/pipeline.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace pcl_bsh;

constexpr auto program = "pcl_bsh_pipeline";
constexpr auto footer =
    R"(PIPELINE.json is written in PDAL's grammar: {"pipeline": ["in.pcd", {"type": ...}, "out.pcd"]}.
--print-stages lists the stages and their options; --print-schema lets editors complete and check them.
Exit code: 0 done; 1 failed; 2 command line not understood; 130 stopped by Ctrl-C.

Example: thin a scan, flag what is within 5 cm of a robot; then the same with other cubes.
  pcl_bsh_pipeline flag.json
  pcl_bsh_pipeline flag.json --stage.thin.leaf_size=0.1 --stage.robot.filename=other.pcd)";

enum class Task { run, validate, print_schema, print_stages };

struct Options {
  std::filesystem::path document;
  Task task = Task::run;
  std::vector<OptionOverride> overrides;
  std::filesystem::path metadata; ///< empty: none
  unsigned threads = 0;
  bool progress = false;
  bool json = false; ///< the result of --validate is told as JSON

  /// The name of the document in messages.
  std::string name() const { return document == "-" ? "standard input" : document.string(); }
};

void validate(const Options& options)
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
void runStages(Pipeline& pipeline, const Options& options)
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

  cli::warn(program, result.warnings);
  if (options.metadata.empty()) return;
  files::replaceFile(options.metadata, [&](std::ostream& out) { out << result.metadata; });
}

int run(const Options& options)
{
  if (options.task == Task::print_schema) {
    std::cout << pipeline::jsonSchema();
    return 0;
  }
  if (options.task == Task::print_stages) {
    std::cout << pipeline::stageDocumentation();
    return 0;
  }
  if (options.task == Task::validate) {
    validate(options);
    return 0;
  }
  Pipeline pipeline = Pipeline::read(options.document, options.overrides);
  pipeline.setNumberOfThreads(options.threads);
  runStages(pipeline, options);
  return 0;
}

/// --stage.TAG.OPTION=VALUE, or nothing when the argument is another one.
std::optional<OptionOverride> parseOverride(const std::string& argument)
{
  const std::string begin = "--stage.";
  if (argument.rfind(begin, 0) != 0) return std::nullopt;
  const std::size_t equals = argument.find('=');
  const std::size_t dot = argument.find('.', begin.size());
  if (dot == std::string::npos || equals == std::string::npos || dot > equals || dot == begin.size() ||
      dot + 1 == equals) {
    throw cli::UsageError(argument + ": is not understood: write --stage.TAG.OPTION=VALUE");
  }
  return OptionOverride{argument.substr(begin.size(), dot - begin.size()), argument.substr(dot + 1, equals - dot - 1),
                        argument.substr(equals + 1)};
}

/// The options, checked; none when only help was asked for. @throws UsageError
std::optional<Options> parse(int argc, char** argv)
{
  Options options;
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
  CLI::App app("Runs a pipeline of point cloud filters, read from a file.", program);
  app.footer(footer);
  app.add_option("PIPELINE.json", options.document, "the pipeline; - is standard input")->type_name("");
  app.add_flag("--validate", validate, "only check it: options, files, and the fields their headers name");
  app.add_flag("--json", options.json, "say so as JSON, for programs; a run has --metadata -");
  app.add_option("--stage.TAG.OPTION", "VALUE instead of what the pipeline says; write it with =, as often as needed")
      ->type_name("VALUE");
  app.add_option("--metadata", options.metadata,
                 "JSON file for what ran and what it took; itself a pipeline, to run it again;\n- is standard output")
      ->type_name("FILE");
  cli::addThreads(app, options.threads,
                  "stages at a time, and readers of a .laz; 0: as many as the machine has threads (default)");
  app.add_flag("--progress", options.progress, "a line for each stage that is done");
  app.add_flag("--print-schema", schema, "write the JSON schema of pipelines, and end");
  app.add_flag("--print-stages", stages, "write the table of stages and their options, and end");
  const bool wanted = cli::understood(app, program, std::move(others), [&] {
    if (options.document.empty() && !schema && !stages) throw CLI::RequiredError("PIPELINE.json");
  });
  if (!wanted) return std::nullopt;
  if (options.json && !validate)
    throw cli::UsageError("--json: goes with --validate: add it, or give --metadata - instead");
  if (schema || stages) {
    options.task = schema ? Task::print_schema : Task::print_stages;
    return options;
  }
  if (validate) options.task = Task::validate;
  return options;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, parse, run, argc, argv);
}
