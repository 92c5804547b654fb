// SPDX-License-Identifier: BSD-3-Clause
// Changes that must not change an answer: axes exchanged and reversed, all lengths times a power of two, another order
// of records, a and b exchanged, a cloud split in two, points doubled. Also turns and shifts by exact numbers of
// everything or of one cloud's own frame, and a path reversed or its poses repeated.
#pragma once

#include "answers.h"
#include "instance.h"

namespace pcl_bsh::symmetries {

/// Asks everything about the instance, and about what each symmetry makes of it.
/// @param random which axes, powers, orders
/// @param ask whom
/// @return how many symmetries were compared: those that rounding would break are left out
/// @throws fuzz::Finding that names the instance, the symmetry and the first answer that differs
std::size_t requireSymmetric(const Instance& instance, test::Random& random, const Ask& ask = answersOf);

} // namespace pcl_bsh::symmetries
