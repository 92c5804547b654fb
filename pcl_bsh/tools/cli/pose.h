// SPDX-License-Identifier: BSD-3-Clause
// Poses as users write them.
#pragma once

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The pose that the value of an option stands for: six numbers x,y,z,roll,pitch,yaw or the name of a file for
/// io::readPose(). A matrix with |R'R - I| from 1e-6 to 1e-4, as few printed digits leave it, stands for its nearest
/// rotation; `warnings` gets a line then, and for angles of more than two turns.
/// @throws UsageError when it is neither, files::FileError as readPose() does
Eigen::Isometry3d parsePose(const std::string& option, const std::string& text, std::vector<std::string>& warnings);

} // namespace pcl_bsh::cli
