// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/roadmap/pose_tasks.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <atomic>
#include <limits>

namespace pcl_bsh {

void checkPoses(const PoseList& poses, const char* whose, unsigned threads)
{
  constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
  if (poses.size() > most)
    throw InvalidInput(Input::pose, "poses", plainText(poses.size(), " are more than an index can name (", most, ")"),
                       "ask for fewer at a time");
  const std::size_t batches = (poses.size() + kBatchPoses - 1) / kBatchPoses;
  std::atomic<std::size_t> first_wrong{poses.size()};
  parallelFor(batches, threadCount(threads), [&](std::size_t batch) {
    const std::size_t end = std::min(poses.size(), (batch + 1) * kBatchPoses);
    for (std::size_t i = batch * kBatchPoses; i < end; ++i) {
      if (isRigid(poses[i])) continue;
      std::size_t known = first_wrong.load(std::memory_order_relaxed);
      while (i < known && !first_wrong.compare_exchange_weak(known, i, std::memory_order_relaxed)) {
      }
      return;
    }
  });
  const std::size_t wrong = first_wrong.load(std::memory_order_relaxed);
  if (wrong < poses.size()) checkPose(plainText("pose ", wrong, " of ", whose), poses[wrong], wrong);
}

void checkAtPoses(const Placed& a, const PoseList& poses, const Accuracy& accuracy, unsigned threads)
{
  checkAccuracy(accuracy);
  if (accuracy.stopsEarly())
    throw InvalidInput(Input::accuracy, "accuracy", accuracy.text() + " stops early, which many poses at once do not",
                       "give exact, float or tolerance=LENGTH");
  checkPose("pose of a", a.pose);
  checkPoses(poses, "b", threads);
}

} // namespace pcl_bsh
