// SPDX-License-Identifier: BSD-3-Clause
// A benchmark that measures wrongly is worse than none: its medians, workloads and peers are tested like anything else.
#include "harness.h"
#include "peer/box_tree.h"
#include "peer/uniform_grid.h"
#include "rigid_racers.h"
#include "workload/hall.h"
#include "workload/nearest.h"
#include "workload/random.h"
#include "workload/rigid_poses.h"
#include "workload/statue.h"
#include "workload/terrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>
#include <numeric>
#include <sstream>

namespace pcl_bsh::bench {
namespace {

double bruteForceDistance(const Points& points, const Point& query)
{
  double squared = std::numeric_limits<double>::infinity();
  for (const Point& p : points) squared = std::min(squared, squaredDistanceDouble(p, query));
  return std::sqrt(squared);
}

std::uint64_t fingerprint(const Points& points)
{
  std::uint64_t hash = points.size();
  for (const Point& p : points)
    for (const float value : {p.x, p.y, p.z}) {
      std::uint32_t bits;
      std::memcpy(&bits, &value, sizeof bits);
      hash = mix(hash ^ bits);
    }
  return hash;
}

TEST(Quantile, OddEvenAndEnds)
{
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(quantile({5, 7, 6}, 0.0), 5);
  EXPECT_EQ(quantile({5, 7, 6}, 1.0), 7);
  EXPECT_THROW(median({}), std::invalid_argument);
}

TEST(InParts, EveryPlaceOnce)
{
  for (const unsigned threads : {1u, 2u, 3u, 7u}) {
    std::vector<int> visits(100);
    inParts(visits.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), 100) << threads;
  }
}

TEST(MemoryPeak, SeesWhatIsTouchedAndFreed)
{
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  const MemoryPeak peak;
  {
    const auto block = std::make_unique<unsigned char[]>(kBytes);
    std::memset(block.get(), 1, kBytes);
    EXPECT_EQ(block[kBytes / 2], 1);
  }
  EXPECT_GT(peak.bytes(), kBytes * 9 / 10);
  EXPECT_LT(peak.bytes(), kBytes * 11 / 10);
}

TEST(TableTest, CsvQuotesCommas)
{
  Table table({"a", "b"});
  table.add({"1,5", "say \"so\""});
  EXPECT_THROW(table.add({"1"}), std::invalid_argument);
  const std::string file = testing::TempDir() + "table_test.csv";
  table.writeCsv(file);
  std::stringstream content;
  content << std::ifstream(file).rdbuf();
  EXPECT_NE(content.str().find(",a,b\n"), std::string::npos) << content.str();
  EXPECT_NE(content.str().find(",\"1,5\",\"say \"\"so\"\"\"\n"), std::string::npos) << content.str();
  EXPECT_THROW(table.writeCsv("/no/such/folder/table.csv"), std::runtime_error);
}

TEST(Workload, SameOnEveryMachine)
{
  const ScanPair terrain = terrainPair(2500);
  EXPECT_EQ(fingerprint(terrain.a), 10866251008292660428u);
  EXPECT_EQ(fingerprint(terrain.b), 9574250230051329951u);
  EXPECT_EQ(fingerprint(statue(2000, 1)), 17904002984250546542u);
  EXPECT_EQ(fingerprint(shuffled(terrain.a, 5)), 12216455117381102445u);
}

TEST(Workload, SpacingIsWhatItSays)
{
  EXPECT_NEAR(medianSpacing(terrainPair(40000).a), 0.75, 0.25); // a jittered lattice of step 1 on slopes
  const Points body = statue(20000, 1);
  EXPECT_EQ(body.size(), 20000u);
  const NearestDistance nearest(body);
  std::vector<double> gaps;
  for (const Point& p : body) gaps.push_back(nearest.toOther(p));
  EXPECT_LT(quantile(gaps, 0.99), 2.5 * median(gaps)) << "roughly uniform";
}

TEST(Workload, HallIsVeryUneven)
{
  const ScanPair hall = statueInHall(20000), sweep = sweepPair(20000);
  for (const ScanPair* pair : {&hall, &sweep}) {
    const NearestDistance nearest(pair->a);
    std::vector<double> gaps;
    for (const Point& p : pair->a) gaps.push_back(nearest.toOther(p));
    EXPECT_GT(quantile(gaps, 0.9), 4 * quantile(gaps, 0.1));
  }
}

TEST(Workload, ShuffleKeepsThePoints)
{
  const Points points = terrainPair(900).a;
  Points mixed = shuffled(points, 5), sorted = points;
  const auto less = [](const Point& p, const Point& q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); };
  std::sort(mixed.begin(), mixed.end(), less);
  std::sort(sorted.begin(), sorted.end(), less);
  EXPECT_EQ(fingerprint(mixed), fingerprint(sorted));
}

TEST(RigidPoseTest, InverseGoesBack)
{
  const Points body = statue(300, 1);
  const auto cases = rigidPoses(ReferenceTree(body), ReferenceTree(statue(300, 2)), medianSpacing(body), 3, 1);
  for (const auto& posed : cases) {
    const auto there = posed.pose.apply(std::array<double, 3>{1, 2, 3});
    const auto back = posed.pose.inverse().apply(there);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back[k], static_cast<double>(k + 1), 1e-12);
  }
}

TEST(RigidPoses, ClassesHoldByBruteForce)
{
  const Points a = statue(1500, 1), b = statue(1500, 2);
  const double spacing = medianSpacing(a);
  const auto cases = rigidPoses(ReferenceTree(a), ReferenceTree(b), spacing, 12, 7);
  ASSERT_EQ(cases.size(), 12u);
  for (const auto& posed : cases) {
    double distance = std::numeric_limits<double>::infinity();
    for (const Point& q : moved(b, posed.pose)) distance = std::min(distance, bruteForceDistance(a, q));
    EXPECT_NEAR(posed.distance, distance, 1e-5 * spacing);
    switch (posed.kind) {
    case PoseClass::hit:
      EXPECT_LE(distance, spacing);
      break;
    case PoseClass::near_miss:
      EXPECT_GE(distance, 1.3 * spacing);
      EXPECT_LE(distance, 4.02 * spacing);
      break;
    case PoseClass::far:
      EXPECT_GE(distance, 19 * spacing);
      break;
    }
  }
}

TEST(ExistencePeers, AgreeWithBruteForce)
{
  const ScanPair scenes[] = {terrainPair(1600), statueInHall(1600)};
  std::vector<std::unique_ptr<ExistencePeer>> peers;
  for (const GridCraft craft : {GridCraft::plain, GridCraft::crafted})
    for (const double edge : {0.3, 1.0, 3.0})
      peers.push_back(std::make_unique<UniformGrid>(GridTuning{craft, edge, 8.0}));
  peers.push_back(makeNanoflannTree());
  peers.push_back(makePclKdTree());
  peers.push_back(makePclOctree());
  for (const ScanPair& scene : scenes) {
    for (const double spacings : {1.0, 5.0, 20.0}) {
      const auto d = static_cast<float>(spacings * scene.spacing);
      std::vector<std::uint8_t> truth;
      for (const Point& p : scene.a) truth.push_back(bruteForceDistance(scene.b, p) <= d);
      for (const auto& peer : peers) {
        peer->adopt(scene.b);
        peer->build(scene.b, d);
        std::vector<std::uint8_t> flags(scene.a.size());
        peer->flag(scene.a, 0, scene.a.size(), d, flags.data());
        EXPECT_EQ(flags, truth) << "racer " << &peer - peers.data() << ", d = " << d;
      }
    }
  }
}

/// Turned ones, too, and clearances at which whole boxes are settled at once.
TEST(BoxTrees, FlagWhatBruteForceFlagsAndCountLittle)
{
  const Points a = statue(700, 3), b = statue(600, 4);
  const BoxTree tree_a(a), tree_b(b);
  BoxPair boxes(tree_a, tree_b);
  const double c = std::cos(0.4), s = std::sin(0.4);
  for (const double shift : {0.0, 1.0, 2.0, 5.0}) {
    const RigidPose pose = {{c, -s, 0, s, c, 0, 0, 0, 1}, {shift, 0.1, 0.2}};
    const Points there = moved(b, pose);
    for (const float d : {0.01f, 0.2f, 3.0f, 100.0f}) {
      std::vector<std::uint8_t> truth, flags;
      for (const Point& p : a) truth.push_back(bruteForceDistance(there, p) <= d ? 1 : 0);
      BoxWork work;
      boxes.flag(pose, d, flags, work);
      EXPECT_EQ(flags, truth) << shift << ' ' << d;
      const bool any = std::count(truth.begin(), truth.end(), 1) > 0;
      EXPECT_EQ(boxes.any(pose, d, work), any) << shift << ' ' << d;
      EXPECT_LE(work.updates, 2 * tree_b.nodes().size());
      if (d == 100.0f) {
        EXPECT_EQ(work.tests, 2u);
      }
    }
  }
}

TEST(RigidRacers, AgreeWithTheReference)
{
  const Points a = statue(3000, 1), b = statue(3000, 2);
  const double spacing = static_cast<float>(medianSpacing(a));
  const auto cases = rigidPoses(ReferenceTree(a), ReferenceTree(b), spacing, 30, 3);
  for (const auto& name : availableRigidRacers()) {
    const auto racer = makeRigidRacer(name);
    racer->build(a, b, spacing);
    for (const auto& posed : cases) {
      EXPECT_EQ(racer->any(posed.pose), posed.distance <= spacing) << name;
      if (racer->measuresDistance()) {
        EXPECT_NEAR(racer->distance(posed.pose), posed.distance, 1e-12) << name;
      }
    }
  }
}

} // namespace
} // namespace pcl_bsh::bench
