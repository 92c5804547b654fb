// SPDX-License-Identifier: BSD-3-Clause
// What queries about lists of poses and of motions share: checks, how a list is divided among threads, and verdicts.
#pragma once

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/roadmap/pose_batch.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace pcl_bsh {

/// The first of these that is wrong; `count` where none is.
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

/// Refuses a pose that is not rigid, by its index, and more poses than an index can name. @param whose words for them
void checkPoses(const PoseList& poses, const char* whose, unsigned threads);

/// Some entries of a list of poses, by their indices.
struct SomePoses {
  std::size_t size() const { return indices.size(); }
  Eigen::Isometry3d operator[](std::size_t i) const { return list[indices[i]]; }

  const PoseList& list;
  const std::vector<std::uint32_t>& indices;
};

/// Calls answer(begin, end) for batches of `count` entries, from several threads, all that is left of the progress,
/// until it is told to stop. @return the sum of the work that it returns. @throws Cancelled
template <class Answer>
Work forEachBatch(std::size_t count, unsigned threads, Progress& progress, const Answer& answer)
{
  const std::size_t batches = (count + kBatchPoses - 1) / kBatchPoses;
  progress.begin(1.0, batches);
  std::vector<Work> work(batches);
  parallelFor(batches, threadCount(threads), [&](std::size_t i) {
    if (progress.stopped()) return;
    work[i] = answer(i * kBatchPoses, std::min(count, (i + 1) * kBatchPoses));
    progress.step();
  });
  progress.throwIfStopped();
  progress.end();
  Work all;
  for (const Work& part : work) all += part;
  return all;
}

/// Gives entries of a list that are free so far the verdicts that they have: those that may collide, and of these
/// those that do for certain.
/// @param uncertain whether points may be elsewhere than they were measured
/// @param report of the progress from `begin` on
/// @param find Work(some, places, progress, mark): of the entries `some` those that collide while points are where
///   `places` says, to be marked by their places in `some`, from several threads
template <class Find>
Work giveVerdicts(bool uncertain, const std::function<bool(double)>& report, double begin,
                  std::vector<Verdict>& verdicts, const Find& find)
{
  Work work;
  const auto decide = [&](Verdict open, Verdict verdict, Places places, double from, double to) {
    std::vector<std::uint32_t> some;
    for (std::size_t i = 0; i < verdicts.size(); ++i)
      if (verdicts[i] == open) some.push_back(static_cast<std::uint32_t>(i));
    const std::function<bool(double)> part = [&](double done) { return !report || report(from + (to - from) * done); };
    Progress progress(part);
    work += find(some, places, progress, [&](std::size_t i) { verdicts[some[i]] = verdict; });
  };
  const double middle = 0.5 * (begin + 1.0);
  if (!uncertain) {
    decide(Verdict::free, Verdict::colliding, Places::measured, begin, 1.0);
  }
  else {
    decide(Verdict::free, Verdict::undecided, Places::possible, begin, middle);
    decide(Verdict::undecided, Verdict::colliding, Places::certain, middle, 1.0);
  }
  return work;
}

} // namespace pcl_bsh
