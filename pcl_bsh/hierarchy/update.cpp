// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/update.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/bounds.h>
#include <pcl_bsh/hierarchy/build/cell_numbers-inl.h>
#include <pcl_bsh/hierarchy/frame_between.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/view_check.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <string>
#include <unordered_map>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE { // one point at a time: there is no choice of instructions to make
namespace {

/// The Morton code of the cell that a point is in, in the arithmetic of the cloud's scalar type; or kOutsideGrid.
template <class T>
std::uint64_t cellCode(const Point3& point, double edge, const std::array<double, 3>& base)
{
  using Numbers = CellNumbers<T>;
  const std::uint64_t cell = Numbers::together(Numbers(edge, base).numbers(Numbers::pointOf(point)));
  return cell == kOutsideGrid ? cell : Numbers::morton(cell);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

namespace pcl_bsh {
namespace {

constexpr double kMostUnused = 0.5; // unused floats for each one in use, before blocks are moved together

[[noreturn]] void refuse(const std::string& what)
{
  throw InvalidInput(Input::points, "HierarchyUpdate", what);
}

/// A touched voxel: its points after the change.
struct Touched {
  std::uint64_t key = 0;
  Voxel* old = nullptr;
  std::size_t leaving = 0;
  std::vector<std::uint32_t> records;
  std::vector<Point3> points;

  void add(std::uint32_t record, const Point3& point)
  {
    records.push_back(record);
    points.push_back(point);
  }
};

/// Calls visit(record, point) for some records of a large cloud, in any order. Memory of each is prefetched.
template <class Visit>
void eachPoint(const PointsView& view, const std::vector<std::uint32_t>& records, const Visit& visit)
{
  constexpr std::size_t ahead = 24;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (i + ahead < records.size())
      __builtin_prefetch(static_cast<const unsigned char*>(view.data) + view.stride * records[i + ahead] +
                         view.offset[0]);
    visit(records[i], view.point(records[i]));
  }
}

/// Fills a voxel that holds these records.
void fill(Voxel& voxel, const Touched& from, const PointsView& view, float largest_radius, float* block, float* radii)
{
  voxel.key = from.key;
  voxel.count = static_cast<std::uint32_t>(from.records.size());
  voxel.lowest = *std::min_element(from.records.begin(), from.records.end());
  voxel.block = block;
  voxel.radii = radii;
  Bounds bounds;
  for (const Point3& p : from.points) bounds.add(p);
  voxel.frame = frameBetween(bounds.low, bounds.high, view.scalar == Scalar::float32, largest_radius);
  auto* stored = reinterpret_cast<PointRecord*>(block);
  for (std::size_t i = 0; i < from.points.size(); ++i)
    *stored++ = storedIn(voxel.frame, from.points[i], from.records[i]);
}

/// Moves all blocks into one buffer, when too much of the present ones is left behind. Changes nothing when it throws.
void compact(SphereHierarchy::Storage& storage)
{
  const std::size_t used = 4 * storage.size + kBlockPadding * storage.voxel_count;
  if (static_cast<double>(storage.floats_unused) <= kMostUnused * static_cast<double>(used)) return;
  LargeBuffer<float> buffer = makeBuffer<float>(used);
  std::unique_ptr<float[]> radii = storage.view.radii ? std::make_unique<float[]>(storage.size) : nullptr;
  float* next = buffer.get();
  for (std::size_t v = 0; v < storage.voxel_count; ++v) {
    Voxel& voxel = storage.voxels[v];
    if (!voxel.isListed()) std::memcpy(next, voxel.block, 4 * std::size_t{voxel.count} * sizeof(float));
    voxel.block = next;
    next += voxel.blockSize();
    if (!radii) continue;
    std::memcpy(radii.get() + voxel.begin, voxel.radii, voxel.count * sizeof(float));
    voxel.radii = radii.get() + voxel.begin;
  }
  storage.buffers.clear();
  storage.buffers.push_back(std::move(buffer));
  storage.radii_buffers.clear();
  if (radii) storage.radii_buffers.push_back(std::move(radii));
  storage.floats_unused = 0;
}

/// Around all voxels' points.
LocalFrame frameOfAll(const std::vector<Voxel*>& voxels, Scalar scalar, float largest_radius)
{
  Bounds bounds;
  for (const Voxel* voxel : voxels) {
    const LocalFrame& f = voxel->frame;
    Point3 low, high;
    for (std::size_t k = 0; k < 3; ++k) { // rounding outward must not overflow
      constexpr double largest = std::numeric_limits<double>::max();
      const double half = (f.reach[k] + f.slack(static_cast<int>(k))) * f.unit * (1.0 + kDoubleMargin);
      low[k] = std::max(f.origin[k] - half, -largest);
      high[k] = std::min(f.origin[k] + half, largest);
    }
    bounds.add(low, high);
  }
  return frameBetween(bounds.low, bounds.high, scalar == Scalar::float32, largest_radius);
}

/// Whether new radii or uncertainties outdate a voxel's tree, though no point moved: radii that differ, or different
/// uncertainties in a leaf of one place, where one point stands for all.
bool isOutdated(const Voxel& voxel, const PointsView& now)
{
  const bool built = voxel.state.load(std::memory_order_acquire) == Voxel::built;
  if (now.radii && built) {
    for (std::uint32_t i = 0; i < voxel.count; ++i)
      if (voxel.radii[i] != now.radii[voxel.records()[i]]) return true;
  }
  else if (now.radii) {
    float largest = 0.0f;
    voxel.forEachRecord([&](std::uint32_t record) { largest = std::max(largest, now.radii[record]); });
    if (largest != voxel.largest_radius) return true;
  }
  if (!now.uncertainties || !built) return false;
  for (const Node& node : voxel.nodes)
    for (std::uint32_t i = 0; i < node.count; ++i) {
      if (!node.isLeaf(i) || !node.isCoincident(i)) continue;
      const std::uint32_t* const records = voxel.records();
      for (std::uint32_t k = node.begin[i]; k < node.begin[i + 1]; ++k)
        if (now.uncertainties[records[k]] != now.uncertainties[records[node.begin[i]]]) return true;
    }
  return false;
}

} // namespace

HierarchyUpdate::HierarchyUpdate(SphereHierarchy& hierarchy, const std::int32_t* records, std::size_t count)
: hierarchy_(hierarchy)
{
  const PointsView& view = hierarchy.view();
  if (view.indices) refuse("a hierarchy of a subset cannot be updated: take the whole cloud, NaN where a point is out");
  records_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (records[i] < 0) refuse("record " + std::to_string(records[i]) + " is negative");
    records_.push_back(static_cast<std::uint32_t>(records[i]));
  }
  if (!std::is_sorted(records_.begin(), records_.end())) std::sort(records_.begin(), records_.end());
  records_.erase(std::unique(records_.begin(), records_.end()), records_.end());
  if (hierarchy.empty()) return;
  const DefaultFloatEnvironment environment;
  const auto end = std::lower_bound(records_.begin(), records_.end(), static_cast<std::uint32_t>(view.count));
  std::uint64_t last_key = kOutsideGrid;
  std::size_t* leaving = nullptr;
  eachPoint(view, std::vector<std::uint32_t>(records_.begin(), end), [&](std::uint32_t, const Point3& p) {
    if (!isFinite(p)) return;
    const std::uint64_t key = voxelOf(p);
    if (key != last_key || !leaving) leaving = &leaving_[last_key = key];
    ++*leaving;
  });
}

std::uint64_t HierarchyUpdate::voxelOf(const Point3& point) const
{
  const SphereHierarchy::Storage& storage = hierarchy_.storage();
  return storage.view.scalar == Scalar::float32
             ? HWY_NAMESPACE::cellCode<float>(point, storage.voxel_edge, storage.base)
             : HWY_NAMESPACE::cellCode<double>(point, storage.voxel_edge, storage.base);
}

UpdateReport HierarchyUpdate::sortAnew(const PointsView& now)
{
  hierarchy_ = SphereHierarchy(now, hierarchy_.options());
  UpdateReport report;
  report.sorted_anew = true;
  report.points_read = hierarchy_.size();
  report.voxels_touched = hierarchy_.storage().voxel_count;
  report.volumes_built = hierarchy_.storage().voxel_count + countChildren(hierarchy_.storage().top);
  return report;
}

UpdateReport HierarchyUpdate::commit(const PointsView& now)
{
  SphereHierarchy::Storage& storage = *hierarchy_.storage_;
  const PointsView before = storage.view;
  checkView("HierarchyUpdate", now);
  if (now.indices) refuse("the new view is a subset: give all records, NaN where a point is out");
  if (now.scalar != before.scalar) refuse("the new view has coordinates of another type");
  if (before.count > 0 && !now.radii != !before.radii)
    refuse("the new view has radii and the old one none, or the other way round");
  if (now.count < before.count)
    refuse("the new view has " + counted(now.count, "record") + ", fewer than the " + std::to_string(before.count) +
           " before: keep them, NaN where a point is gone");
  const std::size_t announced = static_cast<std::size_t>(
      records_.end() - std::lower_bound(records_.begin(), records_.end(), static_cast<std::uint32_t>(before.count)));
  if (announced < now.count - before.count || (!records_.empty() && records_.back() >= now.count))
    refuse("the new view has " + std::to_string(now.count - before.count) + " more records, of which " +
           std::to_string(announced) + " were announced: announce each of them, and no others");
  checkLengths("HierarchyUpdate", now);
  if (hierarchy_.empty()) return sortAnew(now);

  const DefaultFloatEnvironment environment;
  // Which voxels are touched, and what they hold afterwards.
  UpdateReport report;
  std::vector<Touched> touched;
  std::unordered_map<std::uint64_t, std::size_t> touched_by_key;
  const auto touch = [&](std::uint64_t key) -> Touched& {
    const auto [entry, is_new] = touched_by_key.try_emplace(key, touched.size());
    if (is_new) touched.emplace_back().key = key;
    return touched[entry->second];
  };
  for (const auto& [key, count] : leaving_) touch(key).leaving = count;
  bool outside = leaving_.count(kOutsideGrid) > 0;
  for (Touched& voxel : touched) { // about as many come as go
    voxel.records.reserve(voxel.leaving + voxel.leaving / 8);
    voxel.points.reserve(voxel.leaving + voxel.leaving / 8);
  }
  std::uint64_t last_key = kOutsideGrid;
  Touched* last = nullptr;
  eachPoint(now, records_, [&](std::uint32_t record, const Point3& p) {
    if (!isFinite(p)) return;
    const std::uint64_t key = voxelOf(p);
    outside = outside || key == kOutsideGrid;
    if (outside) return;
    if (key != last_key) last = &touch(last_key = key);
    last->add(record, p);
  });
  if (outside) return sortAnew(now);
  for (std::size_t v = 0; (now.radii || now.uncertainties) && v < storage.voxel_count; ++v)
    if (isOutdated(storage.voxels[v], now)) touch(storage.voxels[v].key);
  std::sort(touched.begin(), touched.end(), [](const Touched& l, const Touched& r) { return l.key < r.key; });

  for (Touched& voxel : touched) {
    Voxel* const end = storage.voxels.get() + storage.voxel_count;
    Voxel* const found = std::lower_bound(storage.voxels.get(), end, voxel.key,
                                          [](const Voxel& v, std::uint64_t key) { return v.key < key; });
    if (found != end && found->key == voxel.key) voxel.old = found;
    const std::size_t count = voxel.old ? voxel.old->count : 0;
    // A point that is not where its coordinates say has moved since (SphereHierarchy::refit()).
    if (voxel.leaving > count) return sortAnew(now);
    report.points_read += voxel.records.size() + count - voxel.leaving;
  }
  if (2 * report.points_read > storage.size) return sortAnew(now);

  std::vector<bool> changed(before.count, false);
  for (const std::uint32_t record : records_)
    if (record < before.count) changed[record] = true;
  std::size_t floats = 0;
  std::vector<std::uint32_t> staying;
  for (Touched& voxel : touched) {
    staying.clear();
    if (voxel.old)
      voxel.old->forEachRecord([&](std::uint32_t record) {
        if (!changed[record]) staying.push_back(record);
      });
    if ((voxel.old ? voxel.old->count : 0) - staying.size() != voxel.leaving) return sortAnew(now);
    eachPoint(now, staying, [&](std::uint32_t record, const Point3& p) { voxel.add(record, p); });
    if (!voxel.records.empty()) floats += 4 * voxel.records.size() + kBlockPadding;
  }

  // The voxels afterwards, those untouched and the touched ones that hold something, are made beside the present ones:
  // whatever throws, the hierarchy and this update are as they were.
  LargeBuffer<float> buffer = makeBuffer<float>(std::max<std::size_t>(floats, 1));
  std::unique_ptr<float[]> radii = now.radii ? std::make_unique<float[]>(report.points_read) : nullptr;
  const float largest_radius = largestRadiusOf(now);
  float* next_block = buffer.get();
  float* next_radii = radii.get();
  std::size_t count = storage.voxel_count;
  for (const Touched& t : touched) {
    count += t.old == nullptr && !t.records.empty() ? 1 : 0;
    count -= t.old != nullptr && t.records.empty() ? 1 : 0;
  }
  if (count > 2 * mostVoxels(now.count)) return sortAnew(now); // twice, so that the next few points do not do it again
  auto voxels = std::make_unique<Voxel[]>(count);
  std::vector<Voxel*> after; // where each voxel is until it is moved into `voxels`
  after.reserve(count);
  std::size_t source = 0, unused = storage.floats_unused;
  const auto takeUntil = [&](const Voxel* end) {
    for (; storage.voxels.get() + source != end; ++source) after.push_back(&storage.voxels[source]);
  };
  for (const Touched& t : touched) {
    Voxel* const all = storage.voxels.get();
    takeUntil(t.old ? t.old
                    : std::lower_bound(all + source, all + storage.voxel_count, t.key,
                                       [](const Voxel& v, std::uint64_t key) { return v.key < key; }));
    ++report.voxels_touched;
    report.voxels_added += t.old == nullptr ? 1 : 0;
    report.voxels_removed += t.records.empty() ? 1 : 0;
    if (t.old) {
      unused += t.old->blockSize();
      ++source;
    }
    if (t.records.empty()) continue;
    ++report.volumes_built;
    Voxel& voxel = voxels[after.size()];
    fill(voxel, t, now, largest_radius, next_block, next_radii);
    measureVoxel(voxel, now);
    next_block += voxel.blockSize();
    if (next_radii) next_radii += voxel.count;
    after.push_back(&voxel);
  }
  takeUntil(storage.voxels.get() + storage.voxel_count);
  const LocalFrame frame = count > 0 ? frameOfAll(after, now.scalar, largest_radius) : LocalFrame();
  SphereHierarchy::Storage::TopTree above = SphereHierarchy::Storage::makeTopTree(after, frame, {});
  report.volumes_built += countChildren(above.top);
  storage.buffers.reserve(storage.buffers.size() + 1);
  storage.radii_buffers.reserve(storage.radii_buffers.size() + 1);

  [&]() noexcept { // from here on, nothing allocates
    std::size_t begin = 0;
    for (std::size_t v = 0; v < count; ++v) {
      if (after[v] != &voxels[v]) voxels[v].adopt(*after[v]);
      voxels[v].begin = static_cast<std::uint32_t>(begin);
      begin += voxels[v].count;
      voxels[v].own_uncertainties.reset(); // also where no point came or went
    }
    storage.view = now;
    storage.uncertainty = UncertaintyRange(now);
    storage.voxels = std::move(voxels);
    storage.voxel_count = count;
    storage.size = begin;
    storage.buffers.push_back(std::move(buffer));
    if (radii) storage.radii_buffers.push_back(std::move(radii));
    storage.floats_unused = unused;
    storage.frame = frame;
    storage.extent = storage.sumOfRadii();
    storage.setTopTree(std::move(above));
  }();
  try {
    compact(storage);
  }
  catch (const std::bad_alloc&) { // some memory stays unused until the next update: the answers are the same
  }
  leaving_.clear();
  return report;
}

} // namespace pcl_bsh
