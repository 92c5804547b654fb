// SPDX-License-Identifier: BSD-3-Clause
// The options of stages whose obstacle may be a surface.
#pragma once

#include <pcl_bsh/filters/pipeline/stage_type.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/query/accuracy.h>

#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::pipeline {

/// A stage derives from it, beside Stage.
struct SurfaceOptions {
  std::optional<double> surface_tolerance;
  bool vertices_only = false;

protected:
  /// For plan(). @throws OptionError where the options do not go together
  void checkSurface() const
  {
    if (surface_tolerance && vertices_only)
      throw OptionError("surface_tolerance", "is given, but `vertices_only`, too: give one of them");
  }

  /// For run(): what the obstacle is compared as. Stops when the stage is cancelled.
  /// @param clearance, accuracy, swept of the query
  /// @param told what the user should know is appended, a line each
  io::Obstacle obstacleOf(const OtherCloud& other, double clearance, const Accuracy& accuracy, bool swept,
                          const Stage& stage, std::vector<std::string>& told) const;

  /// Whether the triangles of the input are asked about, not its points.
  bool asksAboutFaces(const StageCloud& input) const { return input.triangles && !vertices_only; }

  /// For run() of a stage that knows points alone. @throws OptionError where faces are asked about
  void requirePoints(const StageCloud& input) const;

  /// For run(): the cover of an input that is asked about, triangles apart. Stops when the stage is cancelled.
  /// @param clearance of the query. @param told as obstacleOf() has it
  std::shared_ptr<const SurfaceCover> coverOfInput(const StageCloud& input, double clearance, const Stage& stage,
                                                   std::vector<std::string>& told) const;
};

template <typename S>
StageDescription<S>& withSurfaceOptions(StageDescription<S>& description)
{
  return description
      .option(
          &S::surface_tolerance, "surface_tolerance",
          "an obstacle with faces is a surface: what is free is farther than the clearance from it for certain, what "
          "collides is within clearance + this tolerance, and the true distance is in [d, d + tolerance]; null: a "
          "tenth of the clearance, else a 10,000th of the obstacle's size. So is an input with faces, whose triangles "
          "are "
          "asked about; its tolerance comes on top")
      .unit("m")
      .above(0)
      .option(&S::vertices_only, "vertices_only", "true: meshes, the obstacle and the input, are their vertices alone");
}

} // namespace pcl_bsh::pipeline
