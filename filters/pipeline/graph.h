// SPDX-License-Identifier: BSD-3-Clause
// A parsed document: its stages, their options, and which stage reads which.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/pipeline/pipeline.h>
#include <pcl_bsh/filters/pipeline/stage_type.h>
#include <pcl_bsh/io/files/used_files.h>
#include <pcl_bsh/io/json/json_document.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::pipeline {

using io::Json;

/// Tells, by indices, which option of a node, or which row of the option, names another cloud, and which node makes it.
struct CloudOfOption {
  std::size_t option = 0;
  std::size_t node = 0;
  std::size_t row = 0;
};

struct Node {
  const StageType* type = nullptr;
  std::string tag;
  std::string path;                ///< in the document: /pipeline/2
  std::vector<Value> options;      ///< one per option of the type
  std::vector<std::size_t> inputs; ///< nodes before this one
  std::vector<CloudOfOption> clouds;
  Json user_data;          ///< null without one
  bool in_document = true; ///< else it reads a file that another stage's option names
  std::vector<std::pair<std::string, std::filesystem::path>> pose_files; ///< option and file, read with the document
  std::vector<std::string> warnings;                                     ///< of its options, a line each
  StageCloudPtr given;                                                   ///< what a reader takes instead of its file
};

struct Graph {
  std::string name;        ///< of the document
  std::vector<Node> nodes; ///< each after those that it reads
  Json user_data;
  std::vector<files::UsedFile> other_files; ///< not of stages: the document, and what the caller will write
  unsigned threads = 0;
  std::function<void(const StageProgress&)> progress;
  std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false); ///< cancel() is pending
};

/// @throws PipelineError
PCL_BSH_EXPORT_INTERNAL Graph parseGraph(std::string_view text, const std::vector<OptionOverride>& overrides,
                                         const std::string& name);

/// For each node, how many inputs and options of others read it.
PCL_BSH_EXPORT_INTERNAL std::vector<std::size_t> countReaders(const Graph& graph);

/// An error about one stage or, when an option is given, about that. @param wrong `what is wrong: what to do`
PipelineError stageError(const Graph& graph, const Node& node, const std::string& option, const std::string& wrong);

/// Makes all stages and lets each check its options and what flows into it.
/// @return a stage per node; for a reader whose cloud is given, none
/// @throws PipelineError
std::vector<std::unique_ptr<Stage>> planStages(const Graph& graph);

/// @throws PipelineError, Cancelled, what the progress callback throws
PCL_BSH_EXPORT_INTERNAL PipelineResult runGraph(const Graph& graph);

/// The document again, with every tag and option written out.
PCL_BSH_EXPORT_INTERNAL Json documentOf(const Graph& graph);

} // namespace pcl_bsh::pipeline
