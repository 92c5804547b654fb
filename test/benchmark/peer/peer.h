// SPDX-License-Identifier: BSD-3-Clause
// The interface of a peer in a race: index one cloud, then say which query points have a neighbour within d.
#pragma once

#include "../workload/points.h"

#include <memory>
#include <string>

namespace pcl_bsh::bench {

/// An index over one cloud. Distances are inclusive where the library lets us say so.
class ExistencePeer {
public:
  virtual ~ExistencePeer() = default;

  /// Brings the cloud into the library's own point type; not timed, a user of the library has it so already.
  virtual void adopt(const Points&) {}

  /// Indexes `points` (adopted before), borrowed until the next build; `d` is the distance that will be asked for.
  virtual void build(const Points& points, float d) = 0;

  /// Frees what build() made; not timed.
  virtual void release() = 0;

  /// out[i] = 1 when a point lies within d of queries[i], else 0, for begin <= i < end.
  virtual void flag(const Points& queries, std::size_t begin, std::size_t end, float d, std::uint8_t* out) const = 0;

  /// Does any of the queries have a point within d? Stops at the first.
  virtual bool any(const Point* queries, std::size_t count, float d) const = 0;
};

/// Does any point of `b`, posed by `pose`, have an indexed point within d? Poses b in blocks, so that an early hit does
/// not pay for the whole cloud.
bool anyPosed(const ExistencePeer& peer, const Points& b, const RigidPose& pose, float d);

/// nanoflann k-d tree: float, leaves of ten, a result set that stops the search at the first hit.
std::unique_ptr<ExistencePeer> makeNanoflannTree();

/// pcl::KdTreeFLANN, radiusSearch with max_nn = 1, results unsorted. Its radius is exclusive.
std::unique_ptr<ExistencePeer> makePclKdTree();

/// pcl::octree::OctreePointCloudSearch with voxels of edge d, radiusSearch with max_nn = 1.
std::unique_ptr<ExistencePeer> makePclOctree();

} // namespace pcl_bsh::bench
