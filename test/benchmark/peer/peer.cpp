// SPDX-License-Identifier: BSD-3-Clause
#include "peer.h"

#include <algorithm>
#include <array>

namespace pcl_bsh::bench {

bool anyPosed(const ExistencePeer& peer, const Points& b, const RigidPose& pose, float d)
{
  constexpr std::size_t kBlock = 256;
  std::array<Point, kBlock> posed;
  for (std::size_t begin = 0; begin < b.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, b.size() - begin);
    for (std::size_t i = 0; i < count; ++i) posed[i] = pose.apply(b[begin + i]);
    if (peer.any(posed.data(), count, d)) return true;
  }
  return false;
}

} // namespace pcl_bsh::bench
