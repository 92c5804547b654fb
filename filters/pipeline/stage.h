// SPDX-License-Identifier: BSD-3-Clause
// One step of a pipeline: what a class must do to be one. stage_type.h tells how it gets its name and options.
//
//   struct EveryNth : pcl_bsh::pipeline::Stage {
//     int step = 1;                                               // an option and its default
//     StageCloudPtr run(StageClouds&& inputs) override;           // the work
//   };
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/pipeline/stage_cloud.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::pipeline {

/// Something is wrong with one option of a stage. what() reads `what is wrong: what to do`.
class OptionError : public std::invalid_argument {
public:
  /// `wrong` reads as what() does.
  OptionError(std::string option, const std::string& wrong) : std::invalid_argument(wrong), option_(std::move(option))
  {
  }
  const std::string& option() const noexcept { return option_; } ///< its name

private:
  std::string option_;
};

/// A stage is made, has its options set, is asked for its plan, and runs once. Stages run in parallel, but each in one
/// thread; any exception ends the pipeline, with the stage's tag and place in the document before its text.
class Stage {
public:
  virtual ~Stage() = default;

  /// Returns the fields of the cloud that run() will return, from those of its inputs; no points are there yet. Refuses
  /// all that is known to fail before the first point is read.
  virtual CloudHeader plan(const std::vector<CloudHeader>& inputs)
  {
    return inputs.empty() ? CloudHeader() : inputs[0];
  }

  /// @param inputs as many as the stage's type says; never null
  /// @return never null
  virtual StageCloudPtr run(StageClouds&& inputs) = 0;

  /// Whether the pipeline was told to stop (Pipeline::cancel()). A stage that works for long should look now and then,
  /// from any thread, and throw Cancelled (pcl_bsh/base/cancelled.h).
  bool isCancelled() const noexcept { return cancelled_ != nullptr && *cancelled_; }

  /// Called by the pipeline before run().
  void watch(const std::atomic<bool>* cancelled) noexcept { cancelled_ = cancelled; }

  /// Warnings to the user about the run, a line each.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// For the stage itself, and what computes for it.
  void warn(std::string line) { warnings_.push_back(std::move(line)); }

private:
  const std::atomic<bool>* cancelled_ = nullptr;
  std::vector<std::string> warnings_;
};

} // namespace pcl_bsh::pipeline
PCL_BSH_EXPORT_END
