// SPDX-License-Identifier: BSD-3-Clause
// Points that may be elsewhere than they were measured: one search for what may collide, one for what does for certain.
#pragma once

#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/placed.h>

namespace pcl_bsh {

inline bool areUncertain(const Placed& a, const Placed& b)
{
  return a.hierarchy().view().isUncertain() || b.hierarchy().view().isUncertain();
}

/// What each of the two searches may spend.
inline Accuracy halfOf(Accuracy accuracy)
{
  if (accuracy.mode == Accuracy::Mode::node_pairs || accuracy.mode == Accuracy::Mode::time) accuracy.value /= 2;
  return accuracy;
}

} // namespace pcl_bsh
