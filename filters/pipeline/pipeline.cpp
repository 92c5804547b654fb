// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/graph.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/one_line.h>
#include <pcl_bsh/io/json/nearest_name.h>
#include <pcl_bsh/io/text/file_bytes.h>

#include <utility>

namespace pcl_bsh {

PipelineError::PipelineError(std::string line) : std::runtime_error(files::oneLine(std::move(line)))
{
}

Pipeline::Pipeline(std::unique_ptr<pipeline::Graph> graph) : graph_(std::move(graph))
{
}
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;
Pipeline::~Pipeline() = default;

Pipeline Pipeline::parse(std::string_view json, const std::vector<OptionOverride>& overrides, const std::string& name)
{
  return Pipeline(std::make_unique<pipeline::Graph>(pipeline::parseGraph(json, overrides, name)));
}

Pipeline Pipeline::read(const std::filesystem::path& file, const std::vector<OptionOverride>& overrides)
{
  try {
    const io::FileBytes bytes(file);
    Pipeline pipeline = parse(bytes.view(), overrides, file == "-" ? "standard input" : file.string());
    pipeline.graph_->other_files.push_back({"the document", file, files::Use::read});
    return pipeline;
  }
  catch (const files::FileError& error) {
    throw PipelineError(error.what());
  }
}

void Pipeline::setCloud(const std::string& tag, pipeline::StageCloudPtr cloud)
{
  if (!cloud) throw PipelineError(graph_->name + ": " + tag + ": the cloud is null: give an empty one");
  std::vector<std::string> readers;
  for (pipeline::Node& node : graph_->nodes) {
    if (!node.type->isReader()) continue;
    readers.push_back(node.tag);
    if (node.tag != tag) continue;
    node.given = std::move(cloud);
    return;
  }
  throw PipelineError(graph_->name + ": no reader has the tag '" + tag + "': " + io::suggestion(tag, readers));
}

void Pipeline::reserve(const std::string& name, const std::filesystem::path& file)
{
  graph_->other_files.push_back({name, file, files::Use::written});
}

void Pipeline::setNumberOfThreads(unsigned threads)
{
  graph_->threads = threads;
}

void Pipeline::setProgress(std::function<void(const StageProgress&)> progress)
{
  graph_->progress = std::move(progress);
}

void Pipeline::validate()
{
  pipeline::planStages(*graph_);
}

PipelineResult Pipeline::run()
{
  return pipeline::runGraph(*graph_);
}

void Pipeline::cancel() noexcept
{
  *graph_->cancelled = true;
}

} // namespace pcl_bsh
