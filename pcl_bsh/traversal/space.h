// SPDX-License-Identifier: BSD-3-Clause
// A walk moves through spaces: the tree above a cloud's voxels, then the tree in one voxel. Each has its own frame.
#pragma once

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <hwy/base.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <vector>

namespace pcl_bsh {

/// The number, among the nodes above the voxels, of the node that Spaces::makeWhole() makes.
inline constexpr std::uint32_t kWhole = 0xffffffffu;

/// A cloud's spaces. Voxels are built as a walk enters them.
class Spaces {
public:
  explicit Spaces(const Placed& placed) : storage(placed.hierarchy().storage()), pose(placed.pose) {}

  const LocalFrame& frame(std::uint32_t space) const
  {
    return space == kAboveVoxels ? storage.frame : storage.voxels[space].frame;
  }

  /// @pre a voxel was entered through voxel() before.
  const Node& node(std::uint32_t space, std::uint32_t index) const
  {
    if (space != kAboveVoxels) return storage.voxels[space].nodes[index];
    return index == kWhole ? whole_ : storage.top[index];
  }

  /// Returns the number of the node whose first child is the whole cloud.
  std::uint32_t whole() const { return storage.top[0].count == 1 ? 0 : kWhole; }

  /// Makes the node of whole(). Call it before a walk comes to whole(), or to pairs with it that another walk left.
  /// @pre the cloud has points
  void makeWhole()
  {
    const Node& root = storage.top[0];
    whole_ = {};
    whole_.addChild(0, static_cast<std::uint32_t>(storage.voxel_count), 0);
    whole_.lowest[0] = *std::min_element(root.lowest, root.lowest + root.count);
    const auto middleOf = [&root](const float* at) {
      float low = at[0] - root.r[0], high = at[0] + root.r[0];
      for (std::uint32_t i = 1; i < root.count; ++i)
        low = std::min(low, at[i] - root.r[i]), high = std::max(high, at[i] + root.r[i]);
      return 0.5f * low + 0.5f * high;
    };
    whole_.x[0] = middleOf(root.x), whole_.y[0] = middleOf(root.y), whole_.z[0] = middleOf(root.z);
    double radius = 0.0; // around the children's spheres: floats, whose differences doubles hardly round
    for (std::uint32_t i = 0; i < root.count; ++i) {
      const auto from = [i](const float* at, float to) { return static_cast<double>(at[i]) - static_cast<double>(to); };
      const double dx = from(root.x, whole_.x[0]), dy = from(root.y, whole_.y[0]), dz = from(root.z, whole_.z[0]);
      radius = std::max(radius, std::sqrt(dx * dx + dy * dy + dz * dz) + static_cast<double>(root.r[i]));
    }
    whole_.r[0] = roundUp(radius * (1.0 + kDoubleMargin));
    whole_.clearUnused();
  }

  const Voxel& voxel(std::uint32_t space, Work& work) const { return storage.built(space, work); }

  const SphereHierarchy::Storage& storage;
  const Eigen::Isometry3d& pose;

private:
  Node whole_;
};

/// Memory that FrameTables use one after another; a ScratchLease lends it.
struct FrameScratch {
  struct Entry {
    std::uint32_t space_a = 0, space_b = 0;
    RelativeFrame frame;
  };

  std::deque<Entry> entries; ///< a deque, for slots and walks refer to them
  std::vector<const Entry*> slots;

  std::size_t bytes() const noexcept
  {
    return entries.size() * sizeof(Entry) + slots.capacity() * sizeof(const Entry*);
  }
};

/// The relative frames that one walk has needed so far, of a space of a and a space of b each.
class FrameTable {
public:
  FrameTable(const Spaces& a, const Spaces& b) : a_(a), b_(b), rotation_(a.pose, b.pose) { resize(64); }

  const RelativeFrame& find(std::uint32_t space_a, std::uint32_t space_b)
  {
    for (std::size_t i = hash(space_a, space_b);; i = (i + 1) & mask_) {
      const Entry* const entry = slots_[i];
      if (!entry) return add(space_a, space_b);
      if (entry->space_a == space_a && entry->space_b == space_b) return entry->frame;
    }
  }

private:
  using Entry = FrameScratch::Entry;

  std::size_t hash(std::uint32_t space_a, std::uint32_t space_b) const
  {
    const std::uint64_t key = std::uint64_t{space_a} << 32 | space_b;
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> 32) & mask_;
  }

  HWY_NOINLINE const RelativeFrame& add(std::uint32_t space_a, std::uint32_t space_b) // so that find() is inlined
  {
    if (2 * (used_ + 1) > mask_ + 1) resize(2 * (mask_ + 1));
    if (used_ == entries_.size()) entries_.emplace_back();
    Entry& entry = entries_[used_];
    entry = {space_a, space_b, RelativeFrame(a_.frame(space_a), a_.pose, b_.frame(space_b), b_.pose, rotation_)};
    ++used_;
    place(entry);
    return entry.frame;
  }

  /// Uses the first `slots` of the slots. @param slots a power of two
  void resize(std::size_t slots)
  {
    if (slots_.size() < slots) slots_.resize(slots);
    mask_ = slots - 1;
    std::fill_n(slots_.begin(), slots, nullptr);
    for (std::size_t i = 0; i < used_; ++i) place(entries_[i]);
  }

  void place(const Entry& entry)
  {
    std::size_t i = hash(entry.space_a, entry.space_b);
    while (slots_[i]) i = (i + 1) & mask_;
    slots_[i] = &entry;
  }

  const Spaces& a_;
  const Spaces& b_;
  const RelativeRotation rotation_;
  const ScratchLease<FrameScratch> scratch_;
  std::deque<Entry>& entries_ = (*scratch_).entries;
  std::vector<const Entry*>& slots_ = (*scratch_).slots; ///< open addressing, half full
  std::size_t used_ = 0;                                 ///< of the entries
  std::size_t mask_ = 0;                                 ///< the slots in use, less one
};

} // namespace pcl_bsh
