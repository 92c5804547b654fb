// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/brute_force/brute_force.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/distances/check_distances.h>
#include <pcl_bsh/distances/greatest_distance.h>
#include <pcl_bsh/flags/check_request.h>
#include <pcl_bsh/pairs/check_request.h>
#include <pcl_bsh/query/brute_force_points.h>
#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/query/uncertain.h>

#include <cmath>

namespace pcl_bsh::brute_force {
namespace {

/// Calls visit(p, q, verdict) for every pair, in ascending order, until it answers false. A pair is undecided if it may
/// collide, but does not wherever its points truly are.
template <class Visit>
void forEachPair(const Placed& a, const Placed& b, double clearance, const Visit& visit)
{
  const RecordDistance distance(a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose);
  const double of_a = a.hierarchy().view().uncertainty, of_b = b.hierarchy().view().uncertainty;
  const bool uncertain = areUncertain(a, b);
  const std::vector<FinitePoint> obstacles = finitePoints(b.hierarchy().view());
  for (const FinitePoint& p : finitePoints(a.hierarchy().view())) {
    for (const FinitePoint& q : obstacles) {
      const auto collide = [&](double sign) {
        const RecordDistance::Sum reach = {
            clearance, p.radius, q.radius, sign * of_a, sign * of_b, sign * p.uncertainty, sign * q.uncertainty};
        return distance.compare({p.record, q.record}, reach) <= 0;
      };
      Verdict verdict = Verdict::free;
      if (uncertain)
        verdict = collide(-1.0) ? Verdict::colliding : collide(1.0) ? Verdict::undecided : Verdict::free;
      else if (distance.compare({p.record, q.record}, clearance) <= 0)
        verdict = Verdict::colliding;
      if (!visit(p, q, verdict)) return;
    }
  }
}

} // namespace

AnyResult anyCollision(const Placed& a, const Placed& b, const AnyRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  AnyResult result;
  forEachPair(a, b, request.clearance, [&](const FinitePoint& p, const FinitePoint& q, Verdict verdict) {
    ++result.work.exact_decisions;
    if (verdict != Verdict::free) result.verdict = verdict;
    if (verdict != Verdict::colliding) return true;
    result.pair = PointPair{p.record, q.record};
    return false;
  });
  return result;
}

/// Free points of a that may be within the clearance of a patch of b's surface.
void guardDensity(const Placed& a, const Placed& b, const FlagsRequest& request, std::vector<Verdict>& flags)
{
  const RecordDistance distance(a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose);
  const PointsView &of_a = a.hierarchy().view(), &of_b = b.hierarchy().view();
  const PairReach reach(of_a, of_b, request.clearance, MeantPlaces::covered, {request.spacings_of_b, of_b.count});
  for (const FinitePoint& p : finitePoints(of_a))
    for (const FinitePoint& q : finitePoints(of_b))
      if (flags[p.record] == Verdict::free && reach.holds(distance, {p.record, q.record}))
        flags[p.record] = Verdict::sparse;
}

FlagsResult collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  FlagsResult result;
  std::vector<Verdict> flags_a(a.hierarchy().view().count);
  std::vector<Verdict> flags_b(b.hierarchy().view().count);
  forEachPair(a, b, request.clearance, [&](const FinitePoint& p, const FinitePoint& q, Verdict verdict) {
    ++result.work.exact_decisions;
    flags_a[p.record] = graver(flags_a[p.record], verdict);
    flags_b[q.record] = graver(flags_b[q.record], verdict);
    return true;
  });
  const auto asked = [&](Flagged side) {
    return (static_cast<unsigned>(request.flagged) & static_cast<unsigned>(side)) != 0;
  };
  if (asked(Flagged::a)) {
    if (request.spacings_of_b) guardDensity(a, b, request, flags_a);
    result.sparse_a = countOf(flags_a, Verdict::sparse);
    result.colliding_a = countOf(flags_a, Verdict::colliding);
    result.undecided_a = countOf(flags_a, Verdict::undecided);
    result.a = std::move(flags_a);
  }
  if (asked(Flagged::b)) {
    result.colliding_b = countOf(flags_b, Verdict::colliding);
    result.undecided_b = countOf(flags_b, Verdict::undecided);
    result.b = std::move(flags_b);
  }
  return result;
}

DistanceResult closestPair(const Placed& a, const Placed& b, const DistanceRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  const RecordDistance distance(a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose);
  const std::vector<FinitePoint> obstacles = finitePoints(b.hierarchy().view());
  DistanceResult result;
  RecordDistance::Pair closest;
  for (const FinitePoint& p : finitePoints(a.hierarchy().view())) {
    for (const FinitePoint& q : obstacles) {
      ++result.work.exact_decisions;
      const RecordDistance::Pair pair = distance.pair({p.record, q.record});
      if (result.pair && distance.compareGaps(pair, closest) >= 0) continue;
      if (!result.pair && std::isfinite(request.max_distance) && distance.compare(pair, request.max_distance) > 0)
        continue;
      closest = pair;
      result.pair = PointPair{p.record, q.record};
    }
  }
  if (result.pair) result.distance = distance.gap(closest);
  return result;
}

PointDistances pointDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  const RecordDistance distance(a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose);
  PointDistances result;
  result.distance.assign(a.hierarchy().view().count, std::numeric_limits<double>::quiet_NaN());
  result.closest_point.assign(a.hierarchy().view().count, kNothing);
  const std::vector<FinitePoint> others = finitePoints(b.hierarchy().view());
  for (const FinitePoint& p : finitePoints(a.hierarchy().view())) {
    const FinitePoint* nearest = nullptr;
    const auto pairWith = [&](const FinitePoint& q) { return distance.pair({p.record, q.record}); };
    for (const FinitePoint& q : others) {
      ++result.work.exact_decisions;
      if (!nearest || distance.compareGaps(pairWith(q), pairWith(*nearest)) < 0) nearest = &q;
    }
    if (!nearest) continue;
    if (distance.compare(pairWith(*nearest), request.max_distance) > 0) continue;
    result.distance[p.record] = distance.gap(pairWith(*nearest));
    result.closest_point[p.record] = nearest->record;
  }
  findGreatest(a, b, result);
  return result;
}

} // namespace pcl_bsh::brute_force
