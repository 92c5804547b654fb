// SPDX-License-Identifier: BSD-3-Clause
// Writes the findings of a walk through one voxel into the flags of a cloud's records.
#pragma once

#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/result.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace pcl_bsh {

/// A walk's finding about one point.
enum class Finding : std::uint8_t {
  colliding, ///< a point may be told this more than once
  possible,  ///< where points are uncertain: it may collide; colliding may follow
  free,      ///< only told by walks that may stop early
  left       ///< undecided by this walk
};

/// Writes the findings of one voxel's points.
class FlagWriter {
public:
  /// @param flags of all records. @param marked whether all points of the voxel were undecided at first; else they were
  ///   free
  FlagWriter(const SphereHierarchy::Storage& cloud, std::uint32_t voxel, Verdict* flags, bool marked)
  : cloud_(cloud),
    voxel_(voxel),
    flags_(flags),
    marked_(marked)
  {
  }

  /// Writes one finding for some points. @param first, last their records
  void tell(Finding finding, const std::uint32_t* first, const std::uint32_t* last)
  {
    each(finding, [=](const auto& take) { std::for_each(first, last, take); });
  }

  /// Writes one finding for all points of the voxel. The voxel need not be built.
  void tellAll(Finding finding)
  {
    each(finding, [this](const auto& take) { cloud_.forEachRecord(voxel_, take); });
  }

  std::size_t colliding = 0; ///< points that were not flagged so before

private:
  /// @param visit calls a function for each record
  template <class Visit>
  void each(Finding finding, const Visit& visit)
  {
    if (finding == Finding::colliding) {
      visit([this](std::uint32_t record) {
        colliding += flags_[record] != Verdict::colliding;
        flags_[record] = Verdict::colliding;
      });
    }
    else if (finding == Finding::possible) {
      visit([this](std::uint32_t record) {
        if (flags_[record] != Verdict::colliding) flags_[record] = Verdict::undecided;
      });
    }
    else if ((finding == Finding::free) == marked_) {
      const Verdict flag = marked_ ? Verdict::free : Verdict::undecided;
      visit([this, flag](std::uint32_t record) { flags_[record] = flag; });
    }
  }

  const SphereHierarchy::Storage& cloud_;
  const std::uint32_t voxel_;
  Verdict* const flags_;
  const bool marked_;
};

} // namespace pcl_bsh
