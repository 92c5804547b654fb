// SPDX-License-Identifier: BSD-3-Clause
// A walk moves through spaces: the tree above a cloud's voxels, then the tree in one voxel. Each has its own frame.
#pragma once

#include <pcl_bsh/geometry/float_environment.h>
#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <bit>
#include <deque>

namespace pcl_bsh {

inline constexpr std::uint32_t kAboveVoxels =
    0xffffffffu; ///< the space above the voxels; any other number is a voxel's

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
    return space == kAboveVoxels ? storage.top[index] : storage.voxels[space].nodes[index];
  }

  const Voxel& voxel(std::uint32_t space, Work& work) const { return storage.built(space, work); }

  const SphereHierarchy::Storage& storage;
  const Eigen::Isometry3d& pose;
};

/// The relative frames that one walk has needed so far, of a space of a and a space of b each.
class FrameTable {
public:
  FrameTable(const Spaces& a, const Spaces& b) : a_(a), b_(b), rotation_(a.pose, b.pose), slots_(64) {}

  const RelativeFrame& find(std::uint32_t space_a, std::uint32_t space_b)
  {
    for (std::size_t i = hash(space_a, space_b);; i = (i + 1) & (slots_.size() - 1)) {
      Slot& slot = slots_[i];
      if (!slot.frame) return add(space_a, space_b);
      if (slot.space_a == space_a && slot.space_b == space_b) return *slot.frame;
    }
  }

private:
  struct Slot {
    std::uint32_t space_a = 0, space_b = 0;
    const RelativeFrame* frame = nullptr;
  };

  std::size_t hash(std::uint32_t space_a, std::uint32_t space_b) const
  {
    const std::uint64_t key = std::uint64_t{space_a} << 32 | space_b;
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> 32) & (slots_.size() - 1);
  }

  const RelativeFrame& add(std::uint32_t space_a, std::uint32_t space_b)
  {
    const RelativeFrame& frame =
        frames_.emplace_back(a_.frame(space_a), a_.pose, b_.frame(space_b), b_.pose, rotation_);
    if (2 * frames_.size() > slots_.size()) {
      std::vector<Slot> old(2 * slots_.size());
      old.swap(slots_);
      for (const Slot& slot : old)
        if (slot.frame) place(slot);
    }
    place({space_a, space_b, &frame});
    return frame;
  }

  void place(const Slot& slot)
  {
    std::size_t i = hash(slot.space_a, slot.space_b);
    while (slots_[i].frame) i = (i + 1) & (slots_.size() - 1);
    slots_[i] = slot;
  }

  const Spaces& a_;
  const Spaces& b_;
  const RelativeRotation rotation_;
  std::deque<RelativeFrame> frames_;
  std::vector<Slot> slots_;
};

} // namespace pcl_bsh
