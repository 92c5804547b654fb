// SPDX-License-Identifier: BSD-3-Clause
// The error for wrong input: a sentence for people and a code for programs.
//
//   catch (const InvalidInput& error) {
//     if (error.input() == Input::clearance) ask_again("clearance", error.wrong(), error.remedy());
//   }
#pragma once

#include <pcl_bsh/export.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The part of the input that is wrong.
enum class Input : std::uint8_t {
  points, ///< a view or a cloud: its data, its number of points, its type, its subset
  index,  ///< of a point, outside its cloud
  radius, ///< of a point or of a search
  uncertainty,
  density,   ///< spacings of a surface's patches
  box,       ///< of a search
  neighbors, ///< how many a search is to find
  voxel_edge,
  growth, ///< of a refit
  clearance,
  accuracy,
  pose,       ///< of a cloud, or one of a trajectory or of waypoints
  trajectory, ///< too many poses
  swept,      ///< the tolerance of swept motion
  pivot,      ///< of swept motion
  summaries,  ///< of poses, next to swept motion
  cluster_distance,
  result,       ///< of another query than is asked for
  motion,       ///< of a scene's object, or one of many
  scene,        ///< its options, objects, parts or rules
  max_distance, ///< of points' distances
  surface,      ///< its triangles, or the tolerance of its cover
  beyond,       ///< the distance beyond which points count as far
  seen,         ///< scans, their origins, the angle of their beams
};

/// Thrown by the core wherever its declarations say std::invalid_argument.
/// what() reads `subject: what is wrong: what to do`; the last part is absent where the first two say it.
class InvalidInput : public std::invalid_argument {
public:
  /// `remedy` may be empty, where the other two say it.
  InvalidInput(Input input, const std::string& subject, std::string wrong, std::string remedy = {})
  : std::invalid_argument(subject + ": " + wrong + (remedy.empty() ? "" : ": " + remedy)),
    input_(input),
    wrong_(std::move(wrong)),
    remedy_(std::move(remedy))
  {
  }

  Input input() const noexcept { return input_; }                ///< which part of the input
  const std::string& wrong() const noexcept { return wrong_; }   ///< with the value, as text
  const std::string& remedy() const noexcept { return remedy_; } ///< may be empty

  /// `what is wrong: what to do`, for a subject that the reader knows by another name.
  std::string advice() const { return remedy_.empty() ? wrong_ : wrong_ + ": " + remedy_; }

  /// The offending number, where it is one.
  const std::optional<double>& value() const noexcept { return value_; }

  /// Which one of several (poses, points, waypoints) is wrong, from 0.
  const std::optional<std::size_t>& index() const noexcept { return index_; }

  InvalidInput& withValue(double value)
  {
    value_ = value;
    return *this;
  }
  InvalidInput& withIndex(std::size_t index)
  {
    index_ = index;
    return *this;
  }

private:
  Input input_;
  std::string wrong_;
  std::string remedy_;
  std::optional<double> value_;
  std::optional<std::size_t> index_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
