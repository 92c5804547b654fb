// SPDX-License-Identifier: BSD-3-Clause
// How far nodes of one cloud reach beyond a plane, whether they lie behind it, and which records touch it there.
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

/// Looks at each record of a node once for each kind of number, and remembers what it has found.
class BehindPlane {
public:
  static constexpr std::uint32_t kNoRecord = 0xffffffffu;

  /// The smallest records that touch the plane, each kNoRecord if there is none.
  struct Touching {
    std::uint32_t lowest = kNoRecord;
    std::uint32_t elsewhere = kNoRecord; ///< of those which touch it with a place that `known` does not touch it with
  };

  /// @param plane behind it is where its normal points away from @param known a record, or kNoRecord
  BehindPlane(const SphereHierarchy::Storage& cloud, const ExactPlane& plane, std::uint32_t known)
  : cloud_(cloud),
    plane_(plane),
    known_(known)
  {
  }

  /// No less than how far anything below a child reaches beyond the plane, in the plane's unit. Nothing where more
  /// records would have to be looked at than `looks`, which those that are looked at are taken from; NaN where doubles
  /// cannot tell.
  std::optional<double> heightAtMost(const NodeChild& child, std::uint64_t& looks);

  /// With more digits; nothing where these cannot tell. @pre heightAtMost() has paid for looking at the child
  std::optional<LongNumber> height(const NodeChild& child);

  /// Both heights of one record.
  double heightAtMost(std::uint32_t record) const;
  std::optional<LongNumber> height(std::uint32_t record) const;

  /// The records below a child that touch the plane, if none there is beyond it; exact. @pre as of height()
  std::optional<Touching> touching(const NodeChild& child);

  /// The side that a record reaches to: 1 beyond the plane, 0 in it, -1 behind.
  int sideOf(std::uint32_t record) const;

private:
  /// What is known of some records.
  struct Known {
    std::optional<double> height;
    std::optional<std::optional<LongNumber>> longer;
    std::optional<std::optional<Touching>> touching;
  };

  Known& known(const NodeChild& child);
  template <class Visit>
  void forEachRecord(const NodeChild& child, const Visit& visit) const;
  bool touchesElsewhere(std::uint32_t record) const;
  std::optional<Touching> look(const NodeChild& child) const;

  const SphereHierarchy::Storage& cloud_;
  const ExactPlane plane_;
  const std::uint32_t known_;
  std::unordered_map<std::uint64_t, Known> found_; ///< by the first and the last of the points below
};

} // namespace pcl_bsh
