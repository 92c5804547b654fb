// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/labels.h>

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/query/prefetch.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/solid/label_walk.h>

#include <utility>

namespace pcl_bsh {
namespace {

constexpr std::size_t kVoxelsTogether = 32; ///< labelled by one thread, one after another

/// Labels as an array: each record is written by one thread only.
struct LabelArray {
  std::uint8_t* labels;
  std::size_t inside_count = 0, on_surface = 0;

  static bool wants(std::uint32_t) { return true; }
  void expect(const std::uint32_t* first, const std::uint32_t* last) const { prefetchEach(labels, first, last); }
  void inside(const std::uint32_t* first, const std::uint32_t* last)
  {
    for (; first != last; ++first) one(*first, Label::inside);
  }
  void one(std::uint32_t record, Label label)
  {
    if (labels[record] == labelOf(label)) return; // a subset may name a record twice
    labels[record] = labelOf(label);
    ++(label == Label::inside ? inside_count : on_surface);
  }
};

/// Voxels that have to be looked into, and those that are inside.
struct Voxels {
  std::vector<std::uint32_t> open, inside;
};

void sortOut(LabelWalk& walk, std::uint32_t index, Voxels& voxels)
{
  const Node& node = walk.cloud().top[index];
  for (std::uint32_t i = 0; i < node.count; ++i) {
    const Whole whole = walk.ofTop(node, i);
    if (whole == Whole::outside) continue;
    if (whole == Whole::inside) {
      for (std::uint32_t v = node.begin[i]; v < node.begin[i + 1]; ++v) voxels.inside.push_back(v);
    }
    else if (node.isLeaf(i)) {
      voxels.open.push_back(node.begin[i]);
    }
    else {
      sortOut(walk, node.child[i], voxels);
    }
  }
}

/// The smallest record so far.
struct Smallest {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::uint32_t record = kNone;
  bool any_will_do = false;
  bool surface_counts = true;

  static void expect(const std::uint32_t*, const std::uint32_t*) {}
  bool wants(std::uint32_t smallest) const { return any_will_do ? record == kNone : smallest < record; }
  void inside(const std::uint32_t* first, const std::uint32_t* last)
  {
    for (; first != last; ++first) record = std::min(record, *first);
  }
  void one(std::uint32_t of, Label label)
  {
    if (surface_counts || label == Label::inside) record = std::min(record, of);
  }
};

void search(LabelWalk& walk, std::uint32_t index, Smallest& found)
{
  const Node& node = walk.cloud().top[index];
  for (std::uint32_t i = 0; i < node.count; ++i) {
    if (!found.wants(node.lowest[i])) continue;
    const Whole whole = walk.ofTop(node, i);
    if (whole == Whole::outside) continue;
    if (whole == Whole::inside) {
      found.one(node.lowest[i], Label::inside);
    }
    else if (node.isLeaf(i)) {
      walk.labelVoxel(node.begin[i], found);
    }
    else {
      search(walk, node.child[i], found);
    }
  }
}

Smallest search(const Placed& cloud, const PlacedSolid& solid, Smallest found, Work* work)
{
  checkPoses(cloud.pose, solid.pose);
  const DefaultFloatEnvironment environment;
  Work own;
  if (!cloud.hierarchy().empty()) {
    LabelWalk walk(cloud, solid, own);
    search(walk, 0, found);
  }
  if (work) *work += own;
  return found;
}

} // namespace

void labelPoints(const Placed& cloud, const PlacedSolid& solid, LabelsResult& result, unsigned threads)
{
  checkPoses(cloud.pose, solid.pose);
  const DefaultFloatEnvironment environment;
  LabelsResult found;
  found.labels.swap(result.labels);
  result = LabelsResult(); // should something throw, it has no labels
  found.labels.assign(cloud.hierarchy().view().count, labelOf(Label::outside));
  const SphereHierarchy::Storage& storage = cloud.hierarchy().storage();
  Voxels voxels;
  LabelWalk above_voxels(cloud, solid, found.work);
  if (!cloud.hierarchy().empty()) sortOut(above_voxels, 0, voxels);
  LabelArray whole{found.labels.data()};
  for (const std::uint32_t v : voxels.inside)
    storage.forEachRecord(v, [&](std::uint32_t record) { whole.one(record, Label::inside); });

  const std::size_t parts = (voxels.open.size() + kVoxelsTogether - 1) / kVoxelsTogether;
  std::vector<std::pair<LabelArray, Work>> shares(parts, {whole, {}});
  parallelFor(parts, threadCount(threads), [&](std::size_t part) {
    LabelArray array{found.labels.data()};
    LabelWalk walk(cloud, solid, shares[part].second);
    walk.takeGaps(above_voxels);
    const std::size_t end = std::min(voxels.open.size(), (part + 1) * kVoxelsTogether);
    for (std::size_t i = part * kVoxelsTogether; i < end; ++i) walk.labelVoxel(voxels.open[i], array);
    shares[part].first = array;
  });
  found.inside = whole.inside_count;
  for (const auto& [array, work] : shares) {
    found.inside += array.inside_count;
    found.on_surface += array.on_surface;
    found.work += work;
  }
  result = std::move(found);
}

LabelsResult labelPoints(const Placed& cloud, const PlacedSolid& solid, unsigned threads)
{
  LabelsResult result;
  labelPoints(cloud, solid, result, threads);
  return result;
}

std::optional<std::uint32_t> firstInside(const Placed& cloud, const PlacedSolid& solid, Work* work)
{
  const Smallest found = search(cloud, solid, {}, work);
  if (found.record == Smallest::kNone) return std::nullopt;
  return found.record;
}

bool anyInside(const Placed& cloud, const PlacedSolid& solid, Work* work)
{
  return search(cloud, solid, {Smallest::kNone, true, true}, work).record != Smallest::kNone;
}

bool anyWithin(const Placed& cloud, const PlacedSolid& solid, Work* work)
{
  return search(cloud, solid, {Smallest::kNone, true, false}, work).record != Smallest::kNone;
}

Label labelPlace(const Solid& solid, const Point3& place)
{
  if (!isFinite(place)) return Label::outside;
  const DefaultFloatEnvironment environment;
  PointLabels labels(Eigen::Isometry3d::Identity(), solid);
  std::uint64_t exact_decisions = 0;
  return labels.label(labels.frameAt(place, 0.0), place, exact_decisions);
}

} // namespace pcl_bsh
