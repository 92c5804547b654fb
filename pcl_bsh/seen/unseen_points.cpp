// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/unseen_points.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/seen/model_ball.h>
#include <pcl_bsh/seen/storage.h>
#include <pcl_bsh/seen/triangle_parts.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using Scans = std::vector<const SeenScan*>;

/// One model at one pose, or the part of it that one thread looks at.
class UnseenWalk {
public:
  /// @param in_shadow gets 1 where a record is; one per record with `kinds`
  UnseenWalk(const SeenSpace::Storage& seen, const Placed& model, const UnseenRequest& request,
             std::vector<Verdict>& verdicts, std::vector<std::uint8_t>& in_shadow)
  : model_(model),
    storage_(model.hierarchy().storage()),
    request_(request),
    clearance_(request.clearance),
    frame_(request.frame.value_or(model.pose)),
    verdicts_(verdicts),
    in_shadow_(in_shadow)
  {
    for (const SeenScan& scan : seen.scans) all_.push_back(&scan);
  }

  void wholeModel()
  {
    if (!storage_.top.empty()) enterNode(nullptr, 0, all_);
  }

  void voxel(std::size_t index) { enterVoxel(index, all_); }

  UnseenResult result;

private:
  /// seen: one scan sees all of the sphere. in_shadow and unseen: no scan sees any of it; unseen if its kind is wanted
  /// and not known. open: some scans may see part of it.
  enum class State : std::uint8_t { seen, in_shadow, unseen, open };

  State look(const GivenSphere& sphere, const Scans& scans, Scans& left)
  {
    const double places = sphere.radius * (1.0 + kPoseStretch);
    const PosedPlace place(model_.pose, sphere.center);
    for (const SeenScan* scan : scans) {
      const BallView balls(scan->origin(), place.at, place.magnitude, places + clearance_ + storage_.uncertainty.most,
                           8.0);
      if (scan->sees(balls, result.work.node_pairs)) return State::seen;
      const BallView inside(scan->origin(), place.at, place.magnitude, places, 8.0);
      if (!scan->seesNoneIn(inside, clearance_, result.work.node_pairs)) left.push_back(scan);
    }
    if (!left.empty()) return State::open;
    return !request_.kinds || isAllInShadow(place, places) ? State::in_shadow : State::unseen;
  }

  bool isAllInShadow(const PosedPlace& place, double radius)
  {
    return std::all_of(all_.begin(), all_.end(), [&](const SeenScan* scan) {
      const BallView places(scan->origin(), place.at, place.magnitude, radius, 8.0);
      return scan->seesNoneIn(places, 0.0, result.work.node_pairs);
    });
  }

  /// @param scans none: all below is unseen, and its kind is wanted
  void enterNode(const Voxel* voxel, std::uint32_t index, const Scans& scans)
  {
    const Node& node = voxel ? voxel->nodes[index] : storage_.top[index];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const GivenSphere sphere = !voxel                 ? storedSphere(storage_.frame, node, i)
                                 : voxel->given.empty() ? storedSphere(voxel->frame, node, i)
                                                        : givenSphereOf(storage_.view, *voxel, node, i);
      Scans left;
      pulse_.step();
      const State state = look(sphere, scans, left);
      if (state == State::seen) continue;
      if (state == State::in_shadow) {
        markBelow(voxel, node, i);
      }
      else if (voxel && node.isLeaf(i)) {
        for (std::uint32_t p = node.begin[i]; p < node.begin[i + 1]; ++p) record(voxel->records()[p], left);
      }
      else if (!node.isLeaf(i)) {
        enterNode(voxel, node.child[i], left);
      }
      else {
        enterVoxel(node.begin[i], left);
      }
    }
  }

  void enterVoxel(std::size_t index, const Scans& scans)
  {
    const Voxel& voxel = storage_.built(index, result.work);
    enterNode(&voxel, 0, scans);
  }

  /// Marks all free records below a child as unseen and, if kinds are wanted, as in shadow.
  void markBelow(const Voxel* voxel, const Node& node, std::uint32_t child)
  {
    const auto mark_all = [this](std::uint32_t record) {
      if (verdicts_[record] == Verdict::free) mark(record, request_.kinds);
    };
    for (std::uint32_t i = node.begin[child]; i < node.begin[child + 1]; ++i) {
      if (voxel)
        mark_all(voxel->records()[i]);
      else
        storage_.forEachRecord(i, mark_all);
    }
  }

  void record(std::uint32_t record, const Scans& scans)
  {
    if (verdicts_[record] != Verdict::free) return;
    pulse_.step();
    const auto sees = [&](const PosedPlace& place, double radius) {
      const auto of_scan = [&](const SeenScan* scan) {
        return scan->sees({scan->origin(), place.at, place.magnitude, radius}, result.work.node_pairs);
      };
      // A scan that sees a place mostly sees its neighbours.
      const bool asked = std::find(scans.begin(), scans.end(), last_) != scans.end();
      if (asked && of_scan(last_)) return true;
      for (const SeenScan* scan : scans) {
        if ((asked && scan == last_) || !of_scan(scan)) continue;
        last_ = scan;
        return true;
      }
      return false;
    };
    const RecordSeen seen_record(model_, clearance_, sees);
    if (!scans.empty() && seen_record(record)) return;
    mark(record, request_.kinds && seen_record.isInShadow(record, Shadow{*this},
                                                          request_.parts ? &result.kinds.parts : nullptr, frame_));
  }

  /// As RecordSeen asks for it.
  struct Shadow {
    UnseenWalk& walk;

    bool at(const PosedPlace& place) const
    {
      walk.pulse_.step(); // a triangle may be divided many times
      return std::all_of(walk.all_.begin(), walk.all_.end(), [&](const SeenScan* scan) {
        return scan->isDark({scan->origin(), place.at, place.magnitude, 0.0}, walk.result.work.node_pairs);
      });
    }
    bool all(const PosedPlace& place, double radius) const { return walk.isAllInShadow(place, radius); }
    bool none(const PosedPlace& place, double radius) const
    {
      walk.pulse_.step();
      return std::any_of(walk.all_.begin(), walk.all_.end(), [&](const SeenScan* scan) {
        return scan->sees({scan->origin(), place.at, place.magnitude, radius, 8.0}, walk.result.work.node_pairs);
      });
    }
  };

  void mark(std::uint32_t record, bool in_shadow)
  {
    verdicts_[record] = Verdict::unseen;
    ++result.unseen;
    if (!in_shadow) return;
    in_shadow_[record] = 1;
    ++result.in_shadow;
  }

  const Placed& model_;
  const SphereHierarchy::Storage& storage_;
  const UnseenRequest& request_;
  const double clearance_;
  const Eigen::Isometry3d frame_;
  std::vector<Verdict>& verdicts_;
  std::vector<std::uint8_t>& in_shadow_;
  Scans all_;
  const SeenScan* last_ = nullptr; ///< the last one that saw something
  WorkPulse pulse_{result.work};
};

} // namespace

void checkUnseen(const Placed& model, const UnseenRequest& request, std::size_t verdicts)
{
  checkClearance(request.clearance);
  checkPose("pose of the model", model.pose);
  const std::size_t records = model.hierarchy().view().count;
  if (verdicts == records) return;
  throw InvalidInput(Input::result, "verdicts",
                     "are " + std::to_string(verdicts) + " of " + std::to_string(records) + " points",
                     "give one per record of the model");
}

UnseenResult markUnseen(const SeenSpace& seen, const Placed& model, const UnseenRequest& request,
                        std::vector<Verdict>& verdicts)
{
  checkUnseen(model, request, verdicts.size());
  const DefaultFloatEnvironment environment;
  Progress progress(request.progress);
  const std::size_t voxels = model.hierarchy().storage().voxel_count;
  const unsigned threads = threadCount(request.threads);
  UnseenResult result;
  std::vector<std::uint8_t> in_shadow(request.kinds ? verdicts.size() : 0);
  std::mutex adding;
  const auto look = [&](const auto& walkIt) {
    UnseenWalk walk(seen.storage(), model, request, verdicts, in_shadow);
    walkIt(walk);
    const std::lock_guard<std::mutex> lock(adding);
    result.unseen += walk.result.unseen;
    result.in_shadow += walk.result.in_shadow;
    result.kinds.parts.insert(result.kinds.parts.end(), walk.result.kinds.parts.begin(), walk.result.kinds.parts.end());
    result.work += walk.result.work;
  };
  const auto tell = [&] {
    result.kinds.in_shadow.assign(in_shadow.begin(), in_shadow.end());
    std::stable_sort(result.kinds.parts.begin(), result.kinds.parts.end(),
                     [](const UnseenPart& a, const UnseenPart& b) { return a.record < b.record; });
    return std::move(result);
  };
  if (threads == 1 && !request.progress) {
    look([](UnseenWalk& walk) { walk.wholeModel(); });
    return tell();
  }
  progress.begin(1.0, voxels);
  parallelFor(voxels, threads, [&](std::size_t i) {
    if (progress.stopped()) return;
    look([i](UnseenWalk& walk) { walk.voxel(i); });
    progress.step();
  });
  if (voxels > 0) progress.end();
  return tell();
}

} // namespace pcl_bsh
