// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/graph.h>
#include <pcl_bsh/filters/pipeline/option_json.h>

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/base/counted.h>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <mutex>
#include <set>
#include <thread>

namespace pcl_bsh::pipeline {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Memory of the whole program now; 0 where the system does not tell.
std::size_t residentBytes()
{
  std::size_t total_pages = 0;
  std::size_t resident_pages = 0;
  std::ifstream("/proc/self/statm") >> total_pages >> resident_pages;
  return resident_pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// The most that was in memory so far.
std::size_t peakBytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::size_t pointsOf(const StageCloud& cloud)
{
  return std::size_t{cloud.cloud.width} * cloud.cloud.height;
}

/// Cost of a stage. Memory is the whole program's, so stages that ran at the same time share it.
struct Cost {
  std::size_t points_in = 0;
  std::size_t points_out = 0;
  double seconds = 0;
  std::size_t bytes_out = 0;
  std::size_t resident_before = 0;
  std::size_t resident_after = 0;
  bool lost_faces = false;
};

class Run {
public:
  explicit Run(const Graph& graph)
  : graph_(graph),
    stages_(planStages(graph)),
    costs_(graph.nodes.size()),
    clouds_(graph.nodes.size()),
    readers_left_(countReaders(graph)),
    inputs_left_(graph.nodes.size()),
    consumers_(graph.nodes.size()),
    errors_(graph.nodes.size())
  {
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
      for (const std::size_t input : graph.nodes[i].inputs) addEdge(input, i);
      for (const auto& cloud : graph.nodes[i].clouds) addEdge(cloud.node, i);
      if (inputs_left_[i] == 0) ready_.insert(i);
    }
  }

  PipelineResult run()
  {
    const Clock::time_point start = Clock::now();
    const std::size_t machine = std::max(std::thread::hardware_concurrency(), 1U);
    const std::size_t asked = graph_.threads != 0 ? graph_.threads : machine;
    const std::size_t threads = std::min(asked, std::max(graph_.nodes.size(), machine)); // stages, and readers of LAZ
    // By default, oneTBB has no more threads than the machine; stages that wait for files can use more.
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, std::max(threads, machine));
    tbb::task_arena arena(static_cast<int>(threads));
    arena.execute([this] {
      group_.run_and_wait([this] {
        const std::lock_guard lock(mutex_);
        addTasks(ready_.size());
      });
    });
    if (callback_error_) std::rethrow_exception(callback_error_);
    for (const std::exception_ptr& error : errors_) {
      if (error) std::rethrow_exception(error);
    }
    if (finished_ < graph_.nodes.size()) throw Cancelled();
    return resultAfter(secondsSince(start));
  }

private:
  void addEdge(std::size_t from, std::size_t to)
  {
    consumers_[from].push_back(to);
    ++inputs_left_[to];
  }

  /// One task for each stage that is ready.
  void addTasks(std::size_t count)
  {
    for (std::size_t i = 0; i < count; ++i) group_.run([this] { runLowestReady(); });
  }

  /// A task takes the lowest ready stage, whichever stage added the task. An exception must not leave it: oneTBB would
  /// cancel the parallel loops of stages that still run, and a writer among them would write a part of its result.
  void runLowestReady()
  {
    std::unique_lock lock(mutex_);
    if (isStopped()) return;
    const std::size_t node = *ready_.begin();
    ready_.erase(ready_.begin());
    try {
      runStage(node, lock);
    }
    catch (...) {
      if (!lock.owns_lock()) lock.lock();
      errors_[node] = std::current_exception();
      stopped_ = true;
    }
  }

  bool isStopped() const { return stopped_ || *graph_.cancelled; }

  /// The lock is open while the stage works.
  void runStage(std::size_t position, std::unique_lock<std::mutex>& lock)
  {
    const Node& node = graph_.nodes[position];
    StageClouds inputs = takeInputs(position);
    Cost& cost = costs_[position];
    for (const StageCloudPtr& input : inputs) {
      cost.points_in += pointsOf(*input);
      if (input->triangles) cost.lost_faces = true;
    }
    report(node, cost, false);
    if (isStopped()) return;
    lock.unlock();

    cost.resident_before = residentBytes();
    const Clock::time_point start = Clock::now();
    StageCloudPtr output;
    // While a stage waits for its own parallel loops, its thread must not begin another stage.
    tbb::this_task_arena::isolate([&] { output = outputOf(position, std::move(inputs)); });
    cost.points_out = pointsOf(*output);
    if (output->triangles) cost.lost_faces = false;
    cost.bytes_out = output->cloud.data.size();
    releaseClouds(position);
    cost.seconds = secondsSince(start);
    cost.resident_after = residentBytes();

    lock.lock();
    ++finished_;
    report(node, cost, true);
    const bool wanted = readers_left_[position] > 0 || !node.type->isWriter();
    if (wanted) clouds_[position] = std::move(output);
    const std::size_t ready_before = ready_.size();
    for (const std::size_t consumer : consumers_[position]) {
      if (--inputs_left_[consumer] == 0) ready_.insert(consumer);
    }
    addTasks(ready_.size() - ready_before);
  }

  /// Returns a stage's cloud to a reader; the last one gets the only pointer.
  StageCloudPtr take(std::size_t producer)
  {
    return --readers_left_[producer] == 0 ? std::move(clouds_[producer]) : clouds_[producer];
  }

  StageClouds takeInputs(std::size_t position)
  {
    const Node& node = graph_.nodes[position];
    StageClouds inputs;
    for (const std::size_t input : node.inputs) inputs.push_back(take(input));
    for (const CloudOfOption& one : node.clouds) cloudOf(position, one)->cloud = take(one.node);
    return inputs;
  }

  void releaseClouds(std::size_t position)
  {
    const Node& node = graph_.nodes[position];
    for (const CloudOfOption& one : node.clouds) cloudOf(position, one)->cloud.reset();
  }

  OtherCloud* cloudOf(std::size_t position, const CloudOfOption& one) const
  {
    return graph_.nodes[position].type->options[one.option].cloud(*stages_[position], one.row);
  }

  StageCloudPtr outputOf(std::size_t position, StageClouds&& inputs)
  {
    const Node& node = graph_.nodes[position];
    if (node.given) return node.given;
    try {
      stages_[position]->watch(graph_.cancelled.get());
      StageCloudPtr output = stages_[position]->run(std::move(inputs));
      if (!output) throw std::logic_error("gave no cloud: let its run() return one");
      return output;
    }
    catch (const OptionError& error) {
      throw stageError(graph_, node, error.option(), error.what());
    }
    catch (const Cancelled&) {
      throw;
    }
    catch (const std::bad_alloc&) {
      throw stageError(graph_, node, "", "there is too little memory: give smaller clouds or a larger machine");
    }
    catch (const std::exception& error) {
      throw stageError(graph_, node, "", error.what());
    }
  }

  /// run() rethrows in its own thread what the callback throws in any thread.
  void report(const Node& node, const Cost& cost, bool done)
  {
    if (!graph_.progress || callback_error_) return;
    StageProgress progress;
    progress.tag = node.tag;
    progress.type = node.type->name;
    progress.done = done;
    progress.points = cost.points_out;
    progress.seconds = cost.seconds;
    progress.finished = finished_;
    progress.stages = graph_.nodes.size();
    try {
      graph_.progress(progress);
    }
    catch (...) {
      callback_error_ = std::current_exception();
      stopped_ = true;
    }
  }

  static bool asksWhatIsSeen(const Node& node)
  {
    const std::vector<Option>& options = node.type->options;
    const auto seen = std::find_if(options.begin(), options.end(), [](const Option& o) { return o.name == "seen"; });
    if (seen == options.end()) return false;
    const bool* const is_asked = std::get_if<bool>(&node.options[static_cast<std::size_t>(seen - options.begin())]);
    return is_asked && *is_asked;
  }

  /// Warns of points that stages before this one removed, as their beams are lost for `seen`.
  void addLostBeams(const Node& node, std::vector<std::string>& warnings) const
  {
    std::set<std::size_t> before;
    for (std::vector<std::size_t> open = node.inputs; !open.empty();) {
      const std::size_t i = open.back();
      open.pop_back();
      if (before.insert(i).second)
        open.insert(open.end(), graph_.nodes[i].inputs.begin(), graph_.nodes[i].inputs.end());
    }
    for (const std::size_t i : before) {
      const Cost& cost = costs_[i];
      if (cost.points_out >= cost.points_in) continue;
      warnings.push_back("`seen` is asked of beams, and " + graph_.nodes[i].tag + " removed " +
                         counted(cost.points_in - cost.points_out, "point") +
                         " with theirs: what these beams passed through is unseen: ask before points are removed");
    }
  }

  PipelineResult resultAfter(double seconds)
  {
    PipelineResult result;
    Json stages = Json::array();
    for (std::size_t i = 0; i < graph_.nodes.size(); ++i) {
      const Node& node = graph_.nodes[i];
      if (clouds_[i]) result.clouds.emplace(node.tag, std::move(clouds_[i]));
      std::vector<std::string> warnings = node.warnings;
      if (stages_[i]) warnings.insert(warnings.end(), stages_[i]->warnings().begin(), stages_[i]->warnings().end());
      if (costs_[i].lost_faces) warnings.emplace_back("does not keep the faces of its input: points alone go on");
      if (asksWhatIsSeen(node)) addLostBeams(node, warnings);
      for (const std::string& warning : warnings) result.warnings.push_back(node.tag + ": " + warning);
      stages.push_back({{"tag", node.tag},
                        {"type", node.type->name},
                        {"points_in", costs_[i].points_in},
                        {"points_out", costs_[i].points_out},
                        {"seconds", costs_[i].seconds},
                        {"bytes_out", costs_[i].bytes_out},
                        {"resident_bytes_before", costs_[i].resident_before},
                        {"resident_bytes_after", costs_[i].resident_after},
                        {"warnings", warnings}});
    }
    Json metadata = documentOf(graph_);
    metadata["metadata"] = {
        {"document", graph_.name}, {"seconds", seconds}, {"peak_bytes", peakBytes()}, {"stages", stages}};
    result.metadata = io::printed(metadata);
    return result;
  }

  const Graph& graph_;
  const std::vector<std::unique_ptr<Stage>> stages_;
  std::vector<Cost> costs_;

  std::mutex mutex_;   ///< of all below
  StageClouds clouds_; ///< of each node, from when it is done until its last reader begins
  std::vector<std::size_t> readers_left_;
  std::vector<std::size_t> inputs_left_; ///< that are not done yet
  std::vector<std::vector<std::size_t>> consumers_;
  std::set<std::size_t> ready_;
  std::size_t finished_ = 0;
  std::vector<std::exception_ptr> errors_; ///< of each node
  std::exception_ptr callback_error_;
  bool stopped_ = false; ///< something was thrown: no more stages begin

  tbb::task_group group_;
};

} // namespace

PipelineResult runGraph(const Graph& graph)
{
  if (graph.cancelled->exchange(false)) throw Cancelled();
  struct RequestEnds { // a request to cancel ends with this run, however the run ends
    ~RequestEnds() { cancelled = false; }
    std::atomic<bool>& cancelled;
  };
  Run run(graph);
  const RequestEnds request_ends{*graph.cancelled};
  return run.run();
}

Json documentOf(const Graph& graph)
{
  Json stages = Json::array();
  for (const Node& node : graph.nodes) {
    if (!node.in_document) continue;
    Json stage = {{"type", node.type->name}, {"tag", node.tag}};
    Json inputs = Json::array();
    for (const std::size_t input : node.inputs) inputs.push_back(graph.nodes[input].tag);
    if (!node.type->isReader()) stage["inputs"] = inputs;
    for (std::size_t i = 0; i < node.options.size(); ++i) {
      stage[node.type->options[i].name] = jsonOf(node.options[i], node.type->options[i]);
    }
    if (!node.user_data.is_null()) stage["user_data"] = node.user_data;
    stages.push_back(std::move(stage));
  }
  Json document = {{"pipeline", std::move(stages)}};
  if (!graph.user_data.is_null()) document["user_data"] = graph.user_data;
  return document;
}

} // namespace pcl_bsh::pipeline
