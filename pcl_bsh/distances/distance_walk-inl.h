// SPDX-License-Identifier: BSD-3-Clause
// The walk that measures the points of one voxel of a. A node's list holds the spheres of b that can hold the nearest
// point of one of its points. Every sphere holds a point, so their lower bounds do not exceed the least upper bound of
// all. The list begins with the spheres above the voxels of b, and becomes finer as the nodes of a become smaller.

#if defined(PCL_BSH_DISTANCES_DISTANCE_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_DISTANCE_WALK_INL_H_
#undef PCL_BSH_DISTANCES_DISTANCE_WALK_INL_H_
#else
#define PCL_BSH_DISTANCES_DISTANCE_WALK_INL_H_
#endif

#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/distances/difference_bound.h>
#include <pcl_bsh/distances/distance_leaf-inl.h>
#include <pcl_bsh/distances/entered_spaces-inl.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/query/progress.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class DistanceWalk : public ListVisitor<DistanceVisit> {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr float kWide = 3.0f; ///< spheres more than this many times as wide as a child are opened for it

public:
  DistanceWalk(const DistancesQuery& query, const StopRule& rule, const DistanceSheet& sheet, DistanceScratch& scratch)
  : query_(query),
    rule_(rule),
    sheet_(sheet),
    scratch_(scratch),
    spaces_(query, scratch, found.work),
    a_(spaces_.a),
    b_(spaces_.b),
    unit_(query.unit),
    max_(query.pairs.reach.most),
    compares_slabs_(a_.storage.view.triangles && !b_.storage.view.areBalls()),
    leaf_(query, sheet, scratch, found.work),
    walk_(rule, found.work.node_pairs, scratch.visits)
  {
    scratch_.flat.prepare(b_.storage);
  }

  /// Measures the points of one voxel of a. @pre neither cloud is empty
  void run(std::uint32_t voxel)
  {
    voxel_ = voxel;
    spaces_.begin(voxel);
    // The cut of a limit above 0 must not be a quotient that underflowed to 0.
    const float cut = roundUp(std::max(max_ / unit_, std::min(max_, 0x1p-1000)) * (1.0 + kDoubleMargin));
    if (max_ < kInfinity || rule_.mayStop()) {
      const VoxelBounds::Range whole = boundVoxel(cut);
      if (double{whole.lower} * unit_ > max_) return forAll([this](std::uint32_t record) { setBeyond(record); });
      if (!mayEnter()) {
        const Interval interval = certain(whole.lower, whole.upper);
        return forAll([&](std::uint32_t record) { leave(record, interval); });
      }
    }
    if (query_.reached && query_.exceeds(boundVoxel(cut).upper)) return;
    a_voxel_ = &a_.voxel(voxel, found.work);
    const Node& root = b_.storage.top[0];
    constexpr double stretch = 1.0 + 2 * kPoseStretch;
    if (const float least = bounds().least(a_voxel_->radius); least > 0.0f)
      difference_bound_ =
          DifferenceBound(extentBelow(root) * b_.frame(kAboveVoxels).unit / unit_ * stretch * stretch, least);
    radius_unit_ = a_.frame(voxel).unit / unit_ / stretch;
    leaves_alone_ = !rule_.mayStop() && !difference_bound_.isPossible() && leaf_.mayMeasureAlone();
    scratch_.roots.clear();
    const float least = query_.pairs.mayOverlap() ? -std::numeric_limits<float>::infinity() : 0.0f;
    for (std::uint16_t lane = 0; lane < root.count; ++lane)
      scratch_.roots.push_back({{&root, lane, 0, EnteredSpaces::kAbove}, least});
    walk_.descend(*this, Part{NodeInSphere::rootOf(*a_voxel_), cut}, scratch_.roots);
  }

  // As ListWalk asks.

  /// A node of a. No point below it is farther from its nearest than the cut, unless it is beyond max_distance.
  struct Part : NodeInSphere {
    float cut;
  };

  void left(const Part& part, const std::vector<NearSphere>& list)
  {
    leave(part.node.begin[0], part.node.begin[part.node.count], list, part.cut);
  }

  std::uint32_t refine(DistanceVisit& visit, const Part& part, const std::vector<NearSphere>& list)
  {
    visit.begin(part, part.cut, ++scratch_.stamp);
    for (std::uint32_t lane = 0; difference_bound_.isPossible() && lane < kLanes; ++lane)
      visit.turn[lane] = difference_bound_.turnOf(part.node.r[lane] * radius_unit_);
    const std::uint32_t alone = leaves_alone_ ? leaf_.measureAlone(*a_voxel_, visit, list, part.cut) : 0;
    const std::uint32_t others = firstBits(part.node.count) & ~alone & ~measureTriangles(visit, list, part.cut);
    if (others == 0) return 0;
    for (const NearSphere& near : list) visit.rows.push_back(compare(visit, near.sphere, others));
    if (query_.reached) leaveNearer(visit);
    for (const DistanceRow& row : visit.rows) take(visit, row);
    for (const DistanceRow& row : visit.kept)
      for (const std::uint32_t lane : Bits(nearLanes(visit, row))) {
        visit.near[lane].push_back({row.sphere, orNone(row.lower[lane])});
      }
    return others;
  }

  static std::uint32_t childAt(const DistanceVisit& visit, std::uint32_t i) { return visit.order[i]; }

  bool wants(const DistanceVisit& visit, std::uint32_t lane) const { return !query_.exceeds(visit.cut[lane]); }

  void alone(const DistanceVisit& visit, std::uint32_t lane)
  {
    for (std::uint32_t i = visit.node->begin[lane]; i < visit.node->begin[lane + 1]; ++i)
      setBeyond(a_voxel_->records()[i]);
  }

  void compare(const Part&, DistanceVisit& visit, std::uint32_t lane, std::size_t depth)
  {
    std::vector<NearSphere>& near = visit.near[lane];
    if (rule_.mayStop() && (depth + 1 >= rule_.deepest || !areLeavesOfPoints(near)))
      leave(visit.node->begin[lane], visit.node->begin[lane + 1], near, visit.cut[lane]);
    else
      leaf_.measure(*a_voxel_, visit, lane, near);
  }

  Part below(const Part& part, const DistanceVisit& visit, std::uint32_t lane) const
  {
    return {part.child(*a_voxel_, lane), visit.cut[lane]};
  }

  /// No point of the voxel is farther from b than this, in the clouds' unit. @pre neither cloud is empty
  double farthest(std::uint32_t voxel)
  {
    voxel_ = voxel;
    spaces_.begin(voxel);
    return double{boundVoxel(std::numeric_limits<float>::infinity()).upper} * unit_;
  }

  MeasuredVoxel found;

private:
  /// Whether the walk may go below the voxel of a, and has the time to build it.
  bool mayEnter() const
  {
    return !rule_.isSpent(found.work.node_pairs) && rule_.mayEnter([this] { return a_.storage.pointsToBuild(voxel_); });
  }

  /// Finds bounds of the distances from the voxel of a to the voxels of b.
  VoxelBounds bounds() { return {spaces_[EnteredSpaces::kAbove], b_, found.work}; }

  /// How near and how far the voxels of b are from the sphere of the whole voxel of a.
  VoxelBounds::Range boundVoxel(float cut)
  {
    ++found.work.volumes_carried;
    return bounds().range(a_.storage.voxels[voxel_].radius, cut);
  }

  /// Measures the leaves of triangles: each of these goes down from the list by itself.
  /// @return these leaves
  std::uint32_t measureTriangles(const DistanceVisit& visit, const std::vector<NearSphere>& list, float cut)
  {
    if (!a_.storage.view.triangles || rule_.mayStop()) return 0;
    for (const std::uint32_t lane : Bits(visit.leaves))
      leaf_.measureTriangles(*a_voxel_, visit, lane, cut, list,
                             [this](const ObstacleSphere& sphere) { return spaces_.childOf(sphere); });
    return visit.leaves;
  }

  /// Leaves out children that are surely nearer than a distance measured before. The farthest are measured first.
  void leaveNearer(DistanceVisit& visit) const
  {
    std::sort(visit.order.begin(), visit.order.begin() + visit.node->count, [&](std::uint8_t x, std::uint8_t y) {
      return visit.cut[x] > visit.cut[y] || (visit.cut[x] == visit.cut[y] && x < y);
    });
    std::uint32_t wanted = 0;
    for (std::uint32_t lane = 0; lane < visit.node->count; ++lane)
      wanted |= (query_.exceeds(visit.cut[lane]) ? 0u : 1u) << lane;
    for (DistanceRow& row : visit.rows) row.lanes &= wanted;
  }

  /// Whether all of a list are leaves of voxels: where the walk may stop, it may not have opened all.
  static bool areLeavesOfPoints(const std::vector<NearSphere>& list)
  {
    return std::all_of(list.begin(), list.end(),
                       [](const NearSphere& near) { return near.sphere.level > 0 && near.sphere.isLeaf(); });
  }

  /// Bounds the distances from the children of the visit that are in `lanes` to a sphere of b.
  DistanceRow compare(DistanceVisit& visit, const ObstacleSphere& sphere, std::uint32_t lanes)
  {
    pulse_.step();
    const CarriedNode& own = spaces_.carried(visit, sphere.obstacle);
    const DistanceObstacle& obstacle = spaces_[sphere.obstacle];
    const Node& node = *sphere.node;
    const float radius = node.r[sphere.lane] * obstacle.frame.stretch_b;
    DistanceRow row{sphere, lanes, {}, {}, 0};
    boundChildren(visit, own, obstacle, {node.x[sphere.lane], node.y[sphere.lane], node.z[sphere.lane]}, radius,
                  difference_bound_.isPossible(), row.lower);
    found.work.node_pairs += static_cast<std::uint64_t>(std::popcount(lanes));
    if (HWY_UNLIKELY(radius > visit.large_leaf) && sphere.level > 0 && sphere.isLeaf() && !query_.pairs.haveRadii() &&
        visit.areSmall(lanes & notAbove(row.lower, visit.cut), radius)) {
      boundByPoints(visit, own, obstacle, sphere.leaf(*obstacle.voxel), difference_bound_.isPossible(), row.lower);
      found.work.node_pairs += node.comparedPoints(sphere.lane);
    }
    CrossedSlabs held = {};
    if (obstacle.slabs) raiseBySlabs(own, obstacle, held = obstacle.slabsOf(sphere), row.lower);
    if (b_.storage.view.triangles && sphere.level > 0 && sphere.isLeaf() && isLargeBall(visit, sphere)) {
      const LeafRange leaf = sphere.leaf(*obstacle.voxel);
      const std::uint32_t asked = isThin(visit, obstacle, held) ? 1 : leaf.count;
      boundByTriangles(
          visit, own, obstacle, asked, difference_bound_.isPossible(), asked == leaf.count ? row.lower : nullptr,
          [&](std::uint32_t j) -> const FlatRecord& { return scratch_.flat.of(b_.storage.view, leaf, j); });
      found.work.node_pairs += asked;
    }
    if (compares_slabs_) {
      std::copy_n(row.lower, kLanes, row.about_center);
      if (obstacle.voxel && isFar(row.lower, visit.node->count, radius * obstacle.most))
        raiseByBothSlabs(spaces_.carriedSlabs(visit, sphere.obstacle, *a_voxel_), obstacle,
                         spaces_.slabOfSphere(sphere, radius), row.lower);
    }
    if (radius <= obstacle.blunt_radius && obstacle.voxel) compareAsGiven(visit, own, row);
    return row;
  }

  /// Whether a leaf of triangles has a ball that is large beside the smallest child.
  bool isLargeBall(const DistanceVisit& visit, const ObstacleSphere& sphere) const
  {
    const Voxel& voxel = *spaces_[sphere.obstacle].voxel;
    const double smallest = double{*std::min_element(visit.node->r, visit.node->r + visit.node->count)};
    return sphere.leaf(voxel).largestRadius() > kLargeBall * smallest * a_voxel_->frame.unit;
  }

  /// Whether both slabs of a leaf are thinner than the least upper bound of a child's distance. Then one triangle of
  /// the leaf tells how far the leaf is at most, and the others tell little more than its slabs.
  static bool isThin(const DistanceVisit& visit, const DistanceObstacle& obstacle, const CrossedSlabs& held)
  {
    return obstacle.cross_slabs &&
           held.thickness() < *std::min_element(visit.cut, visit.cut + visit.node->count) * obstacle.at_most_inside;
  }

  /// Sharpens the bounds of children which float arithmetic cannot tell from the row's sphere by the points as given.
  void compareAsGiven(DistanceVisit& visit, const CarriedNode& own, DistanceRow& row)
  {
    const DistanceObstacle& obstacle = spaces_[row.sphere.obstacle];
    GivenSphere other;
    for (const std::uint32_t lane : Bits(row.lanes & notAbove(row.lower, visit.cut))) {
      if (own.r[lane] > obstacle.blunt_radius) continue;
      ++found.work.exact_decisions;
      if (!other.isKnown()) other = givenSphereOf(b_.storage.view, *obstacle.voxel, *row.sphere.node, row.sphere.lane);
      const GivenSphere sphere = givenSphereOf(a_.storage.view, *a_voxel_, *visit.node, lane);
      const ExactDistance::Enclosure between = query_.pairs.distance.ofPoints().enclose(sphere.center, other.center);
      const double radii = (sphere.radius + other.radius) * (1.0 + 2 * kPoseStretch);
      const double lower = (between.low - radii - kFewDoubleRoundings * (between.high + radii)) / unit_;
      const double upper = (between.high + radii) * (1.0 + kFewDoubleRoundings) / unit_;
      if (!(std::isfinite(lower) && std::isfinite(upper))) continue;
      row.as_given |= 1u << lane;
      row.lower[lane] = std::max(orNone(row.lower[lane]), roundDown(lower));
      visit.cut[lane] = std::min(visit.cut[lane], roundUp(upper));
    }
  }

  /// The children that a sphere of b may hold a nearest point for.
  std::uint32_t nearLanes(const DistanceVisit& visit, const DistanceRow& row) const
  {
    const std::uint32_t near = row.lanes & notAbove(row.lower, visit.cut);
    if (!difference_bound_.isPossible()) return near;
    return near & (notAbove(compares_slabs_ ? row.about_center : row.lower, visit.limit) | row.as_given);
  }

  /// Keeps a sphere of b for those children that it matters to, or opens it: where it is larger than they are, and for
  /// leaves.
  void take(DistanceVisit& visit, const DistanceRow& row)
  {
    const std::uint32_t near = nearLanes(visit, row);
    if (near == 0) return;
    const std::uint32_t opening =
        isOpened(row.sphere) ? near & (visit.leaves | smallerLanes(visit, row.sphere, near & ~visit.leaves)) : 0;
    if ((near & ~opening) != 0) {
      visit.kept.push_back(row);
      visit.kept.back().lanes = near & ~opening;
    }
    if (opening == 0) return;
    const ObstacleSphere below = spaces_.childOf(row.sphere);
    const CarriedNode& own = spaces_.carried(visit, below.obstacle);
    const DistanceObstacle& obstacle = spaces_[below.obstacle];
    const Node& node = *below.node;
    float cut = -std::numeric_limits<float>::infinity();
    for (const std::uint32_t lane : Bits(opening)) cut = std::max(cut, visit.cut[lane]);
    const float reach = (own.radius + cut * obstacle.at_most_inside + obstacle.slack) * (1.0f + kReachMargin);
    alignas(32) float gap[kLanes];
    found.work.node_pairs += node.count;
    std::uint32_t children = spheresNear({node.x, node.y, node.z, node.r, obstacle.frame.stretch_b},
                                         {own.center.x, own.center.y, own.center.z, reach, 0.0f}, gap) &
                             firstBits(node.count);
    while (children != 0) { // the nearest first: it lowers the cut
      const std::uint32_t lane = smallestLane(gap, children);
      children &= ~(1u << lane);
      ObstacleSphere child = below;
      child.lane = static_cast<std::uint16_t>(lane);
      take(visit, compare(visit, child, opening));
    }
  }

  /// Whether a sphere of b has spheres below it that the walk may look at.
  bool isOpened(const ObstacleSphere& sphere) const
  {
    if (sphere.level > 0) return !sphere.isLeaf() && sphere.level < rule_.deepest;
    return !sphere.isLeaf() ||
           rule_.mayEnter([&] { return b_.storage.pointsToBuild(sphere.node->begin[sphere.lane]); });
  }

  /// The children of the visit among these that are smaller than the sphere.
  std::uint32_t smallerLanes(DistanceVisit& visit, const ObstacleSphere& sphere, std::uint32_t among)
  {
    if (among == 0) return 0;
    const CarriedNode& own = spaces_.carried(visit, sphere.obstacle);
    const float radius = sphere.node->r[sphere.lane];
    const float times = leaves_alone_ && sphere.level > 0 && spaces_[sphere.obstacle].is_plain ? kWide : 1.0f;
    std::uint32_t smaller = 0;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) smaller |= (own.r[lane] * times < radius ? 1u : 0u) << lane;
    return smaller & among;
  }

  template <class Visit>
  void forAll(const Visit& visit)
  {
    a_.storage.forEachRecord(voxel_, visit);
  }

  /// Writes that a point is farther than max_distance.
  void setBeyond(std::uint32_t record)
  {
    sheet_.set(record, std::numeric_limits<double>::quiet_NaN(), kNothing, {max_, kInfinity});
  }

  void leave(std::uint32_t begin, std::uint32_t end, const std::vector<NearSphere>& list, float cut)
  {
    float lower = std::numeric_limits<float>::infinity();
    for (const NearSphere& near : list) lower = std::min(lower, near.lower);
    const Interval interval = certain(lower, cut);
    for (std::uint32_t i = begin; i < end; ++i) leave(a_voxel_->records()[i], interval);
  }

  void leave(std::uint32_t record, const Interval& interval)
  {
    found.undecided = true;
    Interval& known = sheet_.interval[record];
    known = {std::max(known.lower, interval.lower), std::min(known.upper, interval.upper)};
  }

  /// The interval of points that have not been measured. Points of b beyond max_distance have not been looked at, and
  /// may be the nearest all the same.
  Interval certain(float lower, float upper) const
  {
    const double low = double{lower} * unit_, high = double{upper} * unit_;
    return {std::min(low, std::nextafter(max_, 0.0)), high >= max_ ? kInfinity : high};
  }

  const DistancesQuery& query_;
  const StopRule& rule_;
  const DistanceSheet& sheet_;
  DistanceScratch& scratch_;
  EnteredSpaces spaces_;
  const Spaces &a_, &b_;
  const double unit_; ///< of bounds, in the clouds' unit
  const double max_;
  const bool compares_slabs_; ///< of both sides: a is of triangles, b is not of balls
  DistanceLeaf leaf_;
  ListWalk<DistanceVisit> walk_;
  bool leaves_alone_ = false;        ///< whether DistanceLeaf::measureAlone() may measure leaves
  DifferenceBound difference_bound_; ///< of the voxel of a
  double radius_unit_ = 0.0;         ///< lower bound of a length of 1 in it, in the walk's unit
  std::uint32_t voxel_ = kNoVoxel;   ///< of a
  const Voxel* a_voxel_ = nullptr;
  WorkPulse pulse_{found.work};
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
