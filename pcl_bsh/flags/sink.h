// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace pcl_bsh {

/// What a walk finds of a point.
enum class Finding : std::uint8_t {
  colliding, ///< some points are told so more than once
  possible,  ///< where points are uncertain: it may collide; colliding may follow
  free,      ///< only told by walks that may stop early
  left       ///< undecided by this walk
};

/// Where a walk's findings of the points of one voxel go.
class FlagSink {
public:
  /// @param first, last their records
  virtual void tell(Finding finding, const std::uint32_t* first, const std::uint32_t* last) = 0;

  /// The same of all points of the voxel, which may not be built.
  virtual void tellAll(Finding finding) = 0;

protected:
  ~FlagSink() = default;
};

} // namespace pcl_bsh
