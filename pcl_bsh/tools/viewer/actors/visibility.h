// SPDX-License-Identifier: BSD-3-Clause
// The share of a picture's marks that other things do not hide.
#pragma once

#include <Eigen/Geometry>
#include <vtkPolyData.h>

#include <functional>
#include <span>
#include <vector>

namespace pcl_bsh::viewer {

/// Returns places of a drawing, about evenly: points or, for triangles, places all over them, about `step` from the
/// next. Returns a few hundred thousand at most: where there are more, every n-th.
/// @param left_out places in the world that are not drawn; null: none
std::vector<Eigen::Vector3d> placesOf(vtkPolyData& drawn, const Eigen::Isometry3d& pose, double step,
                                      const std::function<bool(const Eigen::Vector3d&)>& left_out = nullptr);

/// The place and the direction from which a picture is taken.
struct Gaze {
  Eigen::Vector3d at;            ///< in the world
  Eigen::Vector3d toward;        ///< of length 1, from what is seen to the eye
  Eigen::Vector3d right, up;     ///< of length 1, in the picture
  double wide = 1.0, tall = 1.0; ///< half the picture's sides at a distance of 1
};

/// A thing in a picture.
struct Drawn {
  std::vector<Eigen::Vector3d> places; ///< of all of it
  std::vector<Eigen::Vector3d> marks;  ///< places that stand out; empty: none
};

/// Returns the share of all marks that are in the picture with nothing before them, in [0, 1]; about, for the picture
/// is cut into cells. A thing hides its own marks where it is in front of them by more than some cells. 0 without a
/// mark.
double shareSeen(const Gaze& gaze, std::span<const Drawn> things);

} // namespace pcl_bsh::viewer
