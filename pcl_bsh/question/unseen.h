// SPDX-License-Identifier: BSD-3-Clause
// How much of an obstacle lies where nobody saw, at each of its poses in a scan.
#pragma once

#include <pcl_bsh/question/ask.h>

namespace pcl_bsh {

/// Finds the unseen records of the obstacle at each pose of the question. A record that collides there is not unseen.
/// @param answer gets `unseen`, `obstacle_flags`, and the work
/// @throws InvalidInput as scansOf() and SeenSpace do. Cancelled
void lookAround(const Question& question, Shape& input, Shape& obstacle, Answer& answer);

} // namespace pcl_bsh
