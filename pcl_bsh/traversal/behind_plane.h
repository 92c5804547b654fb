// SPDX-License-Identifier: BSD-3-Clause
// How far nodes of one cloud reach beyond a plane, whether they lie behind it, and which records touch it there.
#pragma once

#include <pcl_bsh/geometry/exact/exact_plane.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <cstdint>
#include <optional>
#include <unordered_map>

namespace pcl_bsh {

/// One child of a node; it stands for all records below it.
struct NodeChild {
  std::uint32_t space; ///< of the node
  const Node& node;
  std::uint32_t lane;
};

/// Compares the records below nodes with a plane. Computes each kind of answer for a child once, and keeps it.
class BehindPlane {
public:
  static constexpr std::uint32_t kNoRecord = 0xffffffffu;

  /// The smallest numbers of records that touch the plane; kNoRecord where no record does.
  struct Touching {
    std::uint32_t lowest = kNoRecord;
    std::uint32_t elsewhere = kNoRecord; ///< of records that touch it with a corner that `known` does not have
  };

  /// @param plane its normal points to the side beyond it
  /// @param known a record of the cloud, or kNoRecord
  BehindPlane(const SphereHierarchy::Storage& cloud, const ExactPlane& plane, std::uint32_t known)
  : cloud_(cloud),
    plane_(plane),
    known_(known)
  {
  }

  /// Returns an upper bound of how far anything below a child reaches beyond the plane, in the plane's unit; NaN where
  /// doubles cannot tell. Returns nothing where it would have to look at more than `looks` records; else subtracts the
  /// number of records that it looks at from `looks`.
  std::optional<double> heightAtMost(const NodeChild& child, std::uint64_t& looks);

  /// Returns how far the child reaches beyond the plane, with its error; nothing where LongNumber cannot tell.
  /// @pre heightAtMost() returned a height for the child
  std::optional<LongNumber> height(const NodeChild& child);

  /// heightAtMost() and height() of a single record.
  double heightAtMost(std::uint32_t record) const;
  std::optional<LongNumber> height(std::uint32_t record) const;

  /// Returns the records below a child that touch the plane, exactly; nothing where a record reaches beyond it.
  /// @pre heightAtMost() returned a height for the child
  std::optional<Touching> touching(const NodeChild& child);

  /// Returns 1 where a record reaches beyond the plane, 0 where it touches the plane, -1 where all of it is behind.
  int sideOf(std::uint32_t record) const;

private:
  /// Answers for the records below one child; each is unset until somebody asks.
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
  std::unordered_map<std::uint64_t, Known> found_; ///< by the range of the points below a child
};

} // namespace pcl_bsh
