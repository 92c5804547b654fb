// SPDX-License-Identifier: BSD-3-Clause
// A voxel grid over the scene. Only objects that share a voxel can collide; an object that moves changes only the
// voxels it leaves and enters.
#pragma once

#include <pcl_bsh/scene/pairs/object_boxes.h>
#include <pcl_bsh/scene/pairs/pair_rules.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

namespace pcl_bsh {

/// The versions of two objects (Body::version) at which something was found about them; 0: nothing was.
struct Versions {
  std::uint64_t a = 0, b = 0;

  /// Takes over the present versions. @return whether they are others than before
  bool follow(std::uint64_t now_a, std::uint64_t now_b)
  {
    const bool same = a == now_a && b == now_b;
    a = now_a;
    b = now_b;
    return !same;
  }
};

/// Facts about a pair from earlier steps.
struct PairMemory {
  Versions of_near;
  bool near = false; ///< boxes within the clearance

  Versions of_any; ///< of `colliding`
  bool colliding = false;
  std::optional<PartPair> undecided; ///< parts that may collide, if none are known to
  CollidingPair witness;             ///< of the last collision found
  bool has_witness = false;
  double apart = 0.0; ///< no points were nearer than this when the objects stood at the two poses below
  Eigen::Isometry3d apart_a, apart_b;
  unsigned patience = 0; ///< queries to come before a wider clearance is tried again

  Versions of_distance;
  bool within = false;
  DistantPair distance;

  bool reused = false; ///< of the present query
  std::uint32_t asked = 0;
  Work work;
};

struct BroadPair {
  ObjectId a, b; ///< a < b
  double clearance;
  std::uint32_t shared = 0; ///< voxels
  PairMemory memory;
};

class BroadPhase {
public:
  /// Forgets everything. @param edge of a voxel; infinity: all objects share one.
  void reset(double edge, const PairRules& rules);

  /// Puts an object into the voxels of these boxes. @param boxes around the object, grown by half of the distance at
  /// which pairs are still of interest
  void place(ObjectId object, const std::vector<Box3>& boxes, BroadPhaseCost& cost);

  /// How many voxels a box reaches over, at most 2^40.
  double voxelsOf(const Box3& box) const;

  /// The pairs to be tested that share a voxel, by (a, b). Valid until the next change.
  const std::vector<BroadPair*>& pairs();
  std::size_t pairCount() const { return pairs_.size(); }

  /// The pairs of one object, in no order.
  const std::vector<BroadPair*>& pairsOf(ObjectId object) const { return places_[object].pairs; }

  /// Drops the pairs that share no voxel any more. Until then they are kept, with shared == 0, as lists refer to them.
  void dropParted();

  /// Finds the objects that have a voxel in common with the box, ascending. There may be some more.
  void around(const Box3& box, std::vector<ObjectId>& objects) const;

  void forget(ObjectId object); ///< forgets what its pairs remember, after its points have changed

private:
  using Key = std::uint64_t;
  static constexpr Key kEverywhere = ~Key{0};
  static constexpr double kMostVoxels = 0x1p16; // of one object; more make it one that is everywhere

  struct Range {
    std::array<std::int64_t, 3> low, high;
    bool operator==(const Range& other) const { return low == other.low && high == other.high; }
  };
  struct Hash {
    std::size_t operator()(Key key) const
    {
      key = (key ^ key >> 31) * 0x9e3779b97f4a7c15u;
      return static_cast<std::size_t>(key ^ key >> 29);
    }
  };
  struct Place {
    std::vector<Key> voxels; // ascending
    std::vector<Range> ranges;
    std::vector<BroadPair*> pairs;
  };

  Range rangeOf(const Box3& box) const;
  static double countOf(const Range& range);
  static Key keyOf(std::int64_t x, std::int64_t y, std::int64_t z);
  void voxelsOf(const std::vector<Range>& ranges, std::vector<Key>& voxels) const;
  void enter(ObjectId object, Key voxel);
  void leave(ObjectId object, Key voxel);
  void share(ObjectId a, ObjectId b);
  void part(ObjectId a, ObjectId b);

  const PairRules* rules_ = nullptr;
  double edge_ = 1.0;
  std::vector<Place> places_;
  std::vector<std::uint8_t> placed_;
  std::unordered_map<Key, std::vector<ObjectId>, Hash> voxels_;
  std::vector<ObjectId> everywhere_;
  std::unordered_map<std::uint64_t, BroadPair*, Hash> pairs_;
  std::deque<BroadPair> pool_; // of pairs, which stay where they are
  std::vector<BroadPair*> unused_, parted_;
  std::vector<BroadPair*> sorted_;
  bool is_sorted_ = true;
  std::vector<Range> ranges_;   // scratch
  std::vector<Key> new_voxels_; // scratch
};

} // namespace pcl_bsh
