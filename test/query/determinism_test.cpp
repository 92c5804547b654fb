// SPDX-License-Identifier: BSD-3-Clause
// One hash over all answers of a mixed workload: the same for any instruction set, number of threads and order in which
// voxels come to be built.
#include <pcl_bsh/collide.h>

#include "support/question.h"
#include "support/random_clouds.h"
#include "support/simd_target.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <set>
#include <string>

namespace pcl_bsh {
namespace {

using test::Scene;

/// FNV-1a over 64-bit words.
class Hash {
public:
  void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3u; }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const std::optional<PointPair>& pair)
  {
    add(pair ? std::uint64_t{pair->a} << 32 | pair->b : ~std::uint64_t{0});
  }
  void add(const std::vector<Verdict>& flags)
  {
    for (const Verdict flag : flags) add(static_cast<std::uint64_t>(flag));
  }

  std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

enum class BuildOrder { any_first, flags_first, closest_first, all_at_once, all_with_threads };

constexpr BuildOrder all_orders[] = {BuildOrder::any_first, BuildOrder::flags_first, BuildOrder::closest_first,
                                     BuildOrder::all_at_once, BuildOrder::all_with_threads};

void addAnswers(const Scene& scene, unsigned threads, BuildOrder order, Hash& hash)
{
  HierarchyOptions options;
  options.threads = threads;
  const SphereHierarchy a(scene.a.view(), options), b(scene.b.view(), options);
  const Placed placed_a{a, scene.pose_a}, placed_b{b, scene.pose_b};
  test::Question request;
  request.clearance = scene.clearance;
  request.flagged = Flagged::both;
  request.threads = threads;
  if (order == BuildOrder::flags_first) collisionFlags(placed_b, placed_a, request);
  if (order == BuildOrder::closest_first) closestPair(placed_a, placed_b, request);
  if (order == BuildOrder::all_at_once || order == BuildOrder::all_with_threads) {
    a.buildAll(order == BuildOrder::all_at_once ? 1 : 0);
    b.buildAll(order == BuildOrder::all_at_once ? 1 : 0);
  }
  const AnyResult any = anyCollision(placed_a, placed_b, request);
  hash.add(static_cast<std::uint64_t>(any.verdict));
  hash.add(any.pair);
  const FlagsResult flags = collisionFlags(placed_a, placed_b, request);
  hash.add(flags.a);
  hash.add(flags.b);
  const DistanceResult closest = closestPair(placed_a, placed_b, request);
  hash.add(closest.distance);
  hash.add(closest.pair);
}

std::uint64_t hashOfAll(const std::vector<Scene>& scenes, unsigned threads, BuildOrder order)
{
  Hash hash;
  for (const Scene& scene : scenes) addAnswers(scene, threads, order, hash);
  return hash.value();
}

TEST(Determinism, OneHashForAnyTargetThreadsAndBuildOrder)
{
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 7000; seed < 7016; ++seed)
    scenes.push_back(test::anyScene(seed, seed % 8 == 0 ? 5000 : 300));
  test::Random random(7);
  const auto cloud = [&](test::Shape shape) { return test::Cloud(test::makePoints(shape, 140000, 1, random)); };
  scenes.push_back(
      {cloud(test::Shape::uniform), cloud(test::Shape::sphere), random.pose(.1), random.pose(.1), .02, ""});

  std::set<std::uint64_t> hashes;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const test::OnTarget on_target(target);
    for (const unsigned threads : {1u, 2u}) {
      for (const BuildOrder order : all_orders) {
        if (threads == 2 && order != BuildOrder::any_first && order != BuildOrder::flags_first) continue;
        hashes.insert(hashOfAll(scenes, threads, order));
        ASSERT_EQ(hashes.size(), 1u) << threads << " threads, build order " << static_cast<int>(order);
      }
    }
  }
}

} // namespace
} // namespace pcl_bsh
