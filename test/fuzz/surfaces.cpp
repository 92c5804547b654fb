// SPDX-License-Identifier: BSD-3-Clause
// Any mesh against any points or mesh: queries against brute force, single pairs against rational numbers, and what the
// mesh encloses against all of its triangles.
#include "bytes.h"
#include "geometry/triangle_oracle.h"
#include "scene.h"
#include "surface_questions.h"
#include "target.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <cmath>
#include <stdexcept>

namespace pcl_bsh::fuzz {
namespace {

/// Numbers that rationals can decide soon enough.
bool isModest(const Point3& p)
{
  for (const double x : p)
    if (!std::isfinite(x) || (x != 0.0 && (std::abs(x) < 0x1p-300 || std::abs(x) > 0x1p300))) return false;
  return true;
}

bool isModest(const Triangle3& t)
{
  return isModest(t[0]) && isModest(t[1]) && isModest(t[2]);
}

/// The first few pairs of records.
void comparePairs(const Placed& a, const Placed& b, double clearance)
{
  const PointsView &p = a.hierarchy().view(), &q = b.hierarchy().view();
  const RecordDistance distance(p, a.pose, q, b.pose);
  const test::Rational squared = test::Rational(clearance) * test::Rational(clearance);
  const DefaultFloatEnvironment environment;
  for (std::uint32_t i = 0; i < std::min<std::size_t>(p.count, 3); ++i)
    for (std::uint32_t j = 0; j < std::min<std::size_t>(q.count, 3); ++j) {
      if (!isModest(q.triangles->triangle(j))) continue;
      const test::RationalTriangle t = test::posed(b.pose, q.triangles->triangle(j));
      test::Rational found;
      if (p.triangles && isModest(p.triangles->triangle(i)))
        found = test::squaredDistance(test::posed(a.pose, p.triangles->triangle(i)), t);
      else if (!p.triangles && !p.radii && isModest(p.point(i)))
        found = test::squaredDistance(test::posed(a.pose, p.point(i)), t);
      else
        continue;
      require((distance.compare(PointPair{i, j}, clearance) <= 0) == (found <= squared),
              "a pair is decided otherwise by rational numbers");
    }
}

void compareAnswers(const Placed& a, const Placed& b, double clearance, unsigned threads)
{
  FlagsRequest flags;
  flags.clearance = clearance;
  flags.flagged = Flagged::both;
  flags.threads = threads;
  const FlagsResult found = collisionFlags(a, b, flags), expected = brute_force::collisionFlags(a, b, flags);
  require(found.a == expected.a && found.b == expected.b, "collisionFlags differs from brute force");
  const AnyRequest any{clearance, {}};
  require(anyCollision(a, b, any).verdict == brute_force::anyCollision(a, b, any).verdict,
          "anyCollision differs from brute force");
  const DistanceResult closest = closestPair(a, b), nearest = brute_force::closestPair(a, b);
  require(closest.distance == nearest.distance && closest.pair == nearest.pair, "closestPair differs from brute force");
  TrajectoryRequest path;
  path.clearance = clearance;
  path.threads = threads;
  path.distances = path.first_poses = path.closest_poses = path.pose_summaries = true;
  Eigen::Isometry3d beside = b.pose;
  beside.translation().x() += clearance;
  const std::vector<Eigen::Isometry3d> poses = {b.pose, beside};
  if (!beside.matrix().allFinite()) return;
  const TrajectoryResult along = collideAlong(a, b.hierarchy(), poses, path),
                         truth = brute_force::collideAlong(a, b.hierarchy(), poses, path);
  require(along.flags == truth.flags && along.first_pose == truth.first_pose &&
              along.closest_pose == truth.closest_pose,
          "collideAlong differs from brute force");
}

} // namespace
} // namespace pcl_bsh::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  fuzz::Bytes bytes(data, size);
  const bool of_points = bytes.below(2) == 0;
  const unsigned threads = 1 + bytes.below(2);
  test::Random random(bytes.take<std::uint16_t>());
  const fuzz::FuzzedMesh mesh(bytes), other(bytes);
  const fuzz::FuzzedCloud points(bytes, 1);
  const std::optional<SphereHierarchy> b = mesh.hierarchy(), a = of_points ? points.hierarchy() : other.hierarchy();
  if (!a || !b) return 0;
  const Placed placed_a{*a, fuzz::anyPose(bytes)}, placed_b{*b, fuzz::anyPose(bytes)};
  const double clearance = fuzz::anyClearance(bytes, placed_a, placed_b);
  try {
    fuzz::compareAnswers(placed_a, placed_b, clearance, threads);
  }
  catch (const std::invalid_argument&) { // the pose is not rigid, or the clearance is invalid
    return 0;
  }
  fuzz::comparePairs(placed_a, placed_b, clearance);
  fuzz::askDistances(placed_a, placed_b, 1.0, random);
  fuzz::askSolid(placed_a, placed_b, 1.0, random);
  for (const auto* hierarchy : {&*a, &*b}) {
    const HierarchyDefects defects = hierarchy->validate();
    fuzz::require(defects.none(), defects.none() ? "" : defects.lines.front().c_str());
  }
  return 0;
}
