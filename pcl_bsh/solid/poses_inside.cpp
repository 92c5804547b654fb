// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/poses_inside.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/query/prefetch.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/solid/label_walk.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace pcl_bsh {
namespace {

using Poses = std::vector<std::uint32_t>; ///< their numbers, ascending

/// A voxel, and the poses at which its points have to be looked at.
struct OpenVoxel {
  std::uint32_t voxel;
  Poses poses;
};

class PosesSearch {
public:
  PosesSearch(const Placed& cloud, const Solid& solid, const PoseList& poses, PosesInside& found)
  : cloud_(cloud),
    solid_(solid),
    poses_(poses),
    found_(found)
  {
  }

  /// Labels the children of a node above the voxels, at some poses. @param base the pose of the first walk
  void sortOut(std::vector<LabelWalk>& walks, std::uint32_t index, const Poses& poses, std::uint32_t base)
  {
    const SphereHierarchy::Storage& storage = cloud_.hierarchy().storage();
    const Node& node = storage.top[index];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      Poses open;
      for (const std::uint32_t pose : poses) {
        LabelWalk& walk = walks[pose - base];
        const Whole whole = walk.ofTop(node, i);
        if (whole == Whole::outside) continue;
        if (whole == Whole::unknown) {
          open.push_back(pose);
        }
        else {
          for (std::uint32_t v = node.begin[i]; v < node.begin[i + 1]; ++v)
            storage.forEachRecord(v, [&](std::uint32_t record) { note(record, pose); });
          break; // later poses tell nothing new
        }
      }
      if (open.empty()) continue;
      if (node.isLeaf(i))
        voxels.push_back({node.begin[i], std::move(open)});
      else
        sortOut(walks, node.child[i], open, base);
    }
  }

  void lookInto(const OpenVoxel& open, Work& work)
  {
    std::size_t left = cloud_.hierarchy().storage().voxels[open.voxel].count;
    for (const std::uint32_t pose : open.poses) {
      LabelWalk walk(cloud_, {solid_, poses_[pose]}, work);
      Earlier receiver{*this, pose, left};
      walk.labelVoxel(open.voxel, receiver);
      if (left == 0) return;
    }
  }

  std::vector<OpenVoxel> voxels;

private:
  /// Notes a pose at points that have no earlier one.
  struct Earlier {
    PosesSearch& search;
    std::uint32_t pose;
    std::size_t& left;

    static bool wants(std::uint32_t) { return true; }
    void expect(const std::uint32_t* first, const std::uint32_t* last) const
    {
      prefetchEach(search.found_.first.data(), first, last);
    }
    void inside(const std::uint32_t* first, const std::uint32_t* last)
    {
      for (; first != last; ++first) one(*first, Label::inside);
    }
    void one(std::uint32_t record, Label)
    {
      left -= search.found_.first[record] == kNothing;
      search.note(record, pose);
    }
  };

  void note(std::uint32_t record, std::uint32_t pose) { found_.first[record] = std::min(found_.first[record], pose); }

  const Placed& cloud_;
  const Solid& solid_;
  const PoseList& poses_;
  PosesInside& found_;
};

} // namespace

void findPosesInside(const Placed& cloud, const Solid& solid, const PoseList& poses, PosesInside& result,
                     unsigned threads)
{
  checkPose("pose of the cloud", cloud.pose);
  if (poses.size() >= std::uint32_t{kNothing})
    throw InvalidInput(Input::trajectory, "poses",
                       counted(poses.size(), "pose is", "poses are") + " more than a number has");
  for (std::size_t i = 0; i < poses.size(); ++i) checkPose("pose " + std::to_string(i), poses[i], i);
  const DefaultFloatEnvironment environment;
  PosesInside found{std::exchange(result, {}).first, 0, {}}; // should something throw, the result is empty
  found.first.assign(cloud.hierarchy().view().count, kNothing);
  if (cloud.hierarchy().empty()) {
    result = std::move(found);
    return;
  }

  constexpr std::uint32_t kTogether = 1024; // poses whose frames are kept at a time
  for (std::uint32_t base = 0; base < poses.size(); base += kTogether) {
    PosesSearch search(cloud, solid, poses, found);
    std::vector<LabelWalk> walks;
    Poses some;
    for (std::uint32_t i = base; i < poses.size() && i - base < kTogether; ++i) {
      walks.emplace_back(cloud, PlacedSolid(solid, poses[i]), found.work);
      some.push_back(i);
    }
    search.sortOut(walks, 0, some, base);
    std::vector<Work> work(search.voxels.size());
    parallelFor(search.voxels.size(), threadCount(threads),
                [&](std::size_t i) { search.lookInto(search.voxels[i], work[i]); });
    for (const Work& part : work) found.work += part;
  }
  found.inside =
      found.first.size() - static_cast<std::size_t>(std::count(found.first.begin(), found.first.end(), kNothing));
  result = std::move(found);
}

PosesInside findPosesInside(const Placed& cloud, const Solid& solid, const PoseList& poses, unsigned threads)
{
  PosesInside result;
  findPosesInside(cloud, solid, poses, result, threads);
  return result;
}

} // namespace pcl_bsh
