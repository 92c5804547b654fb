// SPDX-License-Identifier: BSD-3-Clause
// First contacts and flags are found in one way. The pairs of points that can meet at all within an interval are
// collected, and each pair is followed by itself. Where they are too many, the interval is halved, and they get fewer.
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/pairs/any_at_places.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/scene/swept/sweep.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

class Sweep {
public:
  Sweep(const SweptPart& a, const SweptPart& b, double clearance, double tolerance, MeantPlaces places, Work& work)
  : a_(a),
    b_(b),
    clearance_(clearance),
    places_(places),
    reach_of_pairs_(a.hierarchy.view(), b.hierarchy.view(), clearance, places),
    farthest_(Reach(clearance, a.hierarchy.storage().uncertainty, b.hierarchy.storage().uncertainty, places).most),
    tolerance_(tolerance),
    angle_(std::max(a.motion.angle(), b.motion.angle())),
    work_(work)
  {
  }

  std::optional<PairContact> first()
  {
    const AnyResult start = anyCollisionAt(a_.at(0), b_.at(0), {clearance_, {}}, places_);
    work_ += start.work;
    if (start.pair) return PairContact{0.0, *start.pair};
    std::optional<PairContact> earliest;
    eachPart(0.0, 1.0, [&](double begin, double end, const PairsWithin& found) {
      earliest = found.complete ? firstOf(found, begin, end) : firstOfCrowd(begin, end);
      return earliest.has_value();
    });
    return earliest;
  }

  void flag(std::vector<Verdict>& flags_a, std::vector<Verdict>& flags_b)
  {
    flags_a_ = &flags_a;
    flags_b_ = &flags_b;
    eachPart(0.0, 1.0, [&](double begin, double end, const PairsWithin& found) {
      if (found.complete)
        flagPairs(found, begin, end);
      else
        flagCrowd(begin, end);
      return false;
    });
  }

private:
  /// The distance at the interval's beginning of all pairs that can meet within it.
  double reach(double length) const
  {
    return std::max(0.0, farthest_ + closingReach(a_.motion, b_.motion, length) + 0.5 * tolerance_);
  }
  bool isShort(double length) const { return closingReach(a_.motion, b_.motion, length) <= 0.5 * tolerance_; }
  bool isWide(double length, const PairsWithin& found) const
  {
    return angle_ * length > kWideTurn && found.pairs.size() > kFewToTurn;
  }

  /// Calls visit(begin, end, found) with the pairs that can meet in an interval. Where these are too many, calls it for
  /// the halves, in their order, until it returns true.
  template <class Visit>
  bool eachPart(double begin, double end, const Visit& visit)
  {
    const PairsWithin found = pairsWithin(a_.at(begin), b_.at(begin), {reach(end - begin), kMostPairs});
    work_ += found.work;
    if ((!found.complete || isWide(end - begin, found)) && !isShort(end - begin)) {
      const double middle = 0.5 * (begin + end);
      return eachPart(begin, middle, visit) || eachPart(middle, end, visit);
    }
    return visit(begin, end, found);
  }

  /// None where no distance is near enough. Rounding may make a reach of 0 slightly negative: it counts as 0, and the
  /// tolerance covers that.
  std::optional<ContactZone> zone(PointPair pair) const
  {
    const double reach = reachOf(reach_of_pairs_.of(pair));
    if (reach < -0.25 * tolerance_) return std::nullopt;
    return ContactZone{std::max(0.0, reach), tolerance_};
  }

  std::optional<PairContact> firstOf(const PairsWithin& found, double begin, double end) const
  {
    std::optional<PairContact> earliest;
    for (const PointPair pair : found.pairs) {
      const std::optional<ContactZone> near = zone(pair);
      if (!near) continue;
      const auto s = timeOfContact(a_.motion, a_.corners(pair.a), b_.motion, b_.corners(pair.b), *near, begin,
                                   earliest ? earliest->s : end);
      if (s && (!earliest || *s < earliest->s || (*s == earliest->s && pair < earliest->pair)))
        earliest = PairContact{*s, pair};
    }
    return earliest;
  }

  /// The clearance at the interval's beginning that covers all collisions within so short an interval.
  double wideClearance(double begin, double end) const
  {
    return clearance_ + closingReach(a_.motion, b_.motion, end - begin) + 0.5 * tolerance_;
  }

  /// Returns any pair that can collide, where so many can within so short an interval that their order does not matter.
  /// Pairs collected may be farther apart than their own uncertainties let them be.
  std::optional<PairContact> firstOfCrowd(double begin, double end)
  {
    const AnyResult near = anyCollisionAt(a_.at(begin), b_.at(begin), {wideClearance(begin, end), {}}, places_);
    work_ += near.work;
    if (!near.pair) return std::nullopt;
    return PairContact{begin, *near.pair};
  }

  void flagCrowd(double begin, double end)
  {
    FlagsRequest wide;
    wide.clearance = wideClearance(begin, end);
    wide.flagged = Flagged::both;
    const FlagsResult near = collisionFlags(a_.at(begin), b_.at(begin), wide);
    work_ += near.work;
    take(near.a, *flags_a_);
    take(near.b, *flags_b_);
  }

  void flagPairs(const PairsWithin& found, double begin, double end)
  {
    for (const PointPair pair : found.pairs) {
      Verdict &flag_a = (*flags_a_)[pair.a], &flag_b = (*flags_b_)[pair.b];
      if (flag_a != Verdict::free && flag_b != Verdict::free) continue;
      const std::optional<ContactZone> near = zone(pair);
      if (!near) continue;
      const Corners a = a_.corners(pair.a), b = b_.corners(pair.b);
      const double now = separationOf(placedBy(a_.motion.at(begin), a), placedBy(b_.motion.at(begin), b)).high;
      if (now <= near->inner() || timeOfContact(a_.motion, a, b_.motion, b, *near, begin, end))
        flag_a = flag_b = Verdict::colliding;
    }
  }

  /// Adds the verdicts at a pose.
  void take(const std::vector<Verdict>& verdicts, std::vector<Verdict>& flags) const
  {
    for (std::size_t i = 0; i < verdicts.size(); ++i)
      if (verdicts[i] == Verdict::colliding || (verdicts[i] == Verdict::undecided && places_ == MeantPlaces::possible))
        flags[i] = Verdict::colliding;
  }

  const SweptPart &a_, &b_;
  const double clearance_;
  const MeantPlaces places_;
  const PairReach reach_of_pairs_;
  const double farthest_; ///< no pair has a greater reach, radii not included
  const double tolerance_, angle_;
  Work& work_;
  std::vector<Verdict>*flags_a_ = nullptr, *flags_b_ = nullptr;
};

} // namespace

double closingReach(const ObjectMotion& a, const ObjectMotion& b, double length)
{
  const double straight = (a.shift() - b.shift()).norm() * length;
  return (straight + a.turningReach(length) + b.turningReach(length)) * (1.0 + kDoubleMargin);
}

std::optional<PairContact> firstContactOf(const SweptPart& a, const SweptPart& b, double clearance, double tolerance,
                                          MeantPlaces places, Work& work)
{
  return Sweep(a, b, clearance, tolerance, places, work).first();
}

void flagContacts(const SweptPart& a, const SweptPart& b, double clearance, double tolerance, MeantPlaces places,
                  std::vector<Verdict>& flags_a, std::vector<Verdict>& flags_b, Work& work)
{
  Sweep(a, b, clearance, tolerance, places, work).flag(flags_a, flags_b);
}

} // namespace pcl_bsh
