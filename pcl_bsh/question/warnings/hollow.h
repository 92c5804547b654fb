// SPDX-License-Identifier: BSD-3-Clause
// The warning that an obstacle's faces close round parts of the input which count as free.
#pragma once

#include <pcl_bsh/question/ask.h>

#include <optional>

namespace pcl_bsh {

/// Where faces of the obstacle close, no part of the input is near them, and some part is inside: `solid` is meant,
/// perhaps. A hint, by samples: parts that are few among others may be overlooked. Of voxels of the input that meet the
/// obstacle's box, 256 records at most are looked at, and 8 are samples; of a path, 16 poses. All triangles are passed
/// once, which takes some 160 instructions each; whether faces close is found out where they wind round a sample, and
/// by the second question about the obstacle. Where they are known not to, nothing is looked at.
/// @param answer of the question, but for its warnings. @param surface of the obstacle, where it has faces. @param box
///   of the obstacle, in its frame
std::optional<Warning> warningOfHollow(const Question& question, const Answer& answer, const Shape& input,
                                       const Placed& placed_input, Shape& obstacle, const SphereHierarchy& surface,
                                       const Eigen::AlignedBox3d& box);

} // namespace pcl_bsh
