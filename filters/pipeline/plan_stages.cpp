// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/graph.h>
#include <pcl_bsh/io/files/used_files.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::pipeline {
namespace {

namespace fs = std::filesystem;

using Headers = std::vector<CloudHeader>;

/// A stage with its options set. Clouds that options name are given by their headers only.
std::unique_ptr<Stage> makeStage(const Node& node, const Headers& headers)
{
  std::unique_ptr<Stage> stage = node.type->make();
  for (std::size_t i = 0; i < node.options.size(); ++i) node.type->options[i].set(*stage, node.options[i]);
  for (const CloudOfOption& one : node.clouds)
    node.type->options[one.option].cloud(*stage, one.row)->header = headers[one.node];
  return stage;
}

/// The files of a pipeline, and whose they are.
struct PipelineFiles {
  std::vector<files::UsedFile> used;
  std::vector<std::pair<const Node*, std::string>> owners; ///< stage and option of each file of a stage

  void add(const Node& node, const std::string& option, const fs::path& path, files::Use use, std::string replaces = {})
  {
    used.push_back({node.tag + "." + option, path, use, std::move(replaces)});
    owners.emplace_back(&node, option);
  }
};

PipelineFiles filesOf(const Graph& graph)
{
  PipelineFiles all;
  for (const Node& node : graph.nodes) {
    std::string replaceable;
    const auto addAll = [&](Kind kind, files::Use use) {
      const auto addOne = [&](const Option& option, const Value& value, const std::string& name) {
        const auto* const file = std::get_if<std::string>(&value);
        if (option.kind != kind || !file) return;
        all.add(node, name, *file, use, use == files::Use::written ? replaceable : "");
        if (option.replaceable) replaceable = all.used.back().name;
      };
      for (std::size_t i = 0; i < node.options.size(); ++i) {
        const Option& option = node.type->options[i];
        addOne(option, node.options[i], option.name);
        if (option.kind != Kind::rows) continue;
        const auto& rows = std::get<std::vector<Row>>(node.options[i]);
        for (std::size_t row = 0; row < rows.size(); ++row)
          for (std::size_t k = 0; k < option.of_rows.size(); ++k)
            addOne(option.of_rows[k], rows[row].values[k],
                   option.name + '/' + std::to_string(row) + '/' + option.of_rows[k].name);
      }
    };
    if (!node.given) addAll(Kind::input_file, files::Use::read);
    for (const auto& [option, file] : node.pose_files) all.add(node, option, file, files::Use::read);
    addAll(Kind::output_file, files::Use::written);
  }
  all.used.insert(all.used.end(), graph.other_files.begin(), graph.other_files.end());
  return all;
}

/// Refuses two stages that write one file, or one that writes what another reads: they would race, or leave the user
/// without his scan.
void requireFilesApart(const Graph& graph)
{
  const PipelineFiles all = filesOf(graph);
  const auto clash = files::findClash(all.used);
  if (!clash) return;
  if (clash->file < all.owners.size()) {
    const auto& [node, option] = all.owners[clash->file];
    throw stageError(graph, *node, option, clash->wrong);
  }
  const files::UsedFile& file = all.used[clash->file];
  throw PipelineError(graph.name + ": " + file.name + ": " + file.path.string() + ": " + clash->wrong);
}

} // namespace

std::vector<std::unique_ptr<Stage>> planStages(const Graph& graph)
{
  requireFilesApart(graph);
  std::vector<std::unique_ptr<Stage>> stages;
  Headers headers;
  for (const Node& node : graph.nodes) {
    try {
      if (node.given) {
        stages.push_back(nullptr);
        headers.push_back(emptyLike(*node.given)->cloud);
        continue;
      }
      Headers inputs;
      for (const std::size_t input : node.inputs) inputs.push_back(headers[input]);
      stages.push_back(makeStage(node, headers));
      headers.push_back(stages.back()->plan(inputs));
      headers.back().width = headers.back().height = headers.back().row_step = 0;
    }
    catch (const OptionError& error) {
      throw stageError(graph, node, error.option(), error.what());
    }
    catch (const std::exception& error) {
      throw stageError(graph, node, "", error.what());
    }
  }
  return stages;
}

} // namespace pcl_bsh::pipeline
