// SPDX-License-Identifier: BSD-3-Clause
// The smallest balls of triangles, eight at once.
#pragma once

#include <cstddef>

namespace pcl_bsh {

inline constexpr std::size_t kBallsTogether = 8;

/// Corners of eight triangles, and their balls: bit for bit what triangles_view.cpp makes of each by itself.
struct EightBalls {
  double corners[3][3][kBallsTogether]; ///< corner, axis, triangle
  double centers[3][kBallsTogether];    ///< rounded to coordinates
  float radii[kBallsTogether];          ///< NaN where the triangle has to be looked at by itself
  double largest = 0.0;                 ///< largest coordinate of the other triangles
};

/// @param to_float whether coordinates are float32
void findEightBalls(EightBalls& balls, bool to_float);

} // namespace pcl_bsh
