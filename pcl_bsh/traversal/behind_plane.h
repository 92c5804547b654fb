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

  /// The smallest records that touch the plane, each kNoRecord if there is none.
  struct Touching {
    std::uint32_t lowest = kNoRecord;
    std::uint32_t elsewhere = kNoRecord; ///< of those which touch it with a place that `known` does not touch it with
  };

  /// @param plane behind it is where its normal points away from @param allowed what surely reaches beyond it by less
  /// than this counts as behind @param known a record, or kNoRecord
  BehindPlane(const SphereHierarchy::Storage& cloud, const ExactPlane& plane, double allowed, std::uint32_t known)
  : cloud_(cloud),
    plane_(plane),
    allowed_(allowed),
    known_(known)
  {
  }

  /// What touches the plane below a child, if nothing there is beyond it. Nothing, too, where more records would have
  /// to be looked at than `looks`, which those that are looked at are taken from.
  std::optional<Touching> touching(const NodeChild& child, std::uint64_t& looks);

  /// The side that a record reaches to: 1 beyond the plane, 0 in it, -1 behind.
  int sideOf(std::uint32_t record) const;

private:
  int sideOf(const Point3& place) const { return plane_.isWithin(place, allowed_) ? -1 : plane_.side(place); }
  bool touchesElsewhere(std::uint32_t record) const;
  std::optional<Touching> look(const NodeChild& child, std::uint64_t& looks) const;

  const SphereHierarchy::Storage& cloud_;
  const ExactPlane plane_;
  const double allowed_;
  const std::uint32_t known_;
  std::unordered_map<std::uint64_t, std::optional<Touching>> found_; ///< by the first and the last of the points below
};

} // namespace pcl_bsh
