// SPDX-License-Identifier: BSD-3-Clause
// The state of one node of a in a walk that measures points: how near and how far each of its children may be from the
// spheres of b that can hold the nearest points. Bounds are floats in one unit for all frames, rounded outward.

#if defined(PCL_BSH_DISTANCES_DISTANCE_VISIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_DISTANCE_VISIT_INL_H_
#undef PCL_BSH_DISTANCES_DISTANCE_VISIT_INL_H_
#else
#define PCL_BSH_DISTANCES_DISTANCE_VISIT_INL_H_
#endif

#include <pcl_bsh/distances/bounds-inl.h>
#include <pcl_bsh/traversal/flat_records-inl.h>
#include <pcl_bsh/traversal/list_walk-inl.h>
#include <pcl_bsh/traversal/long_triangles-inl.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A sphere of b, and a lower bound of the distances from a child of a visit to it.
struct NearSphere {
  ObstacleSphere sphere;
  float lower;
};

/// A leaf of b, and a lower bound of the distances from a leaf of a to it.
struct NearLeaf {
  std::uint32_t obstacle;
  LeafRange range;
  float lower;
};

/// The spheres of a list side by side, so that a leaf of a is compared with eight of them at once.
class GatheredSpheres {
public:
  static constexpr float kDone = std::numeric_limits<float>::infinity();

  /// Places of one obstacle, that follow each other; the first is a multiple of eight.
  struct Run {
    std::uint32_t obstacle, begin, end;

    std::uint32_t wholeVectors() const { return (end + kStep - 1) / kStep * kStep; }
  };

  void gather(const std::vector<NearSphere>& list)
  {
    runs_.clear();
    std::uint32_t at = 0;
    for (const NearSphere& near : list) {
      const ObstacleSphere& from = near.sphere;
      if (runs_.empty() || runs_.back().obstacle != from.obstacle) {
        if (!runs_.empty()) at = endRun();
        runs_.push_back({from.obstacle, at, at});
      }
      if (sphere_.size() < at + std::size_t{kStep}) makeRoom(2 * std::size_t{at} + kStep);
      x_[at] = from.node->x[from.lane];
      y_[at] = from.node->y[from.lane];
      z_[at] = from.node->z[from.lane];
      r_[at] = from.node->r[from.lane];
      sphere_[at] = from;
      lower_[at] = near.lower;
      runs_.back().end = ++at;
    }
    if (!runs_.empty()) endRun();
  }

  const std::vector<Run>& runs() const { return runs_; }
  const ObstacleSphere& sphere(std::uint32_t place) const { return sphere_[place]; }

  /// Eight spheres, from a place on.
  SphereLanes lanes(std::uint32_t place, float stretch) const
  {
    return {&x_[place], &y_[place], &z_[place], &r_[place], stretch};
  }

  /// Lower bounds of the distances from the leaf, at first the list's; kDone where no sphere is, or it is done.
  float* lower() { return lower_.data(); }

  /// The end of the places that have a lower bound.
  std::uint32_t end() const { return runs_.empty() ? 0 : runs_.back().wholeVectors(); }

  /// The place of the least lower bound, the first of several. @pre there are spheres
  std::uint32_t nearest() const
  {
    const LaneTag d;
    const hn::RebindToSigned<LaneTag> di;
    LaneVector least = hn::Set(d, kDone);
    auto here = hn::Iota(di, 0), place = here;
    for (std::uint32_t i = 0; i < end(); i += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const LaneVector bound = hn::LoadU(d, &lower_[i]);
      const auto nearer = hn::Lt(bound, least);
      place = hn::IfThenElse(hn::RebindMask(di, nearer), here, place);
      least = hn::IfThenElse(nearer, bound, least);
      here = hn::Add(here, hn::Set(di, static_cast<std::int32_t>(hn::Lanes(d))));
    }
    const auto is_least = hn::RebindMask(di, hn::Eq(least, hn::MinOfLanes(d, least)));
    const auto most = hn::Set(di, std::numeric_limits<std::int32_t>::max());
    return static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(di, hn::IfThenElse(is_least, place, most))));
  }

  std::size_t bytes() const noexcept
  {
    return runs_.capacity() * sizeof(Run) + 5 * x_.capacity() * sizeof(float) +
           sphere_.capacity() * sizeof(ObstacleSphere);
  }

private:
  static constexpr std::uint32_t kStep = kLanes;

  /// @return where the next one begins
  std::uint32_t endRun()
  {
    const Run& run = runs_.back();
    std::fill(lower_.begin() + run.end, lower_.begin() + run.wholeVectors(), kDone);
    return run.wholeVectors();
  }

  void makeRoom(std::size_t places)
  {
    for (std::vector<float>* const values : {&x_, &y_, &z_, &r_, &lower_}) values->resize(places);
    sphere_.resize(places);
  }

  std::vector<Run> runs_;
  std::vector<float> x_, y_, z_, r_, lower_;
  std::vector<ObstacleSphere> sphere_;
};

/// A leaf of a in the frame of an obstacle.
struct CarriedLeaf {
  LeafPoints points;       ///< those past the leaf's count are its first
  float low[3], high[3];   ///< the box around them
  std::uint64_t stamp = 0; ///< of the leaf
};

/// A sphere of b, and a lower bound of the distances from each child of the visit to it.
struct DistanceRow {
  ObstacleSphere sphere;
  std::uint32_t lanes; ///< children that it matters to
  float lower[kLanes];
  float about_center[kLanes]; ///< `lower` before the child's slab raised it, for DifferenceBound; where slabs of both
                              ///< are compared
  std::uint32_t as_given = 0; ///< children whose bound compareAsGiven() sharpened, about other centres
};

/// One node of a, its children measured all at once.
struct DistanceVisit : ListVisit<NearSphere> {
  std::uint64_t stamp = 0;                ///< a number that no other visit or leaf has had
  BoundingSphere around;                  ///< holds them all; in the frame of a's voxel
  float large_leaf = 0.0f;                ///< a leaf of b with a greater radius is large beside a child
  float cut[kLanes];                      ///< what is farther than this is not the nearest of any point of the child
  float limit[kLanes];                    ///< spheres with a lower bound above it are outdone; infinite where none are
  float turn[kLanes];                     ///< DifferenceBound::turnOf() of the children
  std::array<std::uint8_t, kLanes> order; ///< in which the children are measured
  std::vector<DistanceRow> rows;          ///< of the spheres in the node's own list
  std::vector<DistanceRow> kept;          ///< of the spheres for the lists of its children
  std::vector<CarriedNode> carried;       ///< by obstacle

  void begin(const NodeInSphere& entered, float upper, std::uint64_t number)
  {
    ListVisit::begin(entered.node);
    stamp = number;
    around = entered.around;
    large_leaf = std::numeric_limits<float>::infinity();
    for (std::uint32_t lane = 0; lane < node->count; ++lane)
      large_leaf = std::min(large_leaf, kLargeLeaf * node->r[lane]);
    for (float& value : cut) value = upper;
    for (std::uint8_t lane = 0; lane < kLanes; ++lane) order[lane] = lane;
    for (float& value : limit) value = std::numeric_limits<float>::infinity();
    rows.clear();
    kept.clear();
  }

  std::size_t bytes() const noexcept
  {
    return ListVisit::bytes() + (rows.capacity() + kept.capacity()) * sizeof(DistanceRow) +
           carried.capacity() * sizeof(CarriedNode);
  }

  /// Whether one of these children is small beside a leaf of b.
  bool areSmall(std::uint32_t children, float radius) const
  {
    for (const std::uint32_t lane : Bits(children))
      if (kLargeLeaf * node->r[lane] < radius) return true;
    return false;
  }
};

/// Lowers `cut` to upper bounds, and `limit` to these less `turn`, above which spheres are outdone
/// (difference_bound.h).
HWY_INLINE void lowerCuts(DistanceVisit& visit, const float* upper)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector far = hn::LoadU(d, upper + i), cut = hn::LoadU(d, visit.cut + i),
                     limit = hn::LoadU(d, visit.limit + i);
    hn::StoreU(hn::IfThenElse(hn::Lt(far, cut), far, cut), d, visit.cut + i);
    // The factor adds more than the product and the difference round off.
    const LaneVector now = hn::Sub(hn::Mul(far, hn::Set(d, 1.0f + 0x1p-22f)), hn::LoadU(d, visit.turn + i));
    hn::StoreU(hn::IfThenElse(hn::Lt(now, limit), now, limit), d, visit.limit + i);
  }
}

/// Bounds the distances from the children of a visit to what lies within a sphere, one point at least.
/// @param has_limit whether `limit` is of use
HWY_INLINE void boundChildren(DistanceVisit& visit, const CarriedNode& own, const DistanceObstacle& obstacle,
                              const Point& center, float radius, bool has_limit, float* lower)
{
  if (!has_limit) return boundDistances(own, obstacle, center, radius, lower, visit.cut);
  float upper[kLanes];
  std::fill(std::begin(upper), std::end(upper), std::numeric_limits<float>::infinity());
  boundDistances(own, obstacle, center, radius, lower, upper);
  lowerCuts(visit, upper);
}

/// Sharpens such bounds by the points of the sphere's leaf, where that is much larger than a child: its sphere tells
/// nothing. @pre no radii
HWY_NOINLINE inline void boundByPoints(DistanceVisit& visit, const CarriedNode& own, const DistanceObstacle& obstacle,
                                       const LeafRange& leaf, bool has_limit, float* lower)
{
  float least[kLanes], of_point[kLanes];
  std::fill(std::begin(least), std::end(least), std::numeric_limits<float>::infinity());
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    boundChildren(visit, own, obstacle, {leaf.x()[i], leaf.y()[i], leaf.z()[i]}, 0.0f, has_limit, of_point);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) least[lane] = std::min(least[lane], orNone(of_point[lane]));
  }
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) lower[lane] = std::max(orNone(lower[lane]), least[lane]);
}

/// Sharpens such bounds by `count` triangles of the sphere's leaf. @param lower null where these are not all triangles
/// of the leaf: then they lower `cut` alone @param triangle(j) laid flat
template <class Triangles>
HWY_NOINLINE void boundByTriangles(DistanceVisit& visit, const CarriedNode& own, const DistanceObstacle& obstacle,
                                   std::uint32_t count, bool has_limit, float* lower, const Triangles& triangle)
{
  const LaneTag d;
  alignas(64) float squared[kLanes], of_triangle[kLanes], least[kLanes], upper[kLanes];
  std::fill(std::begin(least), std::end(least), std::numeric_limits<float>::infinity());
  std::fill(std::begin(upper), std::end(upper), std::numeric_limits<float>::infinity());
  for (std::uint32_t j = 0; j < count; ++j) {
    const FlatRecord& record = triangle(j);
    squaredToTriangle(record.flat, own.x, own.y, own.z, kLanes, squared);
    const float error = roundUp(record.error(obstacle.frame)) + obstacle.slack;
    for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
      LaneVector low, high;
      boundsOfFlat(d, hn::Load(d, squared + i), hn::LoadU(d, own.r + i), error, obstacle, low, high);
      hn::Store(low, d, of_triangle + i);
      hn::Store(hn::IfThenElse(hn::Lt(high, hn::Load(d, upper + i)), high, hn::Load(d, upper + i)), d, upper + i);
    }
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) least[lane] = std::min(least[lane], orNone(of_triangle[lane]));
  }
  for (std::uint32_t lane = 0; lower && lane < kLanes; ++lane) lower[lane] = std::max(orNone(lower[lane]), least[lane]);
  if (has_limit) return lowerCuts(visit, upper);
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) visit.cut[lane] = std::min(visit.cut[lane], upper[lane]);
}

/// A triangle of b that may be the nearest to some points of a leaf, and its squared distance from each.
struct MaybeNearest {
  std::uint32_t obstacle;
  std::uint32_t point; ///< in its voxel
  float error;         ///< of the distances, beside that of the obstacle's frame
  float squared[kLeafPoints];
};

/// Memory that walks use one after another; a ScratchLease lends it.
struct DistanceScratch {
  std::uint64_t stamp = 0; ///< the last one given
  Visits<DistanceVisit> visits;
  std::vector<DistanceObstacle> obstacles;
  std::vector<NearSphere> roots;           ///< what the walk begins with
  std::vector<CarriedLeaf> leaves;         ///< by obstacle
  std::vector<std::uint32_t> obstacle_of;  ///< by voxel of b: its obstacle, 0 where it has none yet
  FlatRecords flat;                        ///< where b is of triangles
  std::vector<MaybeNearest> maybe_nearest; ///< where b is of triangles
  GatheredSpheres gathered;
  std::vector<NearLeaf> near_leaves; ///< of one leaf of a: what it is compared with
  LongTriangles long_triangles;      ///< of b, in long numbers

  std::size_t bytes() const noexcept
  {
    return visits.bytes() + obstacles.capacity() * sizeof(DistanceObstacle) + roots.capacity() * sizeof(NearSphere) +
           leaves.capacity() * sizeof(CarriedLeaf) + obstacle_of.capacity() * sizeof(std::uint32_t) + flat.bytes() +
           maybe_nearest.capacity() * sizeof(MaybeNearest) + near_leaves.capacity() * sizeof(NearLeaf) +
           long_triangles.bytes() + gathered.bytes();
  }
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
