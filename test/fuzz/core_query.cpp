// SPDX-License-Identifier: BSD-3-Clause
// Any two clouds, poses and clearance, also where points and poses are uncertain: all queries against brute force, and
// both hierarchies validated.
#include "bytes.h"
#include "scene.h"
#include "support/question.h"
#include "target.h"

#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/geometry/exact_distance.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace pcl_bsh::fuzz {
namespace {

/// The answer of the query and of its twin, which must be equal: an answer, or a refusal in equal words.
template <class Query, class Twin>
auto compared(Query query, Twin twin)
{
  using Result = decltype(query());
  const auto outcome = [](auto& ask, std::string& refusal) {
    std::optional<Result> result;
    try {
      result = ask();
    }
    catch (const std::invalid_argument& error) {
      refusal = error.what();
    }
    return result;
  };
  std::string refusal, expected_refusal;
  const std::optional<Result> result = outcome(query, refusal), expected = outcome(twin, expected_refusal);
  require(refusal == expected_refusal, "query and brute force refuse differently");
  return std::pair{result, expected};
}

void requireSound(const SphereHierarchy& hierarchy)
{
  const HierarchyDefects defects = hierarchy.validate();
  require(defects.none(), defects.none() ? "" : defects.lines.front().c_str());
}

void compareAnswers(const Placed& a, const Placed& b, const test::Question& request)
{
  const auto [any, expected_any] =
      compared([&] { return anyCollision(a, b, request); }, [&] { return brute_force::anyCollision(a, b, request); });
  const bool sensible = std::isfinite(request.clearance) && request.clearance >= 0.0;
  require(sensible || !any, "a clearance that is negative or not finite was accepted");
  if (!any) return;
  require(any->verdict == expected_any->verdict, "anyCollision differs from brute force");
  require(any->pair.has_value() == (any->verdict == Verdict::colliding), "a witness belongs to a collision");
  if (any->pair) {
    const PointsView &p = a.hierarchy().view(), &q = b.hierarchy().view();
    const auto [i, j] = *any->pair;
    require(
        ExactDistance(a.pose, b.pose).compare(p.point(i), q.point(j), request.clearance, p.radius(i), q.radius(j)) <= 0,
        "the witness does not collide");
  }

  const auto [flags, expected_flags] = compared([&] { return collisionFlags(a, b, request); },
                                                [&] { return brute_force::collisionFlags(a, b, request); });
  require(flags->a == expected_flags->a && flags->b == expected_flags->b, "collisionFlags differs from brute force");
  require(flags->colliding_a == expected_flags->colliding_a && flags->colliding_b == expected_flags->colliding_b,
          "collisionFlags counts differently");

  const auto [closest, expected_closest] =
      compared([&] { return closestPair(a, b, request); }, [&] { return brute_force::closestPair(a, b, request); });
  require(closest->distance == expected_closest->distance, "closestPair's distance differs from brute force");
  require(closest->pair == expected_closest->pair, "closestPair's pair differs from brute force");
}

} // namespace
} // namespace pcl_bsh::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  fuzz::Bytes bytes(data, size);
  const fuzz::FuzzedCloud a(bytes, 8), b(bytes, 2);
  const std::optional<SphereHierarchy> first = a.hierarchy(), second = b.hierarchy();
  if (!first || !second) return 0;

  const Placed placed_a{*first, fuzz::anyPose(bytes)}, placed_b{*second, fuzz::anyPose(bytes)};
  test::Question request;
  request.flagged = static_cast<Flagged>(1 + bytes.below(3));
  request.threads = 1 + bytes.below(2);
  request.clearance = fuzz::anyClearance(bytes, placed_a, placed_b);
  fuzz::compareAnswers(placed_a, placed_b, request);
  const double scale = std::isfinite(request.clearance) ? request.clearance : 1.0;
  const std::optional<SphereHierarchy> uncertain_a = a.hierarchy(fuzz::anyUncertainty(bytes, scale)),
                                       uncertain_b = b.hierarchy(fuzz::anyUncertainty(bytes, scale));
  if (uncertain_a && uncertain_b)
    fuzz::compareAnswers({*uncertain_a, placed_a.pose}, {*uncertain_b, placed_b.pose}, request);
  fuzz::requireSound(*first); // last: it builds the voxels that no query visited
  fuzz::requireSound(*second);
  return 0;
}
