// SPDX-License-Identifier: BSD-3-Clause
// The walk that measures the points of one voxel of a. A node's list holds the spheres of b that can hold the nearest
// point of one of its points: their lower bounds do not exceed the least upper bound of all, because every sphere holds
// a point. The list begins with the spheres above the voxels of b, and becomes finer as the nodes of a become smaller.

#if defined(PCL_BSH_DISTANCES_DISTANCE_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_DISTANCE_WALK_INL_H_
#undef PCL_BSH_DISTANCES_DISTANCE_WALK_INL_H_
#else
#define PCL_BSH_DISTANCES_DISTANCE_WALK_INL_H_
#endif

#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/distances/distance_leaf-inl.h>
#include <pcl_bsh/distances/outdoing.h>
#include <pcl_bsh/distances/voxel_bounds-inl.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/query/progress.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

class DistanceWalk : public ListVisitor<DistanceVisit> {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr float kWide = 3.0f;       ///< wider than children by this, spheres are opened for them
  static constexpr std::uint32_t kAbove = 0; ///< the obstacle above the voxels of b

public:
  DistanceWalk(const DistancesQuery& query, const StopRule& rule, const DistanceSheet& sheet, DistanceScratch& scratch)
  : query_(query),
    rule_(rule),
    sheet_(sheet),
    scratch_(scratch),
    obstacles_(scratch.obstacles),
    a_(query.a),
    b_(query.b),
    unit_(query.unit),
    max_(query.pairs.reach.most),
    compares_slabs_(a_.storage.view.triangles && !b_.storage.view.areBalls()),
    leaf_(query, sheet, scratch, found.work),
    walk_(rule, found.work.node_pairs, scratch.visits)
  {
    forgetObstacles();
    scratch_.flat.prepare(b_.storage);
    if (scratch_.obstacle_of.size() < b_.storage.voxel_count) scratch_.obstacle_of.resize(b_.storage.voxel_count);
  }
  ~DistanceWalk() { forgetObstacles(); }
  DistanceWalk(const DistanceWalk&) = delete;
  DistanceWalk& operator=(const DistanceWalk&) = delete;

  /// Measures the points of one voxel of a. @pre neither cloud is empty
  void run(std::uint32_t voxel)
  {
    voxel_ = voxel;
    addObstacle(kAboveVoxels, nullptr);
    // A quotient that vanished would bound what is beyond a limit above 0.
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
      outdoing_ = Outdoing(extentBelow(root) * b_.frame(kAboveVoxels).unit / unit_ * stretch * stretch, least);
    radius_unit_ = a_.frame(voxel).unit / unit_ / stretch;
    leaves_alone_ = !rule_.mayStop() && !outdoing_.isPossible() && leaf_.mayMeasureBelow();
    scratch_.roots.clear();
    const float least = query_.pairs.mayOverlap() ? -std::numeric_limits<float>::infinity() : 0.0f;
    for (std::uint16_t lane = 0; lane < root.count; ++lane) scratch_.roots.push_back({{&root, lane, 0, kAbove}, least});
    walk_.descend(*this, Part{NodeInSphere::rootOf(*a_voxel_), cut}, scratch_.roots);
  }

  // As ListWalk asks.

  /// A node of a. No point below it is farther from its nearest than the cut, unless that exceeds the greatest
  /// distance.
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
    for (std::uint32_t lane = 0; outdoing_.isPossible() && lane < kLanes; ++lane)
      visit.turn[lane] = outdoing_.turnOf(part.node.r[lane] * radius_unit_);
    const std::uint32_t others =
        firstBits(part.node.count) & ~measureAlone(visit, list, part.cut) & ~measureTriangles(visit, list, part.cut);
    if (others == 0) return 0;
    for (const NearSphere& near : list) visit.rows.push_back(compare(visit, near.sphere, others));
    if (query_.reached) leaveNearer(visit);
    for (const DistanceRow& row : visit.rows) take(visit, row);
    for (const DistanceRow& row : visit.kept)
      for (std::uint32_t bits = nearLanes(visit, row); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
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
    addObstacle(kAboveVoxels, nullptr);
    return double{boundVoxel(std::numeric_limits<float>::infinity()).upper} * unit_;
  }

  MeasuredVoxel found;

private:
  /// Whether the walk may go below the voxel of a, and has the time to build it.
  bool mayEnter() const
  {
    return !rule_.isSpent(found.work.node_pairs) && rule_.mayEnter([this] { return a_.storage.pointsToBuild(voxel_); });
  }

  /// Of the voxels of b, from the voxel of a.
  VoxelBounds bounds() { return {obstacles_[kAbove], b_, found.work}; }

  /// How near and how far they are from the sphere of the whole voxel of a.
  VoxelBounds::Range boundVoxel(float cut)
  {
    ++found.work.volumes_carried;
    return bounds().range(a_.storage.voxels[voxel_].radius, cut);
  }

  /// Measures the leaves of a visit that go through its list by themselves: eight spheres at once, and the points of
  /// the nearest bound what is left better than spheres do.
  /// @return them
  std::uint32_t measureAlone(const DistanceVisit& visit, const std::vector<NearSphere>& list, float cut)
  {
    const std::uint32_t alone = leavesAlone(visit, list);
    if (alone != 0) leaf_.gather(list);
    for (std::uint32_t bits = alone; bits != 0; bits &= bits - 1)
      leaf_.measureBelow(*a_voxel_, visit, static_cast<std::uint32_t>(std::countr_zero(bits)), cut);
    return alone;
  }

  /// Measures the leaves of triangles: each of these goes down from the list by itself.
  /// @return them
  std::uint32_t measureTriangles(const DistanceVisit& visit, const std::vector<NearSphere>& list, float cut)
  {
    if (!a_.storage.view.triangles || rule_.mayStop()) return 0;
    for (std::uint32_t bits = visit.leaves; bits != 0; bits &= bits - 1)
      leaf_.measureTriangles(*a_voxel_, visit, static_cast<std::uint32_t>(std::countr_zero(bits)), cut, list,
                             [this](const ObstacleSphere& sphere) { return childOf(sphere); });
    return visit.leaves;
  }

  /// Those to which none of the list's spheres is above a voxel, in another unit, or to be told apart by the points as
  /// given.
  std::uint32_t leavesAlone(const DistanceVisit& visit, const std::vector<NearSphere>& list) const
  {
    if (!leaves_alone_ || visit.leaves == 0) return 0;
    float least = 0.0f;
    for (const NearSphere& near : list) {
      const ObstacleSphere& sphere = near.sphere;
      const DistanceObstacle& obstacle = obstacles_[sphere.obstacle];
      if (sphere.level == 0 || !obstacle.is_plain) return 0;
      least = std::max(least, obstacle.blunt_radius);
      if (sphere.isLeaf()) least = std::max(least, sphere.node->r[sphere.lane] * (1.0f / kLargeLeaf));
    }
    std::uint32_t alone = 0;
    for (std::uint32_t lane = 0; lane < visit.node->count; ++lane)
      alone |= (visit.node->r[lane] > least ? 1u : 0u) << lane;
    return alone & visit.leaves;
  }

  /// Leaves out the children that a greater distance is known for. The farthest are measured first.
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
    const CarriedNode& own = carried(visit, sphere.obstacle);
    const DistanceObstacle& obstacle = obstacles_[sphere.obstacle];
    const Node& node = *sphere.node;
    const float radius = node.r[sphere.lane] * obstacle.frame.stretch_b;
    DistanceRow row{sphere, lanes, {}, {}, 0};
    boundChildren(visit, own, obstacle, {node.x[sphere.lane], node.y[sphere.lane], node.z[sphere.lane]}, radius,
                  outdoing_.isPossible(), row.lower);
    found.work.node_pairs += static_cast<std::uint64_t>(std::popcount(lanes));
    if (HWY_UNLIKELY(radius > visit.large_leaf) && sphere.level > 0 && sphere.isLeaf() && !query_.pairs.haveRadii() &&
        visit.areSmall(lanes & notAbove(row.lower, visit.cut), radius)) {
      boundByPoints(visit, own, obstacle, sphere.leaf(*obstacle.voxel), outdoing_.isPossible(), row.lower);
      found.work.node_pairs += node.comparedPoints(sphere.lane);
    }
    CrossedSlabs held = {};
    if (obstacle.slabs) raiseBySlabs(own, obstacle, held = obstacle.heldBy(sphere), row.lower);
    if (b_.storage.view.triangles && sphere.level > 0 && sphere.isLeaf() && isLargeBall(visit, sphere)) {
      const LeafRange leaf = sphere.leaf(*obstacle.voxel);
      const std::uint32_t asked = isThin(visit, obstacle, held) ? 1 : leaf.count;
      boundByTriangles(
          visit, own, obstacle, asked, outdoing_.isPossible(), asked == leaf.count ? row.lower : nullptr,
          [&](std::uint32_t j) -> const FlatRecord& { return scratch_.flat.of(b_.storage.view, leaf, j); });
      found.work.node_pairs += asked;
    }
    if (compares_slabs_) {
      std::copy_n(row.lower, kLanes, row.about_center);
      if (obstacle.voxel && isFar(row.lower, visit.node->count, radius * obstacle.most))
        raiseByBothSlabs(carriedSlabs(visit, sphere.obstacle), obstacle, slabOfSphere(sphere, radius), row.lower);
    }
    if (radius <= obstacle.blunt_radius && obstacle.voxel) compareAsGiven(visit, own, row);
    return row;
  }

  /// Whether a leaf of triangles has a ball that is large beside the smallest child.
  bool isLargeBall(const DistanceVisit& visit, const ObstacleSphere& sphere) const
  {
    const Voxel& voxel = *obstacles_[sphere.obstacle].voxel;
    const double smallest = double{*std::min_element(visit.node->r, visit.node->r + visit.node->count)};
    return sphere.leaf(voxel).largestRadius() > kLargeBall * smallest * a_voxel_->frame.unit;
  }

  /// Whether both slabs of a leaf are thinner than what its distance from a child may be: then one of its triangles
  /// tells how far it is at most, and the others tell little more than slabs.
  static bool isThin(const DistanceVisit& visit, const DistanceObstacle& obstacle, const CrossedSlabs& held)
  {
    return obstacle.cross_slabs &&
           held.thickness() < *std::min_element(visit.cut, visit.cut + visit.node->count) * obstacle.at_most_inside;
  }

  /// Sharpens the bounds of children which float arithmetic cannot tell from the row's sphere by the points as given.
  void compareAsGiven(DistanceVisit& visit, const CarriedNode& own, DistanceRow& row)
  {
    const DistanceObstacle& obstacle = obstacles_[row.sphere.obstacle];
    GivenSphere other;
    for (std::uint32_t bits = row.lanes & notAbove(row.lower, visit.cut); bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
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
    if (!outdoing_.isPossible()) return near;
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
    const ObstacleSphere below = childOf(row.sphere);
    const CarriedNode& own = carried(visit, below.obstacle);
    const DistanceObstacle& obstacle = obstacles_[below.obstacle];
    const Node& node = *below.node;
    float cut = -std::numeric_limits<float>::infinity();
    for (std::uint32_t bits = opening; bits != 0; bits &= bits - 1)
      cut = std::max(cut, visit.cut[std::countr_zero(bits)]);
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
    const CarriedNode& own = carried(visit, sphere.obstacle);
    const float radius = sphere.node->r[sphere.lane];
    const float times = leaves_alone_ && sphere.level > 0 && obstacles_[sphere.obstacle].is_plain ? kWide : 1.0f;
    std::uint32_t smaller = 0;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) smaller |= (own.r[lane] * times < radius ? 1u : 0u) << lane;
    return smaller & among;
  }

  /// The first child of a sphere that is opened. Entering a voxel builds it.
  ObstacleSphere childOf(const ObstacleSphere& sphere)
  {
    const Node& node = *sphere.node;
    if (sphere.level > 0) return sphere.below(obstacles_[sphere.obstacle].voxel->nodes[node.child[sphere.lane]], 0);
    if (!sphere.isLeaf()) return {&b_.storage.top[node.child[sphere.lane]], 0, 0, kAbove};
    const std::uint32_t voxel = node.begin[sphere.lane];
    if (scratch_.obstacle_of[voxel] == 0) {
      const Voxel* const entered = &b_.voxel(voxel, found.work);
      addObstacle(voxel, entered);
      scratch_.obstacle_of[voxel] = static_cast<std::uint32_t>(obstacles_.size() - 1);
    }
    const std::uint32_t obstacle = scratch_.obstacle_of[voxel];
    return {obstacles_[obstacle].voxel->nodes.data(), 0, 1, obstacle};
  }

  void addObstacle(std::uint32_t space, const Voxel* voxel)
  {
    const RelativeFrame frame(a_.frame(voxel_), a_.pose, b_.frame(space), b_.pose, query_.rotation);
    obstacles_.emplace_back(voxel, b_.frame(space), frame, unit_, a_.frame(voxel_).unit);
    obstacles_.back().space = space;
    if (voxel && b_.storage.view.triangles) {
      Voxel& entered = b_.storage.voxels[space];
      obstacles_.back().slabs = entered.slabs.of(*voxel, b_.storage.view, found.work);
      if (b_.storage.hasLongTriangles(space))
        obstacles_.back().cross_slabs = entered.cross_slabs.of(*voxel, b_.storage.view, found.work);
    }
    if (scratch_.leaves.size() < obstacles_.size()) scratch_.leaves.resize(2 * obstacles_.size());
  }

  /// The children of the visit in the frame of an obstacle.
  const CarriedNode& carried(DistanceVisit& visit, std::uint32_t obstacle)
  {
    if (visit.carried.size() <= obstacle) visit.carried.resize(2 * std::size_t{obstacle} + 8);
    CarriedNode& own = visit.carried[obstacle];
    if (own.stamp == visit.stamp) return own;
    own.stamp = visit.stamp;
    const RelativeFrame& frame = obstacles_[obstacle].frame;
    carry(frame.m.data(), frame.g.data(), visit.node->x, visit.node->y, visit.node->z, kLanes, own.x, own.y, own.z);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) own.r[lane] = visit.node->r[lane] * frame.stretch_a;
    own.center = carryPoint(frame.m.data(), frame.g.data(), visit.around.center);
    own.radius = visit.around.radius * frame.stretch_a;
    found.work.volumes_carried += visit.node->count + std::uint64_t{1};
    return own;
  }

  /// The same with their slabs. @pre compares_slabs_, and carried() for this visit
  const CarriedNode& carriedSlabs(DistanceVisit& visit, std::uint32_t obstacle)
  {
    CarriedNode& own = visit.carried[obstacle];
    if (own.slabs_stamp == visit.stamp) return own;
    own.slabs_stamp = visit.stamp;
    const auto index = visit.node - a_voxel_->nodes.data();
    const Slabs& slabs = a_.storage.voxels[voxel_].slabs.of(*a_voxel_, a_.storage.view, found.work)[index];
    carrySlabs(obstacles_[obstacle], slabs, own);
    return own;
  }

  /// Of a sphere below a voxel. @param radius of it, stretched
  Slab slabOfSphere(const ObstacleSphere& sphere, float radius)
  {
    const DistanceObstacle& obstacle = obstacles_[sphere.obstacle];
    const Voxel& voxel = *obstacle.voxel;
    const Node& node = *sphere.node;
    LazySlabs& slabs = b_.storage.voxels[obstacle.space].slabs;
    return slabOf(slabs.of(voxel, b_.storage.view, found.work)[&node - voxel.nodes.data()], sphere.lane,
                  {node.x[sphere.lane], node.y[sphere.lane], node.z[sphere.lane]}, radius);
  }

  void forgetObstacles() noexcept
  {
    for (const DistanceObstacle& obstacle : obstacles_)
      if (obstacle.space != kAboveVoxels) scratch_.obstacle_of[obstacle.space] = 0;
    obstacles_.clear();
  }

  template <class Visit>
  void forAll(const Visit& visit)
  {
    a_.storage.forEachRecord(voxel_, visit);
  }

  /// Farther than max_distance.
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

  /// Of points that have not been measured: what is beyond max_distance has not been looked at, and may be
  /// the nearest all the same.
  Interval certain(float lower, float upper) const
  {
    const double low = double{lower} * unit_, high = double{upper} * unit_;
    return {std::min(low, std::nextafter(max_, 0.0)), high >= max_ ? kInfinity : high};
  }

  const DistancesQuery& query_;
  const StopRule& rule_;
  const DistanceSheet& sheet_;
  DistanceScratch& scratch_;
  std::vector<DistanceObstacle>& obstacles_;
  const Spaces a_, b_;
  const double unit_; ///< of bounds, in the clouds' unit
  const double max_;
  const bool compares_slabs_; ///< of both sides: of triangles, and of triangles or points that are no balls
  DistanceLeaf leaf_;
  ListWalk<DistanceVisit> walk_;
  bool leaves_alone_ = false;      ///< whether leaves of a go through lists by themselves: see measureAlone()
  Outdoing outdoing_;              ///< of the voxel of a
  double radius_unit_ = 0.0;       ///< at most what a length of 1 in it is, in the walk's unit
  std::uint32_t voxel_ = kNoVoxel; ///< of a
  const Voxel* a_voxel_ = nullptr;
  WorkPulse pulse_{found.work};
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
