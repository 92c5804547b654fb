// SPDX-License-Identifier: BSD-3-Clause
// Base of the stages that ask a question about an obstacle, or about several.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_type.h>
#include <pcl_bsh/io/clouds/meshes/mesh_parts.h>
#include <pcl_bsh/io/reports/compared_obstacles.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/question/options.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::pipeline {

/// One of several obstacles. For a member without a value, that of the question counts.
struct NamedObstacle {
  std::string name; ///< empty: the file's stem, or the tag
  OtherCloud file;
  std::optional<Pose> pose;
  std::optional<double> clearance;
  std::optional<bool> solid;
  std::optional<LengthOrField> uncertainty;
  std::optional<bool> in_parts;
  std::shared_ptr<const io::MeshParts> parts; ///< of the file, once it is planned; null: it is one obstacle
};

/// The options of a stage that derives from it, beside Stage. The question's own options are in the core's table.
struct QuestionStage {
  std::optional<OtherCloud> obstacle; ///< or there are `obstacles`
  std::vector<NamedObstacle> obstacles;
  std::optional<Pose> pose;
  std::optional<InputFile> trajectory;
  Question question;

protected:
  /// For plan(): reads the trajectory, names the obstacles, and refuses what ask() would refuse.
  /// @param input the header of the cloud whose points are asked about. @param stage that warns
  /// @throws OptionError
  void plan(const CloudHeader& input, const Wanted& wanted, Stage& stage);

  /// An obstacle whose cloud is not read yet.
  struct Asked {
    std::size_t row = 0; ///< of `obstacles`
    io::ComparedObstacle one;
    PlacedShape shape;
  };

  /// Returns the only obstacle, without a name, or all of several, each with its pose and the question about it.
  std::vector<Asked> asked(std::vector<std::string>& warnings) const;

  /// A question, and its answer.
  struct AnsweredQuestion {
    std::vector<io::ComparedObstacle> obstacles; ///< how each is compared; the only one has no name
    Shape input;
    std::vector<PlacedShape> shapes; ///< of the obstacles
    Answer answer;                   ///< of the only obstacle, or of all together

    const SphereHierarchy& inputHierarchy(const Question& asked)
    {
      return input.hierarchy(asked.uncertaintyOfInput(), asked.threads);
    }
    const SphereHierarchy& obstacleHierarchy(std::size_t i)
    {
      const Question& asked = obstacles[i].question;
      return shapes[i].shape.hierarchy(asked.uncertaintyOfObstacle(), asked.threads);
    }
  };

  /// For run(): asks, until the stage is cancelled, and adds the warnings of the answer.
  /// @param ignores_input by the name of one of several obstacles, whether it is not compared with the input
  AnsweredQuestion ask(const StageCloudPtr& input, Stage& stage,
                       const std::function<bool(const std::string&)>& ignores_input = nullptr) const;

  /// Whether the triangles of the input are asked about, not its points.
  bool asksAboutFaces(const StageCloud& input) const
  {
    return input.triangles && !input.triangles->empty() && !question.vertices_only;
  }

  /// For run() of a stage that knows points alone. @throws OptionError where faces are asked about
  void requirePoints(const StageCloud& input) const;
};

/// A row of the core's table as an option of a stage. @param question returns the question of a stage
Option optionOf(const QuestionOption& row, std::function<Question&(Stage&)> question);

/// `obstacles` of a stage.
Option optionOfObstacles(const std::function<std::vector<NamedObstacle>&(Stage&)>& obstacles);

/// Throws an error about a question again, as an error about the stage's option where it is about one. @pre within a
/// catch
/// @throws OptionError, or the error
[[noreturn]] void refuse(const InvalidInput& error, const Question& question);

/// Adds the obstacle, where it is, and the question's options.
template <typename S>
StageDescription<S>& withQuestionOptions(StageDescription<S>& description, QuestionKind kind)
{
  const bool may_be_several = kind != QuestionKind::both_ways; // whose distances are also the obstacle's
  description.option(&S::obstacle, "obstacle",
                     may_be_several ? "the cloud or mesh that the input is compared with, unless there are `obstacles`"
                                    : "the cloud or mesh that the input is compared with");
  if (may_be_several)
    description.option(optionOfObstacles(
        [](Stage& stage) -> std::vector<NamedObstacle>& { return static_cast<S&>(stage).obstacles; }));
  else
    description.required();
  description.option(
      &S::pose, "pose",
      "of the obstacle, or of the frame of all obstacles, in the input's frame; rigid, where a matrix of "
      "few printed digits stands for its nearest rotation; null: the frames are one");
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
