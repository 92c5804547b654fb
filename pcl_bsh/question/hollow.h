// SPDX-License-Identifier: BSD-3-Clause
// The warning that an obstacle's faces close round parts of the input which count as free.
#pragma once

#include <pcl_bsh/question/ask.h>

#include <optional>

namespace pcl_bsh {

/// Where faces of the obstacle close, no part of the input is near them, and some part is inside: `solid` is meant,
/// perhaps. A hint, by samples: parts that are few among others may be overlooked. Of voxels of the input that meet the
/// obstacle's box, 256 records at most are looked at, 16 of them are labelled, and of a path 16 poses; whether faces
/// close is found out once for a shape, and only where such records are.
/// @param answer of the question, but for its warnings. @param box of the obstacle, in its frame
std::optional<Warning> warningOfHollow(const Question& question, const Answer& answer, const Shape& input,
                                       const Placed& placed_input, Shape& obstacle, const Eigen::AlignedBox3d& box);

} // namespace pcl_bsh
