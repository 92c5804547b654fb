// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/unseen_points.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/seen/model_ball.h>
#include <pcl_bsh/seen/storage.h>
#include <pcl_bsh/seen/triangle_parts.h>

#include <algorithm>
#include <atomic>
#include <mutex>

namespace pcl_bsh {
namespace {

using Scans = std::vector<const SeenScan*>;

/// One model at one pose, or the part of it that one thread looks at.
class UnseenWalk {
public:
  UnseenWalk(const SeenSpace::Storage& seen, const Placed& model, double clearance, std::vector<Verdict>& verdicts)
  : model_(model),
    storage_(model.hierarchy().storage()),
    clearance_(clearance),
    verdicts_(verdicts)
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
  /// Which scans may see something in the sphere but not all; none left: it is settled.
  enum class State : std::uint8_t { seen, unseen, open };

  State look(const GivenSphere& sphere, const Scans& scans, Scans& left)
  {
    const double places = sphere.radius * (1.0 + kPoseStretch);
    const PosedPlace place(model_.pose, sphere.center);
    for (const SeenScan* scan : scans) {
      const Sight balls(scan->origin(), place.at, place.magnitude, places + clearance_ + storage_.uncertainty.most,
                        8.0);
      if (scan->sees(balls, result.work.node_pairs)) return State::seen;
      const Sight inside(scan->origin(), place.at, place.magnitude, places, 8.0);
      if (!scan->seesNoneIn(inside, clearance_, result.work.node_pairs)) left.push_back(scan);
    }
    return left.empty() ? State::unseen : State::open;
  }

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
      if (voxel && node.isLeaf(i)) {
        for (std::uint32_t p = node.begin[i]; p < node.begin[i + 1]; ++p)
          point(voxel->records()[p], state == State::unseen, left);
      }
      else if (state == State::unseen) {
        markBelow(voxel, node, i);
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

  void markBelow(const Voxel* voxel, const Node& node, std::uint32_t child)
  {
    for (std::uint32_t i = node.begin[child]; i < node.begin[child + 1]; ++i) {
      if (voxel)
        mark(voxel->records()[i]);
      else
        storage_.forEachRecord(i, [this](std::uint32_t record) { mark(record); });
    }
  }

  void point(std::uint32_t record, bool unseen, const Scans& scans)
  {
    if (verdicts_[record] != Verdict::free) return;
    pulse_.step();
    if (!unseen) {
      const auto sees = [&](const PosedPlace& place, double radius) {
        const auto of_scan = [&](const SeenScan* scan) {
          return scan->sees({scan->origin(), place.at, place.magnitude, radius}, result.work.node_pairs);
        };
        // What sees a place mostly sees its neighbours.
        const bool asked = std::find(scans.begin(), scans.end(), last_) != scans.end();
        if (asked && of_scan(last_)) return true;
        for (const SeenScan* scan : scans) {
          if ((asked && scan == last_) || !of_scan(scan)) continue;
          last_ = scan;
          return true;
        }
        return false;
      };
      if (RecordSight(model_, clearance_, sees)(record)) return;
    }
    mark(record);
  }

  void mark(std::uint32_t record)
  {
    Verdict& verdict = verdicts_[record];
    if (verdict != Verdict::free) return;
    verdict = Verdict::unseen;
    ++result.unseen;
  }

  const Placed& model_;
  const SphereHierarchy::Storage& storage_;
  const double clearance_;
  std::vector<Verdict>& verdicts_;
  Scans all_;
  const SeenScan* last_ = nullptr; ///< that saw something
  WorkPulse pulse_{result.work};
};

} // namespace

UnseenResult markUnseen(const SeenSpace& seen, const Placed& model, const UnseenRequest& request,
                        std::vector<Verdict>& verdicts)
{
  checkUnseen(model, request, verdicts.size());
  const DefaultFloatEnvironment environment;
  Progress progress(request.progress);
  const std::size_t voxels = model.hierarchy().storage().voxel_count;
  const unsigned threads = threadCount(request.threads);
  UnseenResult result;
  std::mutex adding;
  const auto look = [&](const auto& walkIt) {
    UnseenWalk walk(seen.storage(), model, request.clearance, verdicts);
    walkIt(walk);
    const std::lock_guard<std::mutex> lock(adding);
    result.unseen += walk.result.unseen;
    result.work += walk.result.work;
  };
  if (threads == 1 && !request.progress) {
    look([](UnseenWalk& walk) { walk.wholeModel(); });
    return result;
  }
  progress.begin(1.0, voxels);
  parallelFor(voxels, threads, [&](std::size_t i) {
    if (progress.stopped()) return;
    look([i](UnseenWalk& walk) { walk.voxel(i); });
    progress.step();
  });
  if (voxels > 0) progress.end();
  return result;
}

} // namespace pcl_bsh
