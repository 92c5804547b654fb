// SPDX-License-Identifier: BSD-3-Clause
// A pose from pairs of places: where points of a body were found in a scan.
//
// The rotation and the translation with the least sum of squared residuals (Horn, Closed-form solution of absolute
// orientation using unit quaternions, 1987; Umeyama, Least-squares estimation of transformation parameters between two
// point patterns, 1991), without scale.
#pragma once

#include <pcl_bsh/io/text/length_unit.h>

#include <Eigen/Geometry>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// A place on the body, and where it is in the scan.
struct PlacePair {
  Eigen::Vector3d body, scan;
};

struct PoseFit {
  Eigen::Isometry3d pose;        ///< T_scan_body
  std::vector<double> residuals; ///< of each pair: from the body's place at the pose to the scan's

  std::string text() const; ///< one line of how well it fits
};

/// Fits a pose. Places on one line do not determine the turn about this line. Places count as on one line if they
/// differ from it by no more than a thousandth of their length, or than the fit's residuals.
/// @throws FormatError for less than three pairs, for places on one line, and where one side is twice the other's size
PoseFit fitPose(const std::vector<PlacePair>& pairs);

/// A pair a line: x y z of the body, then x y z of the scan. A '#' begins a comment. @throws FormatError naming the
/// line
std::vector<PlacePair> parsePairs(std::string_view text);

/// Fits the pairs of a file. @param scale from the body's lengths in the file to those of the scan
/// @throws files::FileError naming it
PoseFit readPoseFit(const std::filesystem::path& path, const LengthScale& scale = {});

} // namespace pcl_bsh::io
