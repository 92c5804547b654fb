// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/retained_memory.h>

#include <pcl_bsh/base/large_buffer.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/neighbors/neighbors.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <limits>
#include <mutex>
#include <thread>

namespace pcl_bsh::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMegabyte = std::size_t{1} << 20;

class RetainedMemory : public testing::Test {
protected:
  RetainedMemory() { releaseRetainedMemory(); }
  ~RetainedMemory() override
  {
    setRetainedMemoryLimit(limit_);
    releaseRetainedMemory();
  }

  std::size_t limit_ = retainedMemoryLimit();
};

Cloud someCloud(std::size_t count)
{
  Random random(1);
  return Cloud(makePoints(Shape::uniform, count, 1.0, random));
}

void searchEverything(const SphereHierarchy& hierarchy)
{
  Neighbors found;
  EXPECT_EQ(radiusSearch(hierarchy, {0, 0, 0}, kInfinity, found), hierarchy.size());
}

TEST_F(RetainedMemory, HasALimitOf256MegabytesAtFirst)
{
  EXPECT_EQ(limit_, 256 * kMegabyte);
  EXPECT_EQ(retainedMemory(), 0u);
}

TEST_F(RetainedMemory, OfAVastSearchIsWithinTheLimit)
{
  const Cloud cloud = someCloud(1'000'000);
  const SphereHierarchy hierarchy(cloud.view());
  for (const std::size_t limit : {limit_, 20 * kMegabyte, kMegabyte, std::size_t{0}}) {
    setRetainedMemoryLimit(limit);
    EXPECT_LE(retainedMemory(), limit);
    for (int i = 0; i < 2; ++i) {
      searchEverything(hierarchy);
      EXPECT_LE(retainedMemory(), limit);
    }
  }
}

TEST_F(RetainedMemory, OfAVastSearchIsNoThreadsOwn)
{
  const Cloud cloud = someCloud(1'000'000);
  const SphereHierarchy hierarchy(cloud.view());
  searchEverything(hierarchy);
  setRetainedMemoryLimit(17 * kMegabyte); // more than scratch may take, less than the buffers that it consisted of
  EXPECT_LE(retainedMemory(), 17 * kMegabyte);
  searchEverything(hierarchy);
  EXPECT_LE(retainedMemory(), 17 * kMegabyte);
}

/// A buffer that ends is kept only where what threads keep as scratch leaves room for it.
TEST_F(RetainedMemory, OfBuffersAndScratchTogetherIsWithinTheLimit)
{
  const Cloud cloud = someCloud(500'000);
  const SphereHierarchy hierarchy(cloud.view());
  hierarchy.buildAll();
  releaseRetainedMemory();
  searchEverything(hierarchy);
  const std::size_t scratch = retainedMemory();
  ASSERT_GT(scratch, 3 * kMegabyte);
  setRetainedMemoryLimit(scratch + 4 * kMegabyte);
  EXPECT_EQ(retainedMemory(), scratch);
  makeBuffer<char>(6 * kMegabyte).reset();
  EXPECT_LE(retainedMemory(), scratch + 4 * kMegabyte);
}

TEST_F(RetainedMemory, IsGivenBackAltogether)
{
  const Cloud cloud = someCloud(300'000), small = someCloud(2'000);
  {
    const SphereHierarchy hierarchy(cloud.view()), other(small.view());
    searchEverything(hierarchy);
    FlagsRequest request;
    request.clearance = 0.01;
    collisionFlags({hierarchy}, {other}, request);
    EXPECT_GT(retainedMemory(), 0u);
    releaseRetainedMemory();
    EXPECT_EQ(retainedMemory(), 0u);
    searchEverything(hierarchy); // as ever
  }
  EXPECT_GT(retainedMemory(), 0u);
  releaseRetainedMemory();
  EXPECT_EQ(retainedMemory(), 0u);
}

TEST_F(RetainedMemory, IsKeptBetweenSmallQueries)
{
  const Cloud cloud = someCloud(2'000);
  const SphereHierarchy hierarchy(cloud.view());
  searchEverything(hierarchy);
  const std::size_t kept = retainedMemory();
  EXPECT_GT(kept, 2'000u * (sizeof(float) + sizeof(std::uint32_t)));
  searchEverything(hierarchy);
  EXPECT_EQ(retainedMemory(), kept);
}

TEST_F(RetainedMemory, OfNothingWorks)
{
  setRetainedMemoryLimit(0);
  const Cloud cloud = someCloud(100'000), other_cloud = someCloud(1'000);
  for (int i = 0; i < 2; ++i) {
    const SphereHierarchy hierarchy(cloud.view()), other(other_cloud.view());
    searchEverything(hierarchy);
    FlagsRequest request;
    request.threads = 2;
    EXPECT_GT(collisionFlags({hierarchy}, {other}, request).colliding_a, 0u); // the same first points
    EXPECT_EQ(retainedMemory(), 0u);
  }
}

TEST_F(RetainedMemory, OfThreadsThatEndIsGivenBack)
{
  const Cloud cloud = someCloud(2'000);
  const SphereHierarchy hierarchy(cloud.view());
  hierarchy.buildAll();
  releaseRetainedMemory();
  std::thread([&] { searchEverything(hierarchy); }).join();
  EXPECT_EQ(retainedMemory(), 0u);
}

TEST_F(RetainedMemory, OfIdleThreadsIsGivenBack)
{
  const Cloud cloud = someCloud(2'000);
  const SphereHierarchy hierarchy(cloud.view());
  hierarchy.buildAll();
  releaseRetainedMemory();
  std::mutex mutex;
  std::condition_variable changed;
  bool searched = false, released = false;
  std::thread idle([&] {
    searchEverything(hierarchy);
    std::unique_lock<std::mutex> lock(mutex);
    searched = true;
    changed.notify_all();
    changed.wait(lock, [&] { return released; });
    searchEverything(hierarchy);
  });
  {
    std::unique_lock<std::mutex> lock(mutex);
    changed.wait(lock, [&] { return searched; });
    EXPECT_GT(retainedMemory(), 0u);
    releaseRetainedMemory();
    EXPECT_EQ(retainedMemory(), 0u);
    released = true;
    changed.notify_all();
  }
  idle.join();
  EXPECT_EQ(retainedMemory(), 0u);
}

/// To be run under ThreadSanitizer: memory is given back and limits change while threads search.
TEST_F(RetainedMemory, MayBeGivenBackWhileThreadsSearch)
{
  const Cloud cloud = someCloud(20'000);
  const SphereHierarchy hierarchy(cloud.view());
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 40; ++i) searchEverything(hierarchy);
    });
  for (int i = 0; i < 200; ++i) {
    setRetainedMemoryLimit(i % 2 == 0 ? 0 : limit_);
    releaseRetainedMemory();
    std::this_thread::yield();
  }
  for (std::thread& thread : threads) thread.join();
  setRetainedMemoryLimit(0);
  EXPECT_EQ(retainedMemory(), 0u);
}

} // namespace
} // namespace pcl_bsh::test
