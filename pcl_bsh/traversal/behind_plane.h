// SPDX-License-Identifier: BSD-3-Clause
// Of nodes of one cloud: whether all of them is behind a plane, and what touches it there.
#pragma once

#include <pcl_bsh/geometry/exact/exact_plane.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <cstdint>
#include <optional>
#include <unordered_map>

namespace pcl_bsh {

/// A child of a node: what is below it.
struct NodeChild {
  std::uint32_t space; ///< of the node
  const Node& node;
  std::uint32_t lane;
};

/// Looks at each record of a node once, exactly, and remembers what it has found.
class BehindPlane {
public:
  static constexpr std::uint32_t kNoRecord = 0xffffffffu;

  /// @param plane behind it is where its normal points away from @param allowed what surely reaches beyond it by less
  /// than this counts as behind
  BehindPlane(const SphereHierarchy::Storage& cloud, const ExactPlane& plane, double allowed)
  : cloud_(cloud),
    plane_(plane),
    allowed_(allowed)
  {
  }

  /// If nothing below a child is beyond the plane: the smallest record that touches it, or kNoRecord. Nothing, too,
  /// where more records would have to be looked at than `looks`, which those that are looked at are taken from.
  std::optional<std::uint32_t> lowestTouching(const NodeChild& child, std::uint64_t& looks);

private:
  static constexpr std::uint32_t kBeyond = kNoRecord - 1;

  int sideOf(const Point3& place) const { return plane_.isWithin(place, allowed_) ? -1 : plane_.side(place); }
  int sideOf(std::uint32_t record) const; ///< of what of it reaches farthest
  std::uint32_t look(const NodeChild& child, std::uint64_t& looks) const;

  const SphereHierarchy::Storage& cloud_;
  const ExactPlane plane_;
  const double allowed_;
  std::unordered_map<std::uint64_t, std::uint32_t> found_; ///< by the first and the last of the points below
};

} // namespace pcl_bsh
