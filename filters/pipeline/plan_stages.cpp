// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/graph.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace pcl_bsh::pipeline {
namespace {

namespace fs = std::filesystem;

using Headers = std::vector<CloudHeader>;

/// A stage with its options set. Of the clouds that options name, their headers only.
std::unique_ptr<Stage> makeStage(const Node& node, const Headers& headers)
{
  std::unique_ptr<Stage> stage = node.type->make();
  for (std::size_t i = 0; i < node.options.size(); ++i) node.type->options[i].set(*stage, node.options[i]);
  for (const auto& [option, other] : node.clouds) node.type->options[option].cloud(*stage)->header = headers[other];
  return stage;
}

/// Which nodes must be done before each node begins.
std::vector<std::vector<bool>> ancestorsOf(const Graph& graph)
{
  std::vector<std::vector<bool>> ancestors;
  for (const Node& node : graph.nodes) {
    std::vector<bool> own(graph.nodes.size(), false);
    const auto add = [&](std::size_t input) {
      own[input] = true;
      for (std::size_t i = 0; i < input; ++i) own[i] = own[i] || ancestors[input][i];
    };
    for (const std::size_t input : node.inputs) add(input);
    for (const auto& cloud : node.clouds) add(cloud.second);
    ancestors.push_back(std::move(own));
  }
  return ancestors;
}

/// Two stages that write one file, or one that writes what another may not have read yet, would race.
void requireFilesApart(const Graph& graph)
{
  const auto ancestors = ancestorsOf(graph);
  std::map<fs::path, std::size_t> written;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const Node& writer = graph.nodes[i];
    for (const auto& [option, output] : writer.filesOf(Kind::output_file)) {
      const auto [other, is_new] = written.emplace(output, i);
      if (!is_new) {
        throw stageError(graph, writer, option,
                         "is what " + graph.nodes[other->second].tag + " writes, too: choose another name");
      }
      for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
        if (k == i || ancestors[i][k]) continue; // has read it by then
        for (const auto& input : graph.nodes[k].filesOf(Kind::input_file)) {
          if (input.second != output) continue;
          throw stageError(graph, writer, option,
                           "is what " + graph.nodes[k].tag + " reads, maybe later: choose another name");
        }
      }
    }
  }
}

} // namespace

std::vector<std::pair<std::string, fs::path>> Node::filesOf(Kind kind) const
{
  std::vector<std::pair<std::string, fs::path>> files;
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (type->options[i].kind != kind || !std::holds_alternative<std::string>(options[i])) continue;
    files.emplace_back(type->options[i].name, fs::weakly_canonical(std::get<std::string>(options[i])));
  }
  return files;
}

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
