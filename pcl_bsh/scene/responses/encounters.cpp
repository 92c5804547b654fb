// SPDX-License-Identifier: BSD-3-Clause
// Collects the pairs that a mover may meet on its way.
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/scene/responses/mover.h>
#include <pcl_bsh/scene/responses/straight_ways.h>
#include <pcl_bsh/scene/swept/conservative_advancement.h>

#include <algorithm>

namespace pcl_bsh {

/// Collects all pairs of points that can meet while the object is within `swept` and goes by the passage. @return false
/// where too many of one other part are near
bool Mover::collect(Box3 swept, const Passage& passage)
{
  encounters_.clear();
  if (passage.until_met) first_contact_ = passage.until_met->end;
  near_ = 0;
  collected_at_ = pose();
  if (body_.box.empty()) return true;
  swept.grow(state_.rules.largestClearance() * (1.0 + kDoubleMargin) + tolerance_);
  state_.grid.around(swept, around_);
  for (const ObjectId other : around_) {
    if (other == object_) continue;
    const std::optional<double> clearance = state_.rules.clearanceOf(object_, other);
    if (!clearance || !swept.meets(state_.bodies[other].world_box)) continue;
    if (!collectFrom(other, *clearance, passage)) return false;
    if (outcome.stuck) return true;
  }
  return true;
}

bool Mover::collectFrom(ObjectId other, double clearance, const Passage& passage)
{
  for (std::uint32_t i = 0; i < body_.world.size(); ++i)
    for (std::uint32_t j = 0; j < state_.bodies[other].world.size(); ++j) {
      const Placed mine = state_.placed(object_, i), others = state_.placed(other, j);
      const MeantPlaces places = possiblePlaces(mine, others);
      const Reach farthest(clearance, mine.hierarchy().storage().uncertainty, others.hierarchy().storage().uncertainty,
                           places);
      constexpr double halting = 0.75; // tolerances beyond the reach: halts are at half of one
      const StraightWays ways = waysOf(passage.ways, body_.object.parts[i].pose);
      const PointsView &a = mine.hierarchy().view(), &b = others.hierarchy().view();
      const RecordDistance exact(a, mine.pose, b, others.pose);
      const PairReach reach_of_pairs(a, b, clearance, places);
      const bool of_points = !a.triangles && !b.triangles;
      const bool is_one = reach_of_pairs.isOne() && !a.radii && !b.radii;
      const double one_reach = is_one ? reachOf(reach_of_pairs.of({})) : 0.0;
      const auto take = [&](PointPair pair) {
        if (outcome.stuck) return 0.0;
        const double share = passage.until_met ? passage.until_met->shareAt(first_contact_) : 1.0;
        const Point3 p = a.point(pair.a), q = b.point(pair.b);
        const Eigen::Vector3d at(p[0], p[1], p[2]);
        Encounter e{pair,      i,         other, j, is_one ? one_reach : reachOf(reach_of_pairs.of(pair)),
                    clearance, of_points, {},    {}};
        e.apart = mine.pose * at - others.pose * Eigen::Vector3d(q[0], q[1], q[2]);
        if (of_points && leastOnWay(e.apart, share * ways.way(at)) > e.reach + ways.stray + halting * tolerance_)
          return share;
        if ((of_points ? e.apart.norm() : separationOf(e).high) <= e.reach + 0.125 * tolerance_) {
          ++cost_.work.exact_decisions;
          if (reach_of_pairs.holds(exact, pair)) {
            outcome.stuck = true;
            touch(e);
            return 0.0;
          }
        }
        if (passage.until_met) {
          const RigidMotion& motion = *passage.until_met->motion;
          e.meets = motion.turns() ? contactOn(motion, e, passage.until_met->begin, first_contact_)
                                   : contactOn(motion, passage.ways.shift, e, Eigen::Vector3d::Zero(), first_contact_);
          if (e.meets && *e.meets < first_contact_) first_contact_ = *e.meets;
        }
        encounters_.push_back(e);
        return passage.until_met ? passage.until_met->shareAt(first_contact_) : 1.0;
      };
      const PairsWithin found =
          pairsAlong(mine.hierarchy(), ways, others, {farthest.most + halting * tolerance_, passage.most},
                     passage.most_leaf_pairs, take);
      near_ = std::max(near_, found.pairs.size());
      ++cost_.pairs;
      cost_.work += found.work;
      if (outcome.stuck) return true;
      if (!found.complete) {
        crowded_ = other;
        return false;
      }
    }
  outcome.stuck = isInside(other);
  return true;
}

/// Whether the object begins inside of the other one, or round it. This is asked once: since then the object has not
/// met the other's surface.
bool Mover::isInside(ObjectId other)
{
  if (state_.solids.none() || std::find(outside_of_.begin(), outside_of_.end(), other) != outside_of_.end())
    return false;
  for (std::uint32_t i = 0; i < body_.world.size(); ++i)
    for (std::uint32_t j = 0; j < state_.bodies[other].world.size(); ++j) {
      if (!state_.areSolid({object_, other, i, j})) continue;
      if (!state_.solids.find(state_.standing(object_, i), state_.standing(other, j), std::nullopt, cost_.work))
        continue;
      outcome.touched = true;
      outcome.against = other;
      return true;
    }
  outside_of_.push_back(other);
  return false;
}

} // namespace pcl_bsh
