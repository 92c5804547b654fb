// SPDX-License-Identifier: BSD-3-Clause
// Lists of poses and of motions: how they are checked, and divided among threads.
#pragma once

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/query/pose_list.h>
#include <pcl_bsh/query/progress.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// Returns the first i for which isWrong(i), out of [0, count); `count` if there is no such i.
template <class IsWrong>
std::size_t firstWrong(std::size_t count, unsigned threads, const IsWrong& isWrong)
{
  constexpr std::size_t kBlock = 1024;
  std::atomic<std::size_t> first{count};
  parallelFor((count + kBlock - 1) / kBlock, threadCount(threads), [&](std::size_t block) {
    const std::size_t end = std::min(count, (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) {
      std::size_t known = first.load(std::memory_order_relaxed);
      if (i >= known) return;
      if (!isWrong(i)) continue;
      while (i < known && !first.compare_exchange_weak(known, i, std::memory_order_relaxed)) {
      }
      return;
    }
  });
  return first;
}

/// Refuses a pose that is not rigid, by its index, and more poses than an index can name. @param whose name of the
/// cloud
void checkPoses(const PoseList& poses, const char* whose, unsigned threads);

/// How many entries of a list one task answers. The first of them has no earlier answer to begin with.
inline constexpr std::size_t kBatch = 64;

/// Calls answer(i, work) for each entry of a list, in batches, from several threads. Each batch has an `Answer` of its
/// own, made by makeAnswer(). Takes the rest of the progress, and ends when told to stop. @return the sum of the work.
/// @throws Cancelled
template <class MakeAnswer>
Work forEachInBatches(std::size_t count, unsigned threads, Progress& progress, const MakeAnswer& makeAnswer)
{
  const std::size_t batches = (count + kBatch - 1) / kBatch;
  progress.begin(1.0, batches);
  std::vector<Work> work(batches);
  parallelFor(batches, threadCount(threads), [&](std::size_t batch) {
    if (progress.stopped()) return;
    auto answer = makeAnswer();
    WorkPulse pulse(work[batch]);
    for (std::size_t i = batch * kBatch; i < std::min(count, (batch + 1) * kBatch); ++i) {
      pulse.look();
      answer(i, work[batch]);
    }
    progress.step();
  });
  progress.throwIfStopped();
  progress.end();
  Work all;
  for (const Work& part : work) all += part;
  return all;
}

} // namespace pcl_bsh
