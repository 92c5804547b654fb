// SPDX-License-Identifier: BSD-3-Clause
// Base of the stages that ask a question about an obstacle.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_type.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/question/options.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::pipeline {

/// The options of a stage that derives from it, beside Stage; those of the question are in the core's table.
struct QuestionStage {
  OtherCloud obstacle;
  std::optional<Pose> pose;
  std::optional<InputFile> trajectory;
  Question question;

protected:
  /// For plan(): reads the trajectory, and refuses what ask() would refuse.
  /// @param input the header of the cloud whose points are asked about. @param stage that warns
  /// @throws OptionError
  void plan(const CloudHeader& input, const Wanted& wanted, Stage& stage);

  /// A question, and its answer.
  struct AnsweredQuestion {
    io::Obstacle compared; ///< as what the obstacle is compared
    Shape input, obstacle;
    Answer answer;

    const SphereHierarchy& inputHierarchy(const Question& asked)
    {
      return input.hierarchy(asked.uncertaintyOfInput(), asked.threads);
    }
    const SphereHierarchy& obstacleHierarchy(const Question& asked)
    {
      return obstacle.hierarchy(asked.uncertaintyOfObstacle(), asked.threads);
    }
  };

  /// For run(): asks, until the stage is cancelled, and adds the warnings of the answer.
  AnsweredQuestion ask(const StageCloudPtr& input, Stage& stage) const;

  /// Whether the triangles of the input are asked about, not its points.
  bool asksAboutFaces(const StageCloud& input) const
  {
    return input.triangles && !input.triangles->empty() && !question.vertices_only;
  }

  /// For run() of a stage that knows points alone. @throws OptionError where faces are asked about
  void requirePoints(const StageCloud& input) const;
};

/// A row of the core's table as an option of a stage. @param question of a stage
Option optionOf(const QuestionOption& row, std::function<Question&(Stage&)> question);

/// An error of a question, told by the stage's option where it is about one. @throws OptionError, or the error
[[noreturn]] void refuse(const InvalidInput& error, const Question& question);

/// Adds the obstacle, where it is, and the question's options.
template <typename S>
StageDescription<S>& withQuestionOptions(StageDescription<S>& description, QuestionKind kind)
{
  description.option(&S::obstacle, "obstacle", "the cloud or mesh that the input is compared with")
      .required()
      .option(&S::pose, "pose",
              "of the obstacle in the input's frame; rigid, where a matrix of few printed digits stands for its "
              "nearest rotation; null: the frames are one");
  if (isOf(QuestionKind::collisions, kind)) {
    description.option(
        &S::trajectory, "trajectory",
        "instead of `pose`, a file of poses (12 or 16 numbers of a matrix a line, or time tx ty tz qx qy qz qw) or "
        "of waypoints: colliding at any counts");
  }
  for (const QuestionOption& row : questionOptions()) {
    if (isOf(row.kind, kind))
      description.option(optionOf(row, [](Stage& stage) -> Question& { return static_cast<S&>(stage).question; }));
  }
  return description;
}

} // namespace pcl_bsh::pipeline
