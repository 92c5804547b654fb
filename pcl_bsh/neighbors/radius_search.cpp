// SPDX-License-Identifier: BSD-3-Clause
// Points within a radius: one descent that takes spheres altogether inside the radius as they are, and compares points
// only in leaves that its surface may cut.
#include <pcl_bsh/geometry/point_frame.h>
#include <pcl_bsh/neighbors/neighbor_scratch.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/neighbors/radius_search.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/neighbors/measure-inl.h>
#include <pcl_bsh/simd/compress-inl.h>
#include <pcl_bsh/simd/point_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

/// Notes every point within the radius, and how far it is.
class Collect {
public:
  Collect(const PointsView& view, const Point3& query, NeighborScratch& scratch)
  : view_(view),
    query_(query),
    records_(scratch.records),
    squared_(scratch.squared)
  {
    records_.clear();
    squared_.clear();
  }

  /// Points [begin, end) of a voxel. @return whether the walk may end.
  bool takeAll(const Voxel& voxel, std::uint32_t begin, std::uint32_t end)
  {
    const std::size_t count = end - begin;
    makeRoom(count);
    for (std::size_t i = 0; i < count; i += hn::Lanes(Unsigned()))
      hn::StoreU(hn::LoadU(Unsigned(), voxel.records() + begin + i), Unsigned(), records_.end() + i);
    measure(view_, query_, voxel, begin, end - begin, squared_.end());
    add(count);
    return false;
  }

  /// Takes the points whose bit is set, among the sixteen from `begin` on.
  bool takeSome(const Voxel& voxel, std::uint32_t begin, std::uint32_t bits)
  {
    makeRoom(kLeafPoints);
    add(measureSome(view_, query_, voxel, begin, bits, records_.end(), squared_.end()));
    return false;
  }

  static constexpr bool kNeedsRecords = true;

private:
  using Unsigned = hn::RebindToUnsigned<LaneTag>;

  /// For `count` more points, and whole vectors.
  void makeRoom(std::size_t count)
  {
    records_.reserveMore(count + kLanes);
    squared_.reserveMore(count + kLanes);
  }
  void add(std::size_t count)
  {
    records_.resize(records_.size() + count);
    squared_.resize(squared_.size() + count);
  }

  const PointsView& view_;
  const Point3& query_;
  LargeArray<std::uint32_t>& records_;
  LargeArray<float>& squared_;
};

/// A receiver that ends the walk at the first point found.
class FindOne {
public:
  bool takeAll(const Voxel&, std::uint32_t, std::uint32_t) { return true; }
  bool takeSome(const Voxel&, std::uint32_t, std::uint32_t bits) { return bits != 0; }

  static constexpr bool kNeedsRecords = false;
};

template <class Receiver>
class RadiusWalk {
public:
  RadiusWalk(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, Receiver& receiver, Work& work)
  : cloud_(cloud),
    query_(query),
    radius_(radius),
    receiver_(receiver),
    work_(work)
  {
  }

  /// @return whether the receiver had enough before the end.
  bool run()
  {
    if (cloud_.size == 0) return false;
    const SphereHierarchy::Storage::GridPlace place = cloud_.find(query_);
    const bool in_voxel = place.voxel != kNoVoxel;
    if (radius_ < place.margin) return in_voxel && visitVoxel(place.voxel);
    // Where one point is enough, the voxel around the query is the first to ask.
    if (!Receiver::kNeedsRecords && in_voxel) {
      if (visitVoxel(place.voxel)) return true;
      done_ = place.voxel;
    }
    const PointFrame frame(cloud_.frame, query_);
    const double length = radius_ / frame.unit;
    if (frame.separates(cloud_.frame, length)) return false;
    ++work_.volumes_carried;
    return visitAbove(ballOf(frame, length), 0);
  }

private:
  static QueryBall ballOf(const PointFrame& frame, double length)
  {
    return {frame.at[0], frame.at[1], frame.at[2], frame.pruneReach(length), frame.acceptReach(length)};
  }

  struct Children {
    std::uint32_t near, inside;
  };

  Children test(const Node& node, const QueryBall& ball)
  {
    work_.node_pairs += node.count;
    const SphereLanes spheres{node.x, node.y, node.z, node.r, 1.0f};
    const std::uint32_t near = spheresNear(spheres, ball, nullptr) & firstBits(node.count);
    return {near, near == 0 ? 0 : near & spheresInside(spheres, ball)};
  }

  bool visitAbove(const QueryBall& ball, std::uint32_t index)
  {
    const Node& node = cloud_.top[index];
    const Children children = test(node, ball);
    for (const std::uint32_t i : Bits(children.inside)) {
      if constexpr (!Receiver::kNeedsRecords) return true;
      for (std::uint32_t v = node.begin[i]; v < node.begin[i + 1]; ++v)
        receiver_.takeAll(cloud_.built(v, work_), 0, cloud_.voxels[v].count);
    }
    for (const std::uint32_t i : Bits(children.near & ~children.inside))
      if (node.isLeaf(i) ? node.begin[i] != done_ && visitVoxel(node.begin[i]) : visitAbove(ball, node.child[i]))
        return true;
    return false;
  }

  /// The query in a voxel's frame.
  struct Local {
    const Voxel& voxel;
    QueryBall ball;
    DistanceBand band;
  };

  bool visitVoxel(std::uint32_t index)
  {
    const LocalFrame& frame = cloud_.voxels[index].frame;
    const PointFrame query(frame, query_);
    const double length = radius_ / query.unit;
    if (query.separates(frame, length)) return false;
    ++work_.volumes_carried;
    const Local local{cloud_.built(index, work_), ballOf(query, length), query.band(length)};
    return visit(local, 0);
  }

  bool visit(const Local& local, std::uint32_t index)
  {
    const Node& node = local.voxel.nodes[index];
    const Children children = test(node, local.ball);
    fetch(local.voxel, node, children.near);
    for (const std::uint32_t i : Bits(children.inside))
      if (receiver_.takeAll(local.voxel, node.begin[i], node.begin[i + 1])) return true;
    for (const std::uint32_t i : Bits(children.near & ~children.inside))
      if (node.isLeaf(i) ? compare(local, node, i) : visit(local, node.child[i])) return true;
    return false;
  }

  /// Prefetches the nodes and points of the children that will be visited, all at once.
  static HWY_INLINE void fetch(const Voxel& voxel, const Node& node, std::uint32_t children)
  {
    if ((children & (children - 1)) == 0) return;
    for (const std::uint32_t i : Bits(children)) {
      if (!node.isLeaf(i)) {
        hwy::Prefetch(voxel.nodes[node.child[i]].x);
        hwy::Prefetch(voxel.nodes[node.child[i]].z);
        hwy::Prefetch(voxel.nodes[node.child[i]].begin);
        hwy::Prefetch(voxel.nodes[node.child[i]].child);
        continue;
      }
      hwy::Prefetch(voxel.x() + node.begin[i]);
      hwy::Prefetch(voxel.y() + node.begin[i]);
      hwy::Prefetch(voxel.z() + node.begin[i]);
      if (Receiver::kNeedsRecords) hwy::Prefetch(voxel.records() + node.begin[i]);
    }
  }

  bool compare(const Local& local, const Node& node, std::uint32_t child)
  {
    ++work_.leaf_pairs;
    const Voxel& voxel = local.voxel;
    const std::uint32_t begin = node.begin[child], count = node.comparedPoints(child);
    alignas(64) float squared[kLeafPoints];
    leafSquaredDistances(voxel.x() + begin, voxel.y() + begin, voxel.z() + begin, local.ball.x, local.ball.y,
                         local.ball.z, squared);
    std::uint32_t hits = atMost(squared, local.band.hit) & firstBits(count);
    std::uint32_t open = ~(hits | above(squared, local.band.miss)) & firstBits(count);
    if constexpr (!Receiver::kNeedsRecords)
      if (hits != 0) return true;
    for (const std::uint32_t i : Bits(open)) {
      const Point3 p = voxel.point(cloud_.view, begin + i);
      if (isWithin(p, query_, radius_, work_)) hits |= 1u << i;
    }
    if (hits == 0) return false;
    if (node.isCoincident(child)) return receiver_.takeAll(voxel, begin, node.begin[child + 1]);
    return receiver_.takeSome(voxel, begin, hits);
  }

  const SphereHierarchy::Storage& cloud_;
  const Point3& query_;
  const double radius_;
  Receiver& receiver_;
  Work& work_;
  std::uint32_t done_ = kNoVoxel; ///< a voxel known to hold nothing within the radius
};

} // namespace

void findWithinOnTarget(const SphereHierarchy::Storage& cloud, const Point3& query, double radius,
                        NeighborScratch& scratch, Work& work)
{
  Collect receiver(cloud.view, query, scratch);
  RadiusWalk<Collect>(cloud, query, radius, receiver, work).run();
}

bool findAnyOnTarget(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, Work& work)
{
  FindOne receiver;
  return RadiusWalk<FindOne>(cloud, query, radius, receiver, work).run();
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(findWithinOnTarget);
HWY_EXPORT(findAnyOnTarget);

void findWithin(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, NeighborScratch& scratch,
                Work& work)
{
  HWY_DYNAMIC_DISPATCH(findWithinOnTarget)(cloud, query, radius, scratch, work);
}

bool findAny(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, Work& work)
{
  return HWY_DYNAMIC_DISPATCH(findAnyOnTarget)(cloud, query, radius, work);
}

} // namespace pcl_bsh
#endif
