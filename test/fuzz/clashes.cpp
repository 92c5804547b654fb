// SPDX-License-Identifier: BSD-3-Clause
// Any text as an earlier list of clashes: refused with a reason, or a list that runs can be compared with, and that
// written out again is the same list.
#include "refusal.h"

#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/reports/clash_report.h>

namespace {

using namespace pcl_bsh;

/// As a run without a collision would list it: all of the earlier clashes are resolved.
void requireSameAgain(const io::ClashList& list)
{
  const PointsView nothing;
  const std::vector<Eigen::Isometry3d> poses;
  const TrajectoryResult found;
  io::ClashReport report{.question = list.question,
                         .cluster_distance = 1.0,
                         .clashes = list.clashes,
                         .scan = nothing,
                         .model = nothing,
                         .poses = poses,
                         .found = found,
                         .survey = list.survey.value_or(io::Survey(poses, std::nullopt))};
  for (Clash& clash : report.clashes) clash.status = ClashStatus::resolved;
  const io::ClashList again = io::parseClashLists(io::clashJson(report), "again").front();
  fuzz::require(again.question.clearance == list.question.clearance && again.question.swept == list.question.swept &&
                    again.clashes.size() == list.clashes.size(),
                "another list when read again");
  for (std::size_t i = 0; i < list.clashes.size(); ++i) {
    const Clash &before = list.clashes[i], &after = again.clashes[i];
    fuzz::require(before.id == after.id && before.points == after.points &&
                      before.certain_points == after.certain_points && before.place == after.place &&
                      before.low == after.low && before.high == after.high && before.distance == after.distance &&
                      before.first_pose == after.first_pose && before.closest_pose == after.closest_pose,
                  "another clash when read again");
  }
  fuzz::require(!io::clashCsv(report).empty() && !io::clashPage(report).empty(), "no page of it");
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  try {
    for (const io::ClashList& list : io::parseClashLists({reinterpret_cast<const char*>(data), size}, "fuzzed")) {
      requireSameAgain(list);
      std::vector<Clash> now = list.clashes;
      for (Clash& clash : now) clash.id += '#';
      compareWithEarlier(now, list.clashes, 1.0);
      for (const Clash& clash : now) fuzz::require(!clash.id.empty(), "a clash without an id");
    }
  }
  catch (const io::JsonError& error) {
    fuzz::requireReason(error);
  }
  return 0;
}
