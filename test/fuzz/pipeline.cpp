// SPDX-License-Identifier: BSD-3-Clause
// Any text as a pipeline: it is refused with a reason, or runs on small clouds to a result or a reason. An accepted
// text, written out again, is accepted again.
#include "target.h"

#include <pcl_bsh/filters/pipeline/graph.h>
#include <pcl_bsh/io/clouds/records.h>

#include <cmath>
#include <string_view>

namespace {

using namespace pcl_bsh;
using namespace pcl_bsh::pipeline;

/// A few points on a spiral, one of them not finite, with an intensity.
StageCloudPtr smallCloud()
{
  auto cloud = std::make_shared<StageCloud>();
  for (const char* name : {"x", "y", "z", "intensity"}) io::addField(cloud->cloud, name, pcl::PCLPointField::FLOAT32);
  io::allocate(cloud->cloud, 40);
  for (std::size_t i = 0; i < 40; ++i) {
    const auto t = static_cast<float>(i);
    const float values[] = {std::cos(t), std::sin(t), i == 7 ? std::nanf("") : t / 10, t};
    std::memcpy(&cloud->cloud.data[i * cloud->cloud.point_step], values, sizeof values);
  }
  cloud->cloud.is_dense = false;
  return cloud;
}

/// A valid document may still take hours, or touch files.
bool isHarmless(const Graph& graph)
{
  if (graph.nodes.size() > 20) return false;
  for (const Node& node : graph.nodes) {
    if (node.type->isWriter()) return false;
    for (std::size_t i = 0; i < node.options.size(); ++i) {
      const bool threads = node.type->options[i].name == "number_of_threads";
      const auto* number = std::get_if<std::int64_t>(&node.options[i]);
      if (threads && number != nullptr && *number > 4) return false;
    }
  }
  return true;
}

void requireReason(const PipelineError& error)
{
  const std::string_view line = error.what();
  fuzz::require(line.size() > 10 && line.find('\n') == std::string_view::npos,
                "a refusal without a reason of one line");
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  try {
    Graph graph = parseGraph(std::string_view(reinterpret_cast<const char*>(data), size), {}, "fuzzed");
    const Json document = documentOf(graph);
    fuzz::require(documentOf(parseGraph(io::printed(document), {}, "again")) == document,
                  "another pipeline when read again");
    if (!isHarmless(graph)) return 0;
    static const StageCloudPtr cloud = smallCloud();
    for (Node& node : graph.nodes) {
      if (node.type->isReader()) node.given = cloud;
    }
    graph.threads = 1;
    for (const auto& [tag, output] : runGraph(graph).clouds) {
      const pcl::PCLPointCloud2& points = output->cloud;
      fuzz::require(std::uint64_t{points.width} * points.height * points.point_step == points.data.size(),
                    "width x height records do not fill the data");
    }
  }
  catch (const PipelineError& error) {
    requireReason(error);
  }
  return 0;
}
