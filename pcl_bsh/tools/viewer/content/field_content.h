// SPDX-License-Identifier: BSD-3-Clause
// The content of a cloud's own fields, where no question is asked.
#pragma once

#include "view_content.h"

namespace pcl_bsh::viewer {

/// The scan's fields `collision`, `distance` and `first_pose`, as they are. One step, at which all stand still.
class FieldContent : public ViewContent {
public:
  std::string name() const override { return scan().name; }
  std::size_t steps() const override { return 1; }
  const char* stepName() const override { return "pose"; }
  Eigen::Isometry3d poseOf(std::size_t /*cloud*/, std::size_t /*step*/) const override
  {
    return Eigen::Isometry3d::Identity();
  }
  bool moves(std::size_t /*cloud*/) const override { return false; }
  StepCollisions collisions(std::size_t step) const override;
  MotionPaths paths(std::size_t /*step*/) const override { return {}; }
  std::vector<float> distances(std::size_t step) const override;

  /// The field's distances if it holds those of free points, too; else none. A result along a path holds only those of
  /// points that collide.
  std::vector<double> allDistances(std::size_t step) const override;
  std::vector<std::int32_t> firstPoses() const override;

protected:
  using ViewContent::ViewContent;
};

/// Counts the verdicts of the scan's parts, except free ones.
void countVerdicts(StepCollisions& found);

} // namespace pcl_bsh::viewer
