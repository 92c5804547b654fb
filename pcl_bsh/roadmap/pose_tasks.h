// SPDX-License-Identifier: BSD-3-Clause
// What the queries at many poses share: checks, and how the list is divided among threads.
#pragma once

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/pose_list.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/roadmap/pose_batch.h>

#include <algorithm>
#include <vector>

namespace pcl_bsh {

/// Refuses a pose that is not rigid, by its index, and more poses than an index can name. @param whose words for them
void checkPoses(const PoseList& poses, const char* whose, unsigned threads);

/// Refuses such poses of b, a pose of a that is not rigid, and an accuracy that stops early.
void checkAtPoses(const Placed& a, const PoseList& poses, const Accuracy& accuracy, unsigned threads);

/// Calls answer(batch) for batches [0, count), from several threads, all that is left of the progress, until it is
/// told to stop. @return the sum of the work that it returns. @throws Cancelled
template <class Answer>
Work forEachPart(std::size_t count, unsigned threads, Progress& progress, const Answer& answer)
{
  progress.begin(1.0, count);
  std::vector<Work> work(count);
  parallelFor(count, threads, [&](std::size_t i) {
    if (progress.stopped()) return;
    work[i] = answer(i);
    progress.step();
  });
  progress.throwIfStopped();
  progress.end();
  Work all;
  for (const Work& part : work) all += part;
  return all;
}

/// Calls answer(i, pose) for each pose, from several threads. @return the sum of the work that it returns
template <class Answer>
Work forEachPose(const PoseList& poses, unsigned threads, Progress& progress, const Answer& answer)
{
  const std::size_t batches = (poses.size() + kBatchPoses - 1) / kBatchPoses;
  return forEachPart(batches, threadCount(threads), progress, [&](std::size_t batch) {
    Work work;
    const std::size_t end = std::min(poses.size(), (batch + 1) * kBatchPoses);
    for (std::size_t i = batch * kBatchPoses; i < end && !progress.stopped(); ++i) {
      work += answer(i, poses[i]);
      if (i % 16 == 0) progress.pulse();
    }
    return work;
  });
}

/// Calls answer(batch, order) for batches of poses that are near each other, from several threads: `order` has the
/// poses' indices in the list. Neither cloud is empty. @return the sum of the work that it returns
template <class Answer>
Work forEachBatch(const Placed& a, const SphereHierarchy& b, const PoseList& poses, unsigned threads,
                  Progress& progress, const Answer& answer)
{
  const BodyBall body(b);
  const std::vector<std::uint32_t> order = orderOf(poses, body, threadCount(threads));
  const std::size_t batches = (order.size() + kBatchPoses - 1) / kBatchPoses;
  return forEachPart(batches, threadCount(threads), progress, [&](std::size_t i) {
    const std::size_t begin = i * kBatchPoses, end = std::min(order.size(), begin + kBatchPoses);
    PoseBatch batch{a, b, body, {}};
    batch.poses.reserve(end - begin);
    for (std::size_t k = begin; k < end; ++k) batch.poses.push_back(poses[order[k]]);
    return answer(batch, order.data() + begin);
  });
}

} // namespace pcl_bsh
