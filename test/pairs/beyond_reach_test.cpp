// SPDX-License-Identifier: BSD-3-Clause
// Any collision of surfaces of which all triangles are hardly farther apart than the clearance; and what planes know of
// nodes, against all pairs below them.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/pairs/trace.h>
#include <pcl_bsh/traversal/beyond_reach.h>

#include "support/tied_meshes.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;
using test::Tied;
using test::TiedPair;

void expectAsBruteForce(const Placed& a, const Placed& b, double clearance)
{
  const AnyResult expected = brute_force::anyCollision(a, b, clearance);
  std::optional<PointPair> first;
  for (const unsigned threads : {1u, 2u}) {
    AnyRequest request(clearance);
    request.threads = threads;
    const AnyResult found = anyCollision(a, b, request);
    ASSERT_EQ(found.verdict, expected.verdict) << clearance;
    if (threads == 1) first = found.pair;
    ASSERT_EQ(found.pair, first);
  }
  AnyRequest roughly(clearance);
  roughly.accuracy = Accuracy::tolerance(1e-13);
  ASSERT_GE(test::numberOf(anyCollision(a, b, roughly).verdict), test::numberOf(expected.verdict));
  for (const Accuracy& accuracy : {Accuracy::level(3), Accuracy::nodePairs(5000), Accuracy::time(1e-3)}) {
    AnyRequest early(clearance);
    early.accuracy = accuracy;
    const Verdict verdict = anyCollision(a, b, early).verdict;
    ASSERT_EQ(verdict, verdict == Verdict::undecided ? verdict : expected.verdict) << clearance;
  }
  ASSERT_EQ(traceCollision(a, b, clearance).result.pair, first);
}

TEST(BeyondReach, AnyIsAsBruteForce)
{
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TiedPair pair = test::anyTies(seed);
    PointsView view_a = viewOf(pair.a.trianglesView());
    std::vector<float> own(view_a.count);
    for (float& uncertainty : own) uncertainty = static_cast<float>(random.pick({0.0, 0.0625}));
    if (seed % 3 == 1) view_a.uncertainty = 0.0625;
    if (seed % 3 == 2) view_a.uncertainties = own.data();
    const SphereHierarchy a(view_a), b(viewOf(pair.b.trianglesView()));
    const Placed placed_a(a, pair.pose_a), placed_b(b, pair.pose_b);
    const double distance = brute_force::closestPair(placed_a, placed_b).distance;
    for (const double at : {distance, pair.gap, distance - 0.0625, distance + 0.0625})
      expectAsBruteForce(placed_a, placed_b, test::clearanceAbout(at, random));
  }
}

TEST(BeyondReach, AnyIsAsBruteForceBesidePointsAndBalls)
{
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TiedPair pair = test::anyTies(seed);
    const SphereHierarchy a(viewOf(pair.a.trianglesView()));
    std::vector<float> radii(pair.b.vertices.size());
    for (float& radius : radii) radius = static_cast<float>(random.pick({0.0, 0.0625, 0.125, 1.0}));
    PointsView view = pair.b.view();
    if (seed % 2 == 1) view.radii = radii.data();
    const SphereHierarchy b(view);
    const Placed placed_a(a, pair.pose_a), placed_b(b, pair.pose_b);
    const double distance = brute_force::closestPair(placed_a, placed_b).distance; // below 0 where balls overlap
    for (const double at : {std::max(0.0, distance), pair.gap}) {
      const double clearance = test::clearanceAbout(at, random);
      expectAsBruteForce(placed_a, placed_b, clearance);
      expectAsBruteForce(placed_b, placed_a, clearance);
    }
  }
}

/// No plane is between the wholes.
TEST(BeyondReach, AnyFindsWhatCollidesAmongTies)
{
  for (const Tied& tied : test::tied())
    for (const double nearer : {1e-3, 1e-8, 2e-9, 0.5e-9}) {
      SCOPED_TRACE(tied.name);
      TiedPair pair = tied.make(150);
      pair.b.add({0.3, 0.2, 0.3 * (1 - nearer)}, {0.4, 0.2, 0.8}, {0.3, 0.3, 0.8});
      const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
      const Eigen::Isometry3d pose = Random(1).pose(3);
      expectAsBruteForce({a, pose}, {b, pose}, 0.3 * (1 - 1e-9));
    }
}

/// Once planes are asked, they decide neither too little nor too much.
TEST(BeyondReach, AnyTakesLittleWorkAndFindsWhatCollides)
{
  const Eigen::Isometry3d pose = Random(1).pose(3);
  for (const Tied& tied : test::tied()) {
    SCOPED_TRACE(tied.name);
    TiedPair pair = tied.make(600);
    const SphereHierarchy a(viewOf(pair.a.trianglesView())), all(viewOf(pair.b.trianglesView()));
    const AnyResult found = anyCollision({a, pose}, {all, pose}, 0.3 * (1 - 1e-9));
    EXPECT_EQ(found.verdict, Verdict::free);
    EXPECT_LE(found.work.exact_decisions, 20 * (pair.a.triangles.size() + pair.b.triangles.size()));
    const double height = 0.3 * (1 - 1e-8);
    pair.b.add({-0.1, -0.1, height}, {0.7, -0.1, height}, {0.2, 0.3, height});
    const SphereHierarchy nearer(viewOf(pair.b.trianglesView()));
    EXPECT_EQ(anyCollision({a, pose}, {nearer, pose}, 0.3 * (1 - 1e-9)).verdict, Verdict::colliding);
  }
}

/// All pairs would be n / 2 decisions a triangle, and more.
TEST(BeyondReach, AnyTakesWorkInProportion)
{
  const Eigen::Isometry3d turned = Random(1).pose(3);
  for (const Tied& tied : test::tied())
    for (const Eigen::Isometry3d& pose : {Eigen::Isometry3d(Eigen::Isometry3d::Identity()), turned})
      for (const std::uint32_t n : {1000u, 4000u, 16000u})
        for (const double less : {1e-6, 1e-9, 1e-12}) {
          const TiedPair pair = tied.make(n);
          const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
          const AnyResult found = anyCollision({a, pose}, {b, pose}, 0.3 * (1 - less));
          const std::size_t triangles = pair.a.triangles.size() + pair.b.triangles.size();
          EXPECT_EQ(found.verdict, Verdict::free) << tied.name;
          EXPECT_LE(found.work.node_pairs + 16 * found.work.leaf_pairs + found.work.exact_decisions, 100 * triangles)
              << tied.name << ", " << n;
        }
}

// The nodes of a cloud.

std::vector<NodeChild> childrenOf(const SphereHierarchy& cloud)
{
  const SphereHierarchy::Storage& storage = cloud.storage();
  std::vector<NodeChild> all;
  BuildWork work;
  for (const Node& node : storage.top)
    for (std::uint32_t lane = 0; lane < node.count; ++lane) all.push_back({kAboveVoxels, node, lane});
  for (std::uint32_t voxel = 0; voxel < storage.voxel_count; ++voxel)
    for (const Node& node : storage.built(voxel, work).nodes)
      for (std::uint32_t lane = 0; lane < node.count; ++lane) all.push_back({voxel, node, lane});
  return all;
}

std::vector<std::uint32_t> recordsBelow(const SphereHierarchy& cloud, const NodeChild& child)
{
  const SphereHierarchy::Storage& storage = cloud.storage();
  std::vector<std::uint32_t> records;
  for (std::uint32_t i = child.node.begin[child.lane]; i < child.node.begin[child.lane + 1]; ++i) {
    if (child.space == kAboveVoxels)
      storage.forEachRecord(i, [&](std::uint32_t record) { records.push_back(record); });
    else
      records.push_back(storage.voxels[child.space].records()[i]);
  }
  return records;
}

/// Two clouds, and all pairs of records that are beyond the reach.
struct Asked {
  Asked(const PointsView& view_a, const Eigen::Isometry3d& pose_a, const PointsView& view_b,
        const Eigen::Isometry3d& pose_b, double clearance, MeantPlaces places, const PatchSpacings& patches = {})
  : of_a(view_a),
    of_b(view_b),
    a(of_a, pose_a),
    b(of_b, pose_b),
    pairs(a, b, clearance, places, patches),
    beyond(pairs, of_a.storage(), of_b.storage())
  {
    for (std::uint32_t i = 0; i < view_a.count; ++i)
      for (std::uint32_t j = 0; j < view_b.count; ++j) {
        const bool collides = pairs.collide({i, j}, work);
        collide.push_back(collides);
        if (!collides) apart.push_back({i, j});
      }
  }

  /// Tells it of pairs that are beyond. @return of how many pairs of nodes it then knows that all below them are
  int find(Random& random, int count)
  {
    if (apart.empty()) return 0;
    for (int i = 0; i < count; ++i)
      beyond.found(apart[static_cast<std::size_t>(random.integer(0, static_cast<int>(apart.size()) - 1))]);
    is_asked = beyond.mayKnow();
    int known = 0;
    const std::vector<NodeChild> below_a = childrenOf(of_a), below_b = childrenOf(of_b);
    for (int k = 0; k < 300 && beyond.mayKnow(); ++k) {
      const auto pick = [&](const std::vector<NodeChild>& all) {
        return static_cast<std::size_t>(random.integer(0, static_cast<int>(all.size()) - 1));
      };
      const NodeChild& child_a = below_a[pick(below_a)];
      const NodeChild& child_b = below_b[pick(below_b)];
      if (!beyond.knows(child_a, child_b)) continue;
      ++known;
      for (const std::uint32_t i : recordsBelow(of_a, child_a))
        for (const std::uint32_t j : recordsBelow(of_b, child_b))
          EXPECT_FALSE(collide[i * of_b.view().count + j]) << i << ' ' << j;
    }
    return known;
  }

  const SphereHierarchy of_a, of_b;
  const Placed a, b;
  const PointPairs pairs;
  BeyondReach beyond;
  bool is_asked = false; ///< as soon as it was told of all pairs
  std::vector<bool> collide;
  std::vector<PointPair> apart;
  Work work;
};

TEST(BeyondReach, KnowsOfNodesWhatIsTrue)
{
  int known = 0, of_uncertain = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TiedPair pair = test::anyTies(seed);
    if (random.chance(0.3)) pair.pose_a.linear() *= 1 + 4e-7; // not quite rigid
    PointsView view_a = viewOf(pair.a.trianglesView()), view_b = viewOf(pair.b.trianglesView());
    if (random.chance(0.2)) view_b = pair.b.view();
    const bool is_uncertain = random.chance(0.3);
    if (is_uncertain) view_a.uncertainty = 0.0625, view_b.uncertainty = 0.03125;
    const double clearance = std::max(0.0, test::clearanceAbout(pair.gap, random) - (is_uncertain ? 0.09375 : 0));
    Asked asked(view_a, pair.pose_a, view_b, pair.pose_b, clearance,
                is_uncertain ? random.pick({MeantPlaces::possible, MeantPlaces::certain}) : MeantPlaces::measured);
    const int found = asked.find(random, 2000);
    known += found;
    of_uncertain += is_uncertain ? found : 0;
  }
  EXPECT_GT(known, 5000);
  EXPECT_GT(of_uncertain, 500);
}

/// Where pairs have reaches of their own, one that is beyond says nothing of another; points are none of its business.
TEST(BeyondReach, KnowsNothingWherePairsDiffer)
{
  Random random(1);
  const TiedPair pair = test::tied()[0].make(30);
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  const PointsView plain_a = viewOf(pair.a.trianglesView()), plain_b = viewOf(pair.b.trianglesView());
  const auto known = [&](const PointsView& a, const PointsView& b, MeantPlaces places,
                         const PatchSpacings& patches = {}) {
    Asked asked(a, identity, b, identity, 0.2, places, patches);
    EXPECT_GT(asked.apart.size(), 500u);
    const int found = asked.find(random, 2000);
    EXPECT_EQ(found > 0, asked.is_asked);
    return found;
  };
  EXPECT_GT(known(plain_a, plain_b, MeantPlaces::measured), 0);
  const std::vector<float> some(64, 0.01f);
  PointsView uncertain = plain_a;
  uncertain.uncertainties = some.data();
  EXPECT_EQ(known(uncertain, plain_b, MeantPlaces::possible), 0);
  EXPECT_EQ(known(plain_b, uncertain, MeantPlaces::certain), 0);
  EXPECT_GT(known(uncertain, plain_b, MeantPlaces::measured), 0);
  EXPECT_EQ(known(plain_a, plain_b, MeantPlaces::covered, {some.data(), plain_b.count}), 0);
  PointsView balls = pair.b.view();
  EXPECT_GT(known(plain_a, balls, MeantPlaces::measured), 0);
  balls.radii = some.data();
  EXPECT_EQ(known(plain_a, balls, MeantPlaces::measured), 0);
  EXPECT_EQ(known(balls, plain_a, MeantPlaces::measured), 0);
  EXPECT_EQ(known(pair.a.view(), pair.b.view(), MeantPlaces::measured), 0);
}

/// Two discs, shifted, so that planes of the first pair cut both; and one triangle of b that faces a.
struct Shifted {
  static test::TestMesh shifted()
  {
    test::TestMesh mesh = test::tied()[1].make(64).b;
    for (Point3& p : mesh.vertices) p[0] += 3;
    mesh.add({0, 0, 0.3}, {0.1, 0, 0.3}, {0, 0.1, 0.3});
    return mesh;
  }

  bool known() { return asked.beyond.knows(childWith(asked.of_a, 0), childWith(asked.of_b, 64)); }

  /// The child of the whole that holds a record.
  static NodeChild childWith(const SphereHierarchy& of, std::uint32_t record)
  {
    const Node& top = of.storage().top[0];
    for (std::uint32_t lane = 0;; ++lane) {
      const NodeChild child{kAboveVoxels, top, lane};
      const std::vector<std::uint32_t> below = recordsBelow(of, child);
      if (lane + 1 == top.count || std::find(below.begin(), below.end(), record) != below.end()) return child;
    }
  }

  const test::TestMesh a = test::tied()[1].make(64).a, b = shifted();
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  Asked asked{viewOf(a.trianglesView()), identity, viewOf(b.trianglesView()), identity, 0.2, MeantPlaces::measured};
};

TEST(BeyondReach, PlanesAreOfTheNearestPair)
{
  Shifted of;
  BeyondReach& beyond = of.asked.beyond;
  for (int i = 0; i < 1023; ++i) beyond.found({0, 0});
  EXPECT_FALSE(beyond.mayKnow());
  beyond.found({0, 0});
  EXPECT_TRUE(beyond.mayKnow());
  EXPECT_FALSE(of.known());
  for (int i = 0; i < 70; ++i) beyond.found({0, 64});
  EXPECT_TRUE(of.known());
  for (int i = 0; i < 70; ++i) beyond.found({0, 0});
  EXPECT_TRUE(of.known());
}

/// So that what planes do not tell apart costs little more than without them; a nearer pair is another matter.
TEST(BeyondReach, AsksLessWhereItIsInVain)
{
  Shifted of;
  BeyondReach& beyond = of.asked.beyond;
  int times = 0;
  for (int i = 0; i < 4096 - 200; ++i) {
    beyond.found({0, 0});
    for (int k = 0; k < 10 && beyond.mayKnow(); ++k, ++times) EXPECT_FALSE(of.known());
  }
  EXPECT_GE(times, 2 * 32);
  EXPECT_LE(times, 3 * 32);
  EXPECT_FALSE(beyond.mayKnow());
  for (int i = 0; i < 64; ++i) beyond.found({0, 64});
  EXPECT_TRUE(beyond.mayKnow());
}

} // namespace
} // namespace pcl_bsh
