// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/graph.h>

namespace pcl_bsh::pipeline {

std::vector<std::size_t> countReaders(const Graph& graph)
{
  std::vector<std::size_t> readers(graph.nodes.size(), 0);
  for (const Node& node : graph.nodes) {
    for (const std::size_t input : node.inputs) ++readers[input];
    for (const auto& cloud : node.clouds) ++readers[cloud.node];
  }
  return readers;
}

PipelineError stageError(const Graph& graph, const Node& node, const std::string& option, const std::string& wrong)
{
  return PipelineError(graph.name + ": " + node.tag + ": " + node.path + (option.empty() ? "" : "/" + option) + ": " +
                       wrong);
}

} // namespace pcl_bsh::pipeline
